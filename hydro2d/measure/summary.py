"""What a run says at its end: the contents of summary.json, the results of everything that is measured, and its outcome."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pydantic import create_model

from hydro2d.measure.bodies import Body
from hydro2d.measure.crater import Hole
from hydro2d.measure.debris import Cloud
from hydro2d.measure.ejecta import Ejected
from hydro2d.measure.outcome import Outcome
from hydro2d.measure.penetrator import Passage, Projectile
from hydro2d.measure.result import Number, Result, result
from hydro2d.measure.station_columns import Station

#: results of the projectile that every body has as well
OF_EVERY_BODY = {
    "rod_mass_kg": "mass_kg", "rod_mean_velocity_m_s": "velocity_m_s", "rod_kinetic_energy_J": "kinetic_energy_J",
    "rod_failed_mass_kg": "failed_mass_kg", "target_failed_mass_kg": "failed_mass_kg",
}
#: the others of the projectile by their old names, which say rod, and the names in the table `projectile`
PROJECTILE = {name: name.removeprefix("rod_") for name in Projectile.model_fields
              if name.startswith("rod_") and name not in OF_EVERY_BODY}


class Sink(Result):
    """Amounts that a sink has taken."""

    mass_kg: Number = result("mass that a sink has taken")
    momentum_N_s: Number = result("axial momentum that a sink has taken")
    energy_J: Number = result("energy that a sink has taken")


class Transfer(Result):
    """Amounts that bodies in contact have transferred."""

    momentum_N_s: Number = result("axial momentum that bodies in contact have transferred")
    energy_J: Number = result("energy that bodies in contact have transferred")


class Conservation(Result):
    """What the audit says at the end; SI, whole circumference."""

    mass: dict[str, Number] = result("relative change of the mass of a body that no sink accounts for", each="BODY", default={})
    off_course_cells: dict[str, Number] = result(
        "cells between the centre of mass of a body and where its momentum has taken it", each="BODY", default={})
    axial_momentum: Number = result("change of the axial momentum that no sink accounts for, over sqrt(2 m E) at the start")
    total_energy: Number = result("relative change of the total energy that no sink accounts for")
    internal_energy_J: Number = result("internal energy of all bodies")
    kinetic_energy_J: Number = result("kinetic energy of all nodes")
    start_energy_J: Number = result("total energy at the start, including the kinetic energy of all bodies")
    sinks: dict[str, Sink] = result("", each="SINK", default={})
    contact_transfers: dict[str, Transfer] = result("", each="TRANSFER", default={})


class Experiment(Result):
    """The measurement in the deck."""

    penetration_m: Number = result("penetration depth of the experiment in the deck")
    qualifier: str | None = result("measured, estimated or at least")
    residual_velocity_m_s: Number = result("residual velocity of the experiment; 0 if the projectile did not perforate")
    source: str | None = result("source of the experiment")


class Target(Passage):
    """A target and the passage of the projectile through it."""

    damage_class: str | None = result(
        "perforated: its hole is open right through; detached spall: a piece of four cells or more flies from its rear; "
        "attached spall: such a piece does not fly, void within is half a cell wide, or the rear bulges by half of the "
        "thickness; none; null while its rear is beyond the mesh, and where no hole is open but a hundredth of the "
        "projectile's mass of it has left the mesh behind it")
    crater: Hole | None = result("")
    debris: Cloud | None = result("of the debris behind it")
    ejecta: Ejected | None = result("of what flies back from it")


class _Flyer(Result):
    """The projectile; the results of Projectile that every body has are in its table of `bodies`."""

    body: str | None = result("name of the projectile, which is also in `bodies`")
    residual_velocity_change_m_s: Number = result(
        "change of the residual velocity over the last flight by the projectile's radius, or since perforation, if that is "
        "shorter; null if there is none")
    residual_velocity_change_over_s: Number = result("time over which that change took place")

    if TYPE_CHECKING:  # the results of PROJECTILE, which a type checker does not know

        def __getattr__(self, name: str) -> Any: ...


Flyer = create_model("Flyer", __base__=_Flyer, **{
    new: (Projectile.model_fields[old].annotation, result(Projectile.model_fields[old].description or ""))
    for old, new in PROJECTILE.items()})  # type: ignore[call-overload]


class Provenance(Result, extra="allow"):
    """Where a run comes from."""

    version: str | None = result("version of hydro2d")
    git_commit: str | None = result("commit of the sources")
    git_dirty: bool | None = result("whether they differ from it")
    packages: dict[str, Any] = result("versions of packages", default={})
    host: str | None = result("name of the machine")
    command: str | None = result("command line")
    written: str | None = result("date and time of its start")


class Ended(Result):
    """Which run it was, how it ended, and what it cost."""

    deck: str | None = result("name of the deck")
    title: str | None = result("title of the deck")
    deck_sha256: str | None = result("hash of the resolved deck, the same for the same case")
    setup: str | None = result("hash of everything in the deck that can change a result")
    cells_across: Number = result("number of cells across the radius of the projectile, or of the first body that has one")
    version: str | None = result("version of hydro2d")
    method: str | None = result("version of the method: results of one version can be compared")
    status: str | None = result("done, interrupted or unphysical")
    stop_reason: str | None = result("why the run ended")
    trustworthy: bool | None = result("whether the state at the end has no faults")
    faults: list[str] = result("the faults of that state, in sentences", default=[])
    notes: list[str] = result("what was beyond a bound and decides nothing, in sentences with the reason", default=[])
    time_s: Number = result("time at the end")
    cycles: int | None = result("number of cycles")
    wall_s: Number = result("wall-clock time of the run")
    cycles_s: Number = result("of this, in cycles, without compilation")
    compilation_s: Number = result(
        "time in which this process compiled kernels or waited for another one that did; 0 if the cache had all")
    outputs_s: Number = result("time for the history, dumps, restart files and progress reports")
    set_up_s: Number = result("time from the deck to the first cycle, in which kernels are read from the cache")
    ns_per_cell_cycle: Number = result("nanoseconds of the cycles per cell and cycle")
    cells: int | None = result("number of cells")


class Summary(Projectile, Ended):
    """A run at its end; the results of a projectile are None without one.

    A result is an attribute, ``summary.outcome.depth_m``, and has its name, ``summary["outcome"]``. The summary of a run that
    has not ended is false, and all results are None or empty.
    """

    outcome: Outcome | None = result("what the shot came to")
    projectile: Flyer | None = result("")  # type: ignore[valid-type]
    crater: Hole | None = result("hole in the first target")
    targets: dict[str, Target] = result("of each target", each="TARGET", default={})
    derived: dict[str, Number] = result(
        "a quantity that `[derived]` of the deck defines, or a file of `[result]` measures, at the end", each="DERIVED",
        default={})
    bodies: dict[str, Body] = result("of each body", each="BODY", default={})
    stations: dict[str, Station] = result("of each tracer and gauge", each="STATION", default={})
    experiment: Experiment | None = result("")
    conservation: Conservation | None = result("")
    provenance: Provenance | None = result("commit, machine, packages, command and times", whole=True)

    def __bool__(self) -> bool:
        return bool(self.model_fields_set)


class Progress(Result):
    """A run on its way: the contents of progress.json."""

    time_s: Number = result("time reached")
    cycles: int | None = result("number of cycles")
    fraction: Number = result("share of the cycles that are done, as far as the end can be foreseen")
    left_s: Number = result("wall-clock time left")
    wall_s: Number = result("wall-clock time so far")
    penetration_depth_m: Number = result("largest depth so far")
    rod_tail_velocity_m_s: Number = result("axial velocity of the projectile's tail")
    host: str | None = result("machine on which it runs")
    process: int | None = result("its process there")
