"""How far results were from measurements in the shots of the repository, for the kind of shot at hand.

The table of experience is a file in `problems`, which `python -m problems.validation.experience` writes. A row is for one kind
of shot: a quantity, what strikes what, and how the rod ends. It is the experience of runs, or of one analytic model.
"""

from __future__ import annotations

import csv
import functools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields

from pydantic import TypeAdapter

from hydro2d.deck import deck as decks
from hydro2d.deck import targets
from hydro2d.deck.shapes.body import Body
from hydro2d.deck.shapes.box import Box
from hydro2d.deck.shapes.rod import Rod
from hydro2d.files.shipped import problems_folder
from hydro2d.materials import library
from hydro2d.materials.material import Material
from hydro2d.measure.regime import GROWING, LEFT
from hydro2d.penetration.model import Model

FILE = "validation/results/experience.csv"
#: what a row is the experience of, if not of an analytic model
RUNS = "hydro2d"
DEPTH, HOLE, RESIDUAL, LENGTH, PERFORATION = "depth", "hole diameter", "residual velocity", "length", "perforation"
#: how a rod ended by its measured depth, for analytic models, which are asked before anyone knows how their rod ends
MEASURED = STAYED_RIGID, ERODED = "stayed rigid", "eroded"
#: metals by density at rest in kg/m^3 and sound speed in m/s, of those that the shots of the repository are made of
METALS = {
    "aluminium": ((2600.0, 2900.0), (5000.0, 5600.0)),
    "steel": ((7700.0, 8000.0), (4400.0, 4700.0)),
    "copper": ((8800.0, 9050.0), (3700.0, 4050.0)),
    "tungsten": ((16500.0, 19500.0), (3900.0, 4200.0)),
}
EXPLOSIVE, WALL = "explosive", "wall"
#: explosives of the library with which the kept shots are made
EXPLOSIVES = ("TNT", "comp_B", "PBX9404")
#: parts of an analytic model's inputs that describe materials, and inputs among them that do not
OF_MATERIALS = ("rod", "target", "cavity", "poncelet")
NOT_OF_MATERIALS = ("rod.length", "rod.diameter", "rod.mass", "target.thickness", "cavity.velocity")
#: beginning of a line, its end where there is no row, and what it begins with where the shots were others
HEAD, NONE, OUTSIDE, OTHERS = "experience", "none for this kind of shot", "outside its range of", "with other materials"
#: share of a velocity or thickness by which a shot may differ from those of a row and still be of its range
MARGIN = 0.05
#: between the sets of a row, and between its materials
BETWEEN = "; "


@dataclass(frozen=True)
class Impact:
    """A rod, ball or bar with its material, such as "tungsten rod", and the material that it strikes.

    An explosive strikes the metal that it drives. Impacts that differ only in the following are of one kind:

    projectile_material : name of the projectile's material, as the library has it
    target_materials : those of the bodies that it strikes, each once
    thickness : of the deck's targets together, without gaps, over the length of the projectile, or the diameter of a ball;
        None if it is not known
    """

    projectile: str
    target: str
    projectile_material: str = field(default="", compare=False)
    target_materials: tuple[str, ...] = field(default=(), compare=False)
    thickness: float | None = field(default=None, compare=False)


@dataclass(frozen=True)
class Experience:
    """A row of the table: ratios of computed to measured values for one kind of shot.

    of : "hydro2d", or the name of an analytic model;  sets : the sets of shots, "; " between them
    quantity : what is compared, such as "depth"
    projectile, target : what strikes what, such as "tungsten rod" and "aluminium"
    ended : regime at the end, of the run; for an analytic model, of the experiment; empty if it does not matter
    fit : whether the measured values are points of a formula that was fitted to shots
    chosen : whether something was chosen by looking at results
    shots : number of ratios, one for each shot, or of outcomes;  right : outcomes as measured, of a row without ratios
    bias, low, high : geometric mean of the ratios and its 90 % interval
    scatter : standard deviation of their logarithms;  least, most : the smallest and the largest ratio
    factor : with 90 %, the measured value of another shot is within this factor of its computed one over the bias
    missed : shots that perforate although the measured projectile stopped, which have no ratio; of residual velocities, those
        that stop although the measured one perforated
    numerical : standard deviation of the logarithms within a shot, over members and meshes
    measurement : relative standard deviation of the measurements;  model : scatter without it
    slowest, fastest : impact velocities in m/s;  coarsest, finest : cells across the radius
    thinnest, thickest : thickness of the target over the length of the projectile
    projectile_materials, target_materials : names of the materials of the shots, "; " between them
    """

    of: str
    quantity: str
    projectile: str
    target: str
    ended: str
    fit: bool
    chosen: bool
    sets: str
    shots: int
    right: int | None = None
    bias: float | None = None
    low: float | None = None
    high: float | None = None
    scatter: float | None = None
    factor: float | None = None
    least: float | None = None
    most: float | None = None
    missed: int = 0
    numerical: float | None = None
    measurement: float | None = None
    model: float | None = None
    slowest: float | None = None
    fastest: float | None = None
    coarsest: float | None = None
    finest: float | None = None
    thinnest: float | None = None
    thickest: float | None = None
    projectile_materials: str = ""
    target_materials: str = ""

    @property
    def impact(self) -> Impact:
        return Impact(self.projectile, self.target)

    @property
    def kind(self) -> str:
        """The kind of shot in words."""
        return kind(self.quantity, self.impact, self.ended)

    @property
    def words(self) -> str:
        """The row in a line, such as "computed/measured 0.97 (0.92 to 1.02), scatter 13 %, 21 shots (depth of ...)"."""
        many = f"{self.shots} {'point' if self.fit else 'shot'}{'s' * (self.shots != 1)}{' of a fit to shots' * self.fit}"
        about = [self.kind, *_range(self.slowest, self.fastest, "m/s"), *_range(self.coarsest, self.finest, "cells"),
                 *(f"targets {each}" for each in _range(self.thinnest, self.thickest, "lengths thick", digits=2)),
                 *(["set-up chosen by results"] if self.chosen else [])]
        about_it = f"({', '.join(about)})"
        if self.right is not None:
            return f"{self.right} of {many} ended as measured {about_it}"
        ways = ("stopped", "perforated") if self.quantity == RESIDUAL else ("perforated", "stopped")
        missed = f", and {self.missed} that {ways[0]} where the measured one {ways[1]}" if self.missed else ""
        if self.bias is None:
            return f"no ratio{missed} {about_it}"
        interval = "" if self.low is None else f" ({self.low:.2f} to {self.high:.2f})"
        scatter = "" if self.scatter is None else f", scatter {100.0 * self.scatter:.0f} %"
        within = "" if self.numerical is None else f", {100.0 * self.numerical:.0f} % between runs of one shot"
        return f"computed/measured {self.bias:.2f}{interval}{scatter}{within}, {many}{missed} {about_it}"

    def words_at(self, impact: Impact, velocities: Iterable[float]) -> str:
        """The row in a line, for such an impact at these velocities, m/s: it begins with what the shots of the row were not."""
        speeds = any(_is_outside(abs(each), self.slowest, self.fastest) for each in velocities)
        # a target in which the projectile stops may be thicker
        thick = None if self.ended else self.thickest
        outside = ["velocities"] * speeds + ["thickness"] * _is_outside(impact.thickness, self.thinnest, thick)
        sides = ((self.projectile_materials, [impact.projectile_material]), (self.target_materials, impact.target_materials))
        others = " into ".join(known.replace(BETWEEN, ", ") for known, own in sides if _are_others(own, known))
        about = [f"{OUTSIDE} {' and '.join(outside)}"] * bool(outside) + [f"{OTHERS} ({others})"] * bool(others)
        return "; ".join([*about, self.words])


def _is_outside(value: float | None, low: float | None, high: float | None) -> bool:
    """Whether a value is more than MARGIN below or above a range, an end of which is None if there is none."""
    if value is None:
        return False
    return (low is not None and value < low * (1.0 - MARGIN)) or (high is not None and value > high * (1.0 + MARGIN))


def _are_others(own: Iterable[str], known: str) -> bool:
    """Whether one of these materials is none of the known ones of a row."""
    return bool(known) and any(each and each not in known.split(BETWEEN) for each in own)


def _range(low: float | None, high: float | None, unit: str, digits: int = 6) -> list[str]:
    """One text of a range, or none without its ends."""
    if low is None or high is None:
        return []
    ends = dict.fromkeys(f"{each:.{digits}g}" for each in (low, high))
    return [f"{' to '.join(ends)} {unit}"]


def kind(quantity: str, impact: Impact, ended: str) -> str:
    """A kind of shot in words, such as "depth of eroding tungsten rods in aluminium"."""
    if impact.target == WALL:
        return f"{quantity} of a {impact.projectile} on a wall"
    if impact.projectile == EXPLOSIVE:
        return f"{quantity} of {impact.target} driven by an explosive"
    who, how = f"{impact.projectile}s", "through" if quantity in (RESIDUAL, PERFORATION) else "in"
    if ended in MEASURED:
        return f"{quantity} of {who} that {ended}, {how} {impact.target}"
    return f"{quantity} of {ended + ' ' if ended else ''}{who} {how} {impact.target}"


@functools.cache
def table() -> tuple[Experience, ...]:
    """All rows of the shipped file. Raises FileNotFoundError."""
    with open(problems_folder() / FILE, encoding="utf-8", newline="") as file:
        return tuple(read(row) for row in csv.DictReader(file))


def read(row: Mapping[str, str]) -> Experience:
    """A row of the file; an empty text is a value that is not known. Raises KeyError for a missing column, ValueError."""
    texts = {field.name: row[field.name] for field in fields(Experience)}
    return _ROW.validate_python({name: text for name, text in texts.items() if text or name in TEXTS})


_ROW = TypeAdapter(Experience)
#: columns of texts that may be empty
TEXTS = ("ended", "projectile_materials", "target_materials")


def substance(material: Material) -> str:
    """The metal that a material is, by its density and sound speed, or "explosive"; else the material's name.

    A metal without strength is none of them: in the shots of the table all have some.
    """
    if material.eos.name == "jwl":
        return EXPLOSIVE
    speed = material.eos.values.get("sound_speed")
    for name, ((light, heavy), (slow, fast)) in METALS.items():
        if material.has_strength and speed and light <= material.reference_density <= heavy and slow <= speed <= fast:
            return name
    return material.name


def impact_of(deck: decks.Deck) -> Impact | None:
    """The projectile and the target of a deck, by the metals of its bodies, as the table of experience names kinds of shots.

    The result has ``projectile``, such as "tungsten rod", and ``target``, such as "aluminium", in a deck with a projectile;
    several targets, and other bodies such as a jacket, are all named. An explosive of the kept shots and the metal that it
    drives are "explosive" and the metal; one bar that flies at a wall is a "copper bar" and "wall". None for any other deck,
    for a planar one, and for one that scales the strength of a body.
    """
    if deck.mesh.geometry != "cylindrical" or any(body.strength_factor not in (None, 1.0) for body in deck.body):
        return None
    metals = {body.name: substance(deck.materials[body.material]) for body in deck.body}
    if deck.penetration is not None:
        rod = decks.body(deck, deck.penetration.rod)
        others = [metal for name, metal in metals.items() if name != rod.name]
        alike = len(others) > 1 and len(set(others)) == 1
        target = f"{len(others)} bodies of {others[0]}" if alike else " and ".join(others)
        struck = (library.origin(deck.materials[body.material]) for body in deck.body if body.name != rod.name)
        return Impact(f"{metals[rod.name]} {rod.shape}", target, library.origin(deck.materials[rod.material]),
                      tuple(dict.fromkeys(struck)), _thickness(deck, rod))
    if len(deck.body) == 2:
        return _driven(deck.materials[deck.body[0].material], deck.materials[deck.body[1].material])
    if len(deck.body) == 1 and _is_bar(deck.body[0]) and _flies_at_wall(deck):
        return Impact(f"{metals[deck.body[0].name]} bar", WALL, library.origin(deck.materials[deck.body[0].material]))
    return None


def _thickness(deck: decks.Deck, rod: Body) -> float | None:
    """Thickness of the targets of a deck, without gaps, over the length of its projectile; None if one has no rear."""
    (low, high), through = decks.extent(rod, deck, "z"), targets.targets(deck)
    if not all(decks.body(deck, each.name).is_target for each in through):
        return None
    return sum(abs(each.rear - each.surface) for each in through) / (rod.size[1] if rod.size else high - low)


def _driven(one: Material, other: Material) -> Impact | None:
    """An explosive of the kept shots and the material that it drives, in either order; None for other materials."""
    charge, metal = (one, other) if substance(one) == EXPLOSIVE else (other, one)
    known = substance(charge) == EXPLOSIVE and any(charge.eos.values == library.load(name).eos.values for name in EXPLOSIVES)
    return Impact(EXPLOSIVE, substance(metal), library.origin(charge), (library.origin(metal),)) if known else None


def _is_bar(body: Body) -> bool:
    """Whether a body of a cylindrical deck is a solid cylinder, at least as long as thick."""
    if isinstance(body, Rod):
        diameter, length = body.size
        return body.nose == "flat" and length >= diameter
    return isinstance(body, Box) and body.r is not None and body.r[0] == 0.0 and body.z[1] - body.z[0] >= 2.0 * body.r[1]


def _flies_at_wall(deck: decks.Deck) -> bool:
    """Whether the first body of a deck flies along z, towards an edge that is a wall."""
    (radial, axial), edges = deck.body[0].velocity, deck.boundaries
    ahead = edges.z_min if axial < 0.0 else edges.z_max
    return radial == 0.0 and axial != 0.0 and deck.body[0].flow is None and ahead == WALL


def of_run(impact: Impact | None, regime: str | None, perforated: bool, velocity: float | None = None) -> list[str]:
    """Lines of the experience with a kind of run: computed over measured values, or that there are none.

    regime : that of the rod at the end, None without a rod;  perforated : whether it left the target behind
    velocity : of the impact, m/s; None if it is not known
    """
    ended, at = regime if regime in GROWING and not perforated else "", [] if velocity is None else [velocity]
    return [f"{HEAD}: {each}" for each in _of_run(impact, ended, perforated, regime == LEFT, at)]


def _of_run(impact: Impact | None, ended: str, perforated: bool, left: bool, velocities: list[float]) -> Iterator[str]:
    if impact is None:
        yield NONE
        return
    rows = [row for row in table() if row.of == RUNS and row.impact == impact and row.ended in (ended, "")]
    rows = [row for row in rows if perforated or row.quantity != RESIDUAL]
    predicted = {row.quantity for row in rows if not row.chosen}
    shown = [row for row in rows if not row.chosen or row.quantity not in predicted]
    yield from (row.words_at(impact, velocities) for row in shown)
    main = RESIDUAL if perforated else DEPTH
    struck = ended or perforated or left
    if struck and main not in {row.quantity for row in shown}:
        yield f"{NONE} ({kind(main, impact, ended)})"
    elif not shown:
        yield NONE


def of_model(model: Model, rod: Material | None, target: Material | None, settings: Iterable[str] = (),
             velocities: Iterable[float] = (), thickness: float | None = None) -> list[str]:
    """Lines of the experience with an analytic model for a rod of one material and a target of another, or that there is none.

    It is that of the formula, with inputs from decks and the library, and not that of runs.

    rod, target : None for those of the model's example, of which there is none, since other inputs may replace their properties
    settings : names of the inputs that the user gives, such as "rod.length"; there is none with properties of materials
    velocities : of the impacts, m/s;  thickness : of the target over the length of the rod, None if it is not known
    """
    rows = [row for row in table() if row.of == model.name]
    if not rows:
        return [f"{HEAD}: none with this model"]
    if rod is None or target is None:
        return [f"{HEAD} with this model: none unless the materials of rod and target are given"]
    if own := ", ".join(sorted(filter(_of_materials, settings))):
        return [f"{HEAD} with this model: none with properties of materials that are given ({own})"]
    here = Impact(f"{substance(rod)} rod", substance(target), library.origin(rod), (library.origin(target),), thickness)
    at = list(velocities)
    shown = [row.words_at(here, at) for row in rows if row.impact == here] or [f"{NONE} ({kind(DEPTH, here, '')})"]
    return [f"{HEAD} with this model: {words}" for words in shown]


def _of_materials(name: str) -> bool:
    """Whether an input of an analytic model, such as "rod.density", is a property of a material."""
    return name.partition(".")[0] in OF_MATERIALS and name not in NOT_OF_MATERIALS
