"""Material that has failed by damage: it stays failed, bears neither shear nor tension, and is counted."""

import numpy as np
import pytest

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck
from hydro2d.mesh.fields import FAILED, SRR, SRZ
from hydro2d.solver.simulation import Simulation
from tests.decks import body, box, mesh, plate, rod, stop, table, walls
from tests.verification.running import finish, to_the_end
from tests.verification.test_translation import ROD

STRAIN_FAILURE = """
[materials.rod_fails]
based_on = "W_alloy"
variant = "strain-failure"
[materials.plate_fails]
based_on = "Al5083"
variant = "strain-failure"
[failure]
damage = "material"
"""
FLIGHT = ROD.replace("W_alloy", "rod_fails") + STRAIN_FAILURE
#: two halves of a bar of one material, which part in the middle; at r = const nothing happens
BAR = (
    mesh(("2 mm", 4), ("-20 mm", "20 mm", 80))
    + walls("r_max")
    + box("low", "rod_fails", z=["-15 mm", "0 mm"], velocity="-20 m/s")
    + box("high", "rod_fails", z=["0 mm", "15 mm"], velocity="20 m/s", join="low")
    + stop("5 us")
    + STRAIN_FAILURE
)
#: a short rod that fails at a strain of 0.5, so that much of it fails within a few microseconds
SHOT = (
    mesh(("9 mm", 18), ("-12 mm", "18 mm", 60))
    + rod("2 mm", "10 mm", material="rod_fails", nose="flat", tip=0.0, velocity="2000 m/s")
    + plate("16 mm", material="plate_fails")
    + stop("9 us")
    + STRAIN_FAILURE.replace("[materials.plate", "damage.D1 = 0.5\n[materials.plate")
)
SLIP_LAYER = """
[sliding]
method = "slip-layer"
hard = ["rod"]
yield_factor = "off"
"""
CONTACT = SLIP_LAYER.replace("slip-layer", "contact")


def fail_everything(simulation: Simulation) -> None:
    simulation.state.dmg[:] = np.where(simulation.state.vof > 0.0, FAILED, 0.0)


def failed(simulation: Simulation) -> np.ndarray:
    """Where a body [m, j, i] has failed."""
    s = simulation.state
    return (s.dmg >= 1.0) & (s.vof > 0.0)


@pytest.mark.parametrize("advection", ["ke", "momentum", "both"])
def test_failed_material_stays_failed_while_it_moves(advection):
    """Some 120 cycles across 24 cells: a mean of ones, with round-off, is one."""
    simulation = Simulation(deck.loads(FLIGHT, ["stop.time=12 us", f'numerics.advection="{advection}"']))
    fail_everything(simulation)
    while simulation.stop_reason() is None:
        simulation.step()
    present = simulation.state.vof > 0.0
    assert np.all(simulation.state.dmg[present] == FAILED)


@pytest.mark.parametrize("cells", [4, 8])
def test_a_thin_failed_layer_does_not_heal_as_it_moves(cells):
    """Rows of a rod that have failed, across 24 cells: half-and-half mixtures with sound material count as failed."""
    simulation = Simulation(deck.loads(FLIGHT, ["stop.time=12 us"]))
    grid, s = simulation.grid, simulation.state
    middle = int(np.median(np.nonzero(grid.interior(s.vof)[0].sum(axis=1))[0]))
    grid.interior(s.dmg)[0, middle - cells // 2 : middle + cells // 2] = FAILED
    before = simulation.of_bodies()["rod"]["failed_mass_kg"]
    while simulation.stop_reason() is None:
        simulation.step()
    assert 0.75 * before < simulation.of_bodies()["rod"]["failed_mass_kg"] < 1.1 * before


@pytest.mark.parametrize(("broken", "speed"), [(True, 20.0), (False, 0.0)], ids=["failed", "intact"])
def test_a_failed_bar_parts_without_tension(broken, speed):
    """Halves at -20 and 20 m/s: a whole bar stops them by 1.5 GPa of tension, which it bears; a failed one parts."""
    simulation = Simulation(deck.loads(BAR))
    if broken:
        fail_everything(simulation)
    pull = 0.0
    while simulation.time < 2e-6:
        simulation.step()
        pull = min(pull, float(simulation.state.p.min()))
    middle = np.abs(simulation.grid.z_edges) < 6e-3
    v = np.abs(simulation.grid.interior_vertices(simulation.state.v)[0, middle])
    assert (pull == 0.0) == broken
    assert np.median(v) == pytest.approx(speed, abs=1.0)


@pytest.mark.parametrize("sliding", ["", SLIP_LAYER, CONTACT], ids=["sticking", "slip-layer", "contact"])
def test_debris_bears_no_shear_and_no_tension_and_is_counted(sliding):
    """In the cells of a shot in which rod and plate fail; the pressure is that of the cells as the cycle before left them."""
    counts, alone = [], []

    def watch(simulation):
        s, where = simulation.state, failed(simulation)
        if alone:
            assert np.all(s.p[alone.pop()] >= 0.0)
        if simulation.cycle % 5 == 0:
            assert np.all(s.q[SRR : SRZ + 1, where] == 0.0)
            alone.append((where & (s.vof == 1.0)).any(axis=0))
            measured = simulation.diagnostics()
            counts.append((measured["rod_failed_mass_kg"], measured["target_failed_mass_kg"]))
            assert measured["rod_failed_mass_kg"] + measured["rod_core_mass_kg"] <= measured["rod_mass_kg"] * (1 + 1e-12)

    simulation = finish(deck.loads(SHOT + sliding), watch)
    measured = simulation.diagnostics()
    rod, plate = counts[-1]
    assert 0.02 < rod / measured["rod_mass_kg"] < 0.9
    assert plate > 0.02 * measured["rod_mass_kg"]
    assert abs(simulation.conservation()["total_energy"]) < 1e-2


# ------------------------------------------------------------------------------------------------ the largest principal stress

#: a copper ring that flies apart, at 150 m/s along r everywhere: hoop stress only, E v t/R while it is elastic
RING = (
    mesh(("36 mm", "62 mm", "0.5 mm"), ("-5 mm", "5 mm", "0.5 mm"))
    + table("materials.ring",
            eos={"model": "mie-grueneisen", "reference_density": 8930, "sound_speed": 3940, "hugoniot_slope": 1.489,
                 "grueneisen": 2.02, "specific_heat": 383},
            strength={"model": "elastic-plastic", "shear_modulus": 47.7e9, "yield_stress": 0.3e9})
    + table("boundaries", r_min="outflow")
    + body("ring", "ring", "box", r=["38.2 mm", "41.9 mm"], z=["-2 mm", "2.1 mm"],
           flow={"pattern": "cylindrical", "speed": "150 m/s", "radius": "40 mm", "exponent": 0})
    + stop("40 us")
)  # fmt: skip


def share_failed(simulation: Simulation) -> float:
    s, grid = simulation.state, simulation.grid
    mass = grid.interior(s.vof[0] * s.rho[0] * grid.volume)
    return float(mass[grid.interior(s.dmg[0]) >= 1.0].sum() / mass.sum())


def test_a_ring_breaks_when_its_hoop_stress_is_due():
    """At 15 m/s, so that waves across the ring have died down: 0.2 GPa at E v t/R, t = 4.3 us, E = 125 GPa."""
    ring = Simulation(deck.loads(RING.replace("150 m/s", "15 m/s"), ['materials.ring.fracture_stress="0.2 GPa"']))
    bulk, shear = 8930 * 3940.0**2, 47.7e9
    due = 0.2e9 * 0.04 / (9 * bulk * shear / (3 * bulk + shear) * 15.0)
    while ring.time < 0.85 * due:
        ring.step()
    assert share_failed(ring) == 0.0
    while ring.time < 1.25 * due:
        ring.step()
    assert share_failed(ring) > 0.95
    where = ring.grid.interior(ring.state.dmg[0]) >= 1.0
    assert not ring.grid.interior(ring.state.srr[0])[where].any()


def test_a_ring_breaks_by_its_hoop_stress_and_not_by_its_pressure():
    """A ring that has failed keeps its velocity; an intact one is braked by its yield stress."""
    by_stress, by_pressure = (to_the_end(Simulation(deck.loads(RING, [f'materials.ring.fracture_{kind}="0.2 GPa"'])))
                              for kind in ("stress", "pressure"))
    for simulation in (by_stress, by_pressure):
        assert simulation.faults() == []
        assert abs(simulation.conservation()["total_energy"]) < 1e-12
    assert share_failed(by_pressure) == 0.0
    assert share_failed(by_stress) > 0.999  # it is carried, although there is no damage model
    kept = [simulation.conservation()["kinetic_energy_J"] / (2 * np.pi * simulation.audit.start.kinetic)
            for simulation in (by_stress, by_pressure)]
    assert kept[0] > 0.99
    assert kept[1] < 0.75


@pytest.mark.parametrize("share", [0.0, 0.4])
def test_a_bar_of_two_bodies_breaks_where_the_tension_is(share):
    """Wherever their common face lies in its cell."""
    middle = f"{0.5 * share} mm"
    text = (
        mesh(("2 mm", 4), ("-20 mm", "20 mm", 80))
        + table("materials.weak", based_on="W_alloy", fracture_stress="0.8 GPa", fracture_pressure="3.5 GPa")
        + box("low", "weak", r=[0.0, "1.5 mm"], z=["-15 mm", middle], velocity="-20 m/s")
        + box("high", "weak", r=[0.0, "1.5 mm"], z=[middle, "15 mm"], velocity="20 m/s")
        + stop("6 us")
    )
    simulation = to_the_end(Simulation(deck.loads(text)))
    places = simulation.grid.zc[np.nonzero(failed(simulation).any(axis=(0, 2)))[0]]
    assert places.size > 0
    assert np.abs(places).max() < 3e-3
    intact = to_the_end(Simulation(deck.loads(text, ['materials.weak.fracture_stress="2.5 GPa"'])))
    assert not failed(intact).any()


@pytest.mark.parametrize("overrides", [
    (["failure.damage='material'", "materials.ring.damage={ model = 'cochran-banner', opening = '25 um' }"], "opens cracks"),
    (["body.ring.material='alumina_995'", "materials.alumina_995.based_on='alumina_995'",
      "materials.alumina_995.fracture_stress='1 GPa'"], "a damage of its own"),
    (["materials.ring.fracture_stress='-1 GPa'"], "must be positive"),
], ids=["cracks", "jh-2", "negative"])
def test_settings_that_exclude_a_fracture_stress(overrides):
    with pytest.raises(DeckError, match=overrides[1]):
        Simulation(deck.loads(RING, ["materials.ring.fracture_pressure='1 GPa'", "materials.ring.fracture_stress='1 GPa'",
                                     *overrides[0]]))


def test_tensile_none_switches_a_fracture_stress_off_and_a_resolved_deck_keeps_it():
    loaded = deck.loads(RING, ['materials.ring.fracture_stress="0.2 GPa"'])
    again = deck.loads(loaded.to_toml())
    assert again.materials["ring"].fracture_stress.value == 0.2e9
    assert np.isinf(Simulation(deck.loads(loaded.to_toml(), ['failure.tensile="none"'])).table.fracture_stress).all()
