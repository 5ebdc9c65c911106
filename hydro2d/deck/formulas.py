"""Quantities that a deck defines: its formulas, with the names and units that they can use, and its files of results."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from hydro2d.base.errors import DeckError
from hydro2d.base.formats import in_hdf5
from hydro2d.deck.expressions import PURE, Expression, ExpressionError, in_words, parse
from hydro2d.deck.sections import Deck, OwnFile
from hydro2d.measure.result import UNITS, unit
from hydro2d.measure.station_columns import PLACES, Point

if TYPE_CHECKING:
    from hydro2d.measure.own_results import OwnResult

#: characters of a name
LONGEST = 60
#: results that are words
WORDS = ("regime",)


def known(deck: Deck) -> dict[str, str]:
    """The names that formulas of a deck can use, with their units."""
    from hydro2d.measure.bodies import Body  # which loads numba
    from hydro2d.measure.crater import Hole
    from hydro2d.measure.ejecta import Ejected
    from hydro2d.measure.penetrator import Projectile

    bodies = [entry.name for entry in deck.body if entry.join is None]
    stations = [f"tracer_{entry.name}" for entry in deck.tracer]
    stations += [f"gauge_{name}" for entry in deck.gauge for name, _ in entry.places()]
    columns = ["time", "dt", "internal_energy_J", "kinetic_energy_J"]
    columns += [f"body_{body}_{key}" for body in bodies for key in Body.model_fields]
    columns += [f"{station}_{key}" for station in stations for key in Point.model_fields]
    short: dict[str, str] = {}
    if deck.penetration is not None:
        columns += [name for name in Projectile.model_fields if name not in WORDS]
        columns += [f"crater_{key}" for key in Hole.model_fields] + [f"ejecta_{key}" for key in Ejected.model_fields]
        short = {name: unit(column) for name, column in Projectile.short().items()}
    columns += [name for own in own_results(deck).values() for name in own.lines]
    return short | {column: unit(column) for column in columns}


def own_results(deck: Deck) -> dict[str, OwnResult]:
    """The files of results of a deck by their names in it. Raises ModelError for a wrong one."""
    return {name: _own(table) for name, table in deck.result.items()}


def _own(table: OwnFile) -> OwnResult:
    from hydro2d.measure import own_results  # which loads numba

    return own_results.of_text(table.code or "", table.code_from)


def trusted_results(deck: Deck) -> Iterator[tuple[tuple, str]]:
    """Runs the files of results of a checked deck, which its simulations may run then; key and message of one that fails."""
    for name, own in own_results(deck).items():
        try:
            own.trust()
        except DeckError as error:
            yield ("result", name, "file"), str(error)


def expressions(deck: Deck) -> dict[str, Expression]:
    """The formulas of a checked deck, by the names of the quantities that they define."""
    names = known(deck) if deck.derived else {}
    return {name: parse(text, names) for name, text in deck.derived.items()}


def problems(deck: Deck) -> Iterator[tuple[tuple, str]]:
    """Key and message of every formula that is wrong: its syntax, its names, its units, and the name that it defines."""
    if wrong := list(_wrong_results(deck)):
        yield from wrong
        return
    names = known(deck) if deck.derived else {}
    used: set[str] = set()
    for name, text in deck.derived.items():
        path = ("derived", name)
        if problem := _bad_name(name, names, used):
            yield path, problem
            continue
        used.add(in_hdf5(name))
        try:
            formula = parse(text, names)
        except ExpressionError as error:
            yield path, str(error)
            continue
        if problem := _bad_unit(name, formula):
            yield path, problem


def _wrong_results(deck: Deck) -> Iterator[tuple[tuple, str]]:
    """Key and message of every file of results that is wrong in its form or has a name that is taken."""
    if not deck.result:
        return
    from hydro2d.measure.summary import Outcome, Summary

    used: set[str] = set()
    names = known(deck.model_copy(update={"result": {}})) | dict.fromkeys((*Summary.model_fields, *Outcome.model_fields), "")
    for key, table in deck.result.items():
        path = ("result", key, "file")
        try:
            own = _own(table)
        except DeckError as error:
            yield path, str(error)
            continue
        for name, line in own.lines.items():
            if problem := _bad_name(name, names, used):
                yield path, f"{own.file}:{line}: {name} {problem.replace('a derived quantity', 'a result')}"
            used.add(in_hdf5(name))


def _bad_name(name: str, names: dict[str, str], used: set[str]) -> str:
    if not name.strip() or not name.isprintable() or len(name) > LONGEST:
        return f"a name has 1 to {LONGEST} printable characters"
    if name[0] in "./" or name.startswith(("crater", "debris")) or name in ("cycle", "regime", *PLACES):
        return "is not allowed as the name of a derived quantity; give it another"
    if name.startswith(("sink_", "mass_change_", "tracer_", "gauge_", "body_")) or {name, in_hdf5(name)} & {*names, *used}:
        return "is the name of another quantity; give it another"
    return ""


def _bad_unit(name: str, formula: Expression) -> str:
    """The mistake of a name whose ending states another unit than that of the formula; empty if there is none."""
    named = unit(name)
    if named == "rad" and formula.dimension == PURE:
        return ""
    said = in_words(formula.dimension)
    ending = next((ending for ending, each in UNITS.items() if each == said), "")
    if said == named:
        return ""
    if said != "1" and not ending:
        return f'"{formula.text}" is in {said}, a unit that no quantity of a run has'
    if said == "1":
        return f'"{formula.text}" is a plain number, and the ending of the name says {named}; give it another name'
    how = f'call it "{name}{ending}"' if named == "1" else f"the ending of the name says {named}"
    return f'"{formula.text}" is in {said}; {how}, since files and figures read the unit from the end of a name'
