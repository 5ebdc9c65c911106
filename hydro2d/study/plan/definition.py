"""The study file: a base deck, axes to vary, exclusions, or a search in velocity. Strict TOML becomes a frozen Definition."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import AfterValidator, Field, ValidationError, model_validator

from hydro2d.base import units
from hydro2d.base.errors import DeckError, Error, in_words, unknown
from hydro2d.base.keys import FolderName, PositiveLength, PositiveSpeed, Section, Speed, Words
from hydro2d.files import toml
from hydro2d.files.key_lines import Sources, spelled
from hydro2d.files.whole import plain, read_text
from hydro2d.study.outcomes.regime import Regime
from hydro2d.study.outcomes.registry import BY_NAME, KINDS
from hydro2d.study.plan.sample_section import Change, Input, Sample, different

#: overrides of the decks of a study: "key=value" of a command line, or values by their dotted keys
Overrides = Sequence[str] | Mapping[str, Any]

#: keys of a variant for another base deck and for the deck keys that it removes; the table of a search
DECK, REMOVE, SEARCH = "deck", "remove", "transition"


class StudyError(Error):
    """A study, its directory or its workers are wrong; the message is for the user."""


def _filled(value):
    if not value:
        raise ValueError("is empty; at least one entry is needed")
    return value


def _flat(table: Any, prefix: str = "") -> dict[str, Any]:
    """Deck keys and values; sliding.method = ... and "sliding.method" = ... are the same key."""
    if not isinstance(table, dict):
        raise ValueError("expected a table of deck keys and values")
    flat: dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, dict):
            flat |= _flat(value, f"{prefix}{key}.")
        else:
            flat[f"{prefix}{key}"] = value
    return flat


def _removing(flat: dict[str, Any]) -> dict[str, Any]:
    """Deck keys and values, with None for those that `remove` lists."""
    removed = flat.pop(REMOVE, [])
    if not isinstance(removed, (list, tuple)) or not all(isinstance(key, str) and key for key in removed):
        raise ValueError(f'{REMOVE}: expected a list of deck keys, such as ["body.rod.crh"]')
    if both := [key for key in removed if key in flat]:
        raise ValueError(f"{REMOVE}: {both[0]} is given a value as well")
    return flat | dict.fromkeys(removed)


Keys = Annotated[dict[str, Any], AfterValidator(_flat), AfterValidator(_removing)]


class Range(Section):
    """Values from one number to another, by a step, which may stop before `to`, or by a count, which ends at `to`."""

    from_: float | int | str = Field(alias="from", description="first value")
    to: float | int | str = Field(description="last value")
    step: float | int | str | None = Field(None, description="difference between successive values")
    count: int | None = Field(None, ge=2, description="number of values")

    @model_validator(mode="after")
    def _one_way(self):
        if (self.step is None) == (self.count is None):
            raise ValueError("give either step or count")
        return self


class Axis(Section):
    """One axis of a study: the values of a key, or variants that set several keys."""

    name: Words = Field(description="name of the axis in tables and exclusions")
    key: str | None = Field(None, min_length=1, description="deck key, as in --set")
    values: Annotated[tuple[Any, ...], AfterValidator(_filled)] | None = Field(None, description="values of the key")
    range: Range | None = Field(None, description="values of the key, by from, to and step or count")
    variants: Annotated[dict[Words, Annotated[Keys, AfterValidator(_filled)]], AfterValidator(_filled)] | None = Field(
        None, description="named sets of deck keys; `deck` names another base deck, `remove` lists deck keys to take out"
    )

    @model_validator(mode="after")
    def _one_way(self):
        given = [name for name in ("values", "range", "variants") if getattr(self, name) is not None]
        if len(given) != 1:
            raise ValueError(f"give one of values, range, variants; given: {' and '.join(given) or 'none'}")
        if (self.key is None) != (self.variants is not None):
            raise ValueError("variants name their own keys; leave out key" if self.key else "key is missing")
        return self


#: default and least number of runs in a round of a search with a budget
ROUND, FEWEST = 4, 3
#: default of the largest width of a bracket, m/s
TOLERANCE = 25.0


#: outcomes with a threshold, as written in a study file
WITH_DEPTH = [f'of = "{kind.name}"' for kind in KINDS if kind.has_depth]
if TYPE_CHECKING:
    Of = str
else:
    Of = Literal[tuple(BY_NAME)]


class Transition(Section):
    """The impact velocities between which `hydro2d transition` searches, for every combination of the axes."""

    from_: Speed = Field(alias="from", description="lowest velocity: the projectile should stay rigid, or be stopped")
    to: Speed = Field(
        description="highest velocity: the projectile should erode, or perforate; negative, as `from`, for one that flies to -z"
    )
    tolerance: PositiveSpeed | None = Field(
        None, description="largest width of a bracket; velocities are this far apart, from `from`; default 25 m/s"
    )
    key: str | None = Field(None, description="deck key to vary; default: the velocity of the deck's projectile")
    of: Of = Field(Regime.name, description=f"what changes: {'; '.join(kind.meaning for kind in KINDS)}")
    depth: PositiveLength | None = Field(None, description=f"threshold of {' and '.join(f'`{word}`' for word in WITH_DEPTH)}")
    budget: int | None = Field(
        None, ge=1, le=10_000,
        description="number of runs for each combination of the axes, to find v50 of an outcome that is partly chance; "
        "without it the search is a bisection",
    )
    round: int | None = Field(
        None, ge=FEWEST, le=1000, description="with `budget`: runs chosen at a time; default 4"
    )
    seed: int | None = Field(
        None, ge=0, le=2**32, description="with `budget`: seed of the changes from run to run; default 0"
    )

    @model_validator(mode="after")
    def _growing(self):
        if not abs(self.from_) < abs(self.to) or self.from_ * self.to <= 0:
            raise ValueError(f"from = {self.from_:g} m/s, to = {self.to:g} m/s: to must be faster, in the same direction")
        if (self.depth is not None) != BY_NAME[self.of].has_depth:
            raise ValueError(f"depth is the threshold of {' and '.join(WITH_DEPTH)}; give both or neither")
        return self

    @model_validator(mode="after")
    def _with_budget(self):
        if self.budget is None:
            alone = [name for name in ("round", "seed") if getattr(self, name) is not None]
            if alone:
                raise ValueError(f"{' and '.join(alone)}: belongs to a search with a budget; give budget, or leave it out")
            return self
        if len(BY_NAME[self.of].order) > 2:
            raise ValueError(f'with a budget the outcome must be one of two, and of = "{self.of}" has more; '
                             'give of = "erosion"')
        if self.tolerance is not None:
            raise ValueError("tolerance belongs to a bisection, which ends there; with a budget, the budget ends the search")
        size = self.round or ROUND
        if self.budget < size:
            raise ValueError(f"budget = {self.budget}: the first round takes {size} runs; give a budget of at least {size}"
                             + (f", or round = {max(self.budget, FEWEST)}" if self.budget >= FEWEST else ""))
        return self


class Ensemble(Section):
    """Repeats of every case with changes that should not matter; they show how certain its result is."""

    repeats: int = Field(ge=2, le=1000, description="number of members of each case; the first is its deck unchanged")
    by: Annotated[tuple[Change, ...], AfterValidator(different)] = Field(
        ("mesh offset", "first step"),
        description="the changes between members: the mesh shifted along z by up to half a cell; the flank of the projectile "
        "moved by up to a quarter of a cell; the first time step reduced by up to four thousandths",
    )
    seed: int = Field(0, ge=0, le=2**32, description="seed of the sequence of changes; another seed makes other members")


class Part(Section):
    """A study of a large one, or some of its cases."""

    study: str = Field(min_length=1, description="study file, in the folder of this one")
    name: FolderName | None = Field(None, description="name of its directory; default: that of its file, and the cells")
    about: str = Field("", description="its purpose")
    members: int | None = Field(None, ge=1, le=1000, description="members of each case; default: as in its file")
    cells: float | None = Field(None, gt=0.0, le=1000.0, description="cells across the radius of the projectile; default: as "
                                "in its decks")
    only: tuple[str, ...] = Field((), description="patterns of the names of the cases that are run; default: all")
    skip: tuple[str, ...] = Field((), description="patterns of the names of cases that are not run")


class Definition(Section):
    """A study file: a sweep with axes, a sample or an ensemble; a search for a transition, with or without axes; or parts."""

    title: str = Field("", description="title for tables and reports")
    deck: str | None = Field(None, description="base deck: in the folder of the study file, or as `hydro2d run` finds decks")
    out: str | None = Field(None, description="directory of the study; default: runs/<name of the study file>")
    set: Keys = Field({}, description="deck keys and values for every case; `remove` lists keys to take out")
    axis: Annotated[tuple[Axis, ...], AfterValidator(_filled)] = Field((), description="axes, the first one slowest")
    transition: Transition | None = Field(None, description="the search of `hydro2d transition`")
    sample: Sample | None = Field(None, description="points of uncertain inputs, at each of which every case runs")
    ensemble: Ensemble | None = Field(None, description="repeats of every case")
    exclude: tuple[dict[str, Any], ...] = Field((), description="combinations to leave out")
    keep: str | None = Field(
        None, min_length=1, description="CSV file, in the folder of this one, with a row for every run that has ended; a run "
        "is not repeated while the file has a row of its deck and of this version of the method",
    )
    part: Annotated[tuple[Part, ...], AfterValidator(_filled)] = Field((), description="studies that make up this one, in turn")

    @model_validator(mode="after")
    def _parts_alone(self):
        if self.part:
            others = [name for name in self.model_fields_set if name not in ("title", "out", "set", "part")]
            if others:
                raise ValueError(f"{' and '.join(sorted(others))}: belongs to the files of the parts")
        return self


_TABLES: dict[tuple, type[Section]] = {
    (): Definition, ("axis",): Axis, ("axis", "range"): Range, ("transition",): Transition,
    ("sample",): Sample, ("sample", "input"): Input, ("ensemble",): Ensemble, ("part",): Part,
}


def read(path: Path, overrides: Overrides) -> tuple[Definition, str, dict, Sources]:
    """A study file with the overrides of the command line applied to [set]: validated, as text, as tables, and places of keys.

    Raises StudyError with one line for each mistake.
    """
    text = read_text(path, StudyError)
    sources = Sources()
    try:
        data = toml.parse(text, str(path))
    except DeckError as error:
        raise StudyError(str(error)) from None
    if not toml.is_study(data) and "mesh" in data:
        raise StudyError(f"{path}: is a deck; run it with `hydro2d run`. A study names a deck and what to vary")
    sources.add(str(path), data, text)
    if overrides:
        data = _with(data, overrides)
        text = f"# with {len(overrides)} override{'s'[: len(overrides) > 1]} laid over\n\n{toml.dumps(data)}"
    return _validated(data, sources), text, data, sources


def of_tables(data: dict, name: str, overrides: Overrides) -> tuple[Definition, str, dict, Sources]:
    """`read` for nested dicts and lists, as a study file would give them; name : name of the study in messages."""
    sources = Sources()
    sources.add(name, {}, "")
    data = _with(data, overrides) if overrides else data
    return _validated(data, sources), toml.dumps(data), data, sources


def _with(data: dict, overrides: Overrides) -> dict:
    """The study with overrides applied to [set]."""
    if isinstance(overrides, str):
        raise StudyError(f'overrides are a dict of values by key or a list of "key=value", not the text "{overrides}"')
    given = plain(overrides) if isinstance(overrides, Mapping) else dict(_assigned(entry) for entry in overrides)
    settings = _settings(data)
    removed = settings.pop(REMOVE, [])
    if isinstance(removed, list):
        removed = [key for key in removed if key not in given] + [key for key, value in given.items() if value is None]
        settings = {key: value for key, value in settings.items() if key not in removed}
    settings |= {key: toml.placed_value(key, value, Path()) for key, value in given.items() if value is not None}
    return {**data, "set": settings | ({REMOVE: removed} if removed else {})}


def _settings(data: dict) -> dict:
    return _flat(data["set"]) if isinstance(data.get("set"), dict) else {}


def _assigned(text: str) -> tuple[str, Any]:
    """Key and value of --set key=value."""
    try:
        return toml.assignment(text)
    except DeckError as error:
        raise StudyError(str(error)) from None


def _validated(data: dict, sources: Sources) -> Definition:
    """The study; numbers of its search need their units, as those of its decks do, unless [set] has numbers = "SI"."""
    in_si = _settings(data).get("numbers") == toml.SI
    try:
        study = Definition.model_validate(data if in_si else {**data, **units.bare({k: data[k] for k in data if k == SEARCH})})
    except ValidationError as error:
        raise StudyError(explained(error, data, sources, _TABLES)) from None
    if not (study.axis or study.sample or study.transition or study.ensemble or study.part):
        raise StudyError(f"{sources.where(('axis',), data)}: axis: is missing")
    if study.sample and study.sample.by and study.ensemble:
        raise StudyError(f"{sources.where(('sample', 'by'), data)}: sample.by: [ensemble] makes changes already; leave out one")
    if study.transition and study.sample:
        raise StudyError(f"{sources.where(('sample',), data)}: sample: a search takes no [sample], because its velocities "
                         "follow from earlier runs; sample the velocity as well, without [transition]")
    if study.transition and study.ensemble:
        raise StudyError(f"{sources.where(('ensemble',), data)}: ensemble: {_instead(study.transition)}")
    return study


def _instead(search: Transition) -> str:
    """Why a search takes no ensemble, and the alternative."""
    if search.budget is not None:
        return ("a search with a budget takes no [ensemble], since every run is another draw already; leave it out. `seed` in "
                "[transition] makes other draws, and a larger `budget` more of them")
    return ("a bisection takes no [ensemble], since it needs one outcome for each velocity. Where chance decides, give "
            "[transition] a `budget` of runs instead, for the velocity at which half of the shots end either way; or give the "
            "velocities as an [[axis]], without [transition], to repeat each of them")


def explained(error: ValidationError, data: dict, sources: Sources, tables: dict[tuple, type[Section]]) -> str:
    """hydro2d's messages for pydantic's errors, a line each; ``tables`` are the sections by the path of their keys."""
    return "\n".join(dict.fromkeys(_explained(entry, data, sources, tables) for entry in error.errors()))


def _explained(entry: dict, data: dict, sources: Sources, tables: dict[tuple, type[Section]]) -> str:
    path = tuple(entry["loc"])
    where = "".join(f"{part}: " for part in (sources.where(path, data), spelled(path)) if part)
    if entry["type"] == "extra_forbidden":
        place = tuple(part for part in path[:-1] if isinstance(part, str))
        table = tables[place] if place in tables else tables[place[:-1]]  # the table of an input is named by its deck key
        return where + unknown("key", str(path[-1]), [f.alias or name for name, f in table.model_fields.items()])
    return where + in_words(entry)
