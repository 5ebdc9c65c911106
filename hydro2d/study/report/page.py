"""The page of a report: one self-contained HTML file, from the templates in this folder."""

from __future__ import annotations

import base64
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime

from hydro2d.analytic import model_transition
from hydro2d.base.errors import from_extra
from hydro2d.base.formats import file_name, shown
from hydro2d.base.version import __version__
from hydro2d.study.ensemble import ensembles
from hydro2d.study.ensemble.contents import Contents
from hydro2d.study.outcomes.registry import BY_NAME
from hydro2d.study.records import differences
from hydro2d.study.records.record import Record
from hydro2d.study.records.responses import Choice
from hydro2d.study.records.table import columns_of_audit, columns_of_results, to_csv
from hydro2d.study.report.panels import Chart
from hydro2d.study.report.pictures import Picture, is_drawn
from hydro2d.study.report.uncertain import Part
from hydro2d.study.search import regimes

PAGE, TABLE = "report.html", "cases.csv"
#: where names may break across lines: after underscores and dots, except in numbers
BREAKS = re.compile(r"(?<=_)(?=[^\s._])|(?<=\.)(?=[^\s._\d])")


def page(contents: Contents, choice: Choice, charts: Sequence[Chart], pictures: Sequence[Picture],
         films: Sequence[Picture] = (), fitted: Sequence[Picture] = (),
         views: Mapping[str, str] | None = None, uncertain: Sequence[Part] = ()) -> str:
    """The whole file.

    fitted : curves of a search with a budget;  views : links to the pages of runs, by case;  uncertain : parts on a sample
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined

    env = Environment(loader=PackageLoader(__package__), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
                      lstrip_blocks=True)
    env.finalize = lambda value: shown(value) if type(value) is str else value
    env.filters |= {"breakable": breakable, "whole_words": whole_words, "download": download}
    states = Counter(each.case.status for each in contents.records)
    return env.get_template("report.html.j2").render(
        contents=contents, study=contents.study, table=TABLE, csv=to_csv(contents.table), charts=charts, pictures=pictures,
        cases_of=contents.table.to_dict("records"),
        films=films, fitted=fitted, views=views or {}, uncertain=uncertain, plotly=charts_script() if charts else "",
        made=f"hydro2d {__version__}, {datetime.now(UTC):%Y-%m-%d %H:%M} UTC",
        states=", ".join(f"{number} {status}" for status, number in states.items()),
        transitions=_transitions(contents) if contents.study.search else None,
        ensembles=_ensembles(contents, choice) if contents.study.ensembles else None,
        results=columns_of_results(contents.study, contents.table, choice), experience=_experience(contents),
        audit=columns_of_audit(),
        decks=_decks(contents), origins=[_origin(each) for each in contents.records],
    )


def charts_script() -> str:
    """The script that draws the charts of a page. Raises MissingPackage."""
    with from_extra("report", "a report"):
        from plotly.offline import get_plotlyjs
    return get_plotlyjs()


def breakable(text: str):
    """Text whose lines may also break after dots and underscores, except in numbers."""
    from markupsafe import Markup, escape

    return Markup("<wbr>").join(escape(part) for part in BREAKS.split(str(text)))


def whole_words(text: str):
    """A key or a name, of class `key`, whose lines break only after dots and underscores."""
    from markupsafe import Markup

    return Markup("<wbr>").join(Markup("<span>{}</span>").format(part) for part in BREAKS.split(str(text)))


def download(text: str, kind: str) -> str:
    """A text as a data URL, which needs no network."""
    return f"data:{kind};charset=utf-8;base64,{base64.b64encode(text.encode()).decode()}"


def _experience(contents: Contents) -> list[str]:
    """Every line of the experience with such runs, and of how many of the ended ones it is, unless it is of all."""
    ended = [each.experience for each in contents.records if each.experience]
    counts = Counter(line for lines in ended for line in lines)
    return [line if number == len(ended) else f"{line}: {number} of {len(ended)} runs" for line, number in counts.items()]


def _transitions(contents: Contents) -> dict:
    """The brackets of a search, one row for each combination of the axes; open questions; the criteria.

    Notes on an estimate from a budget that a picture already states are left out.
    """
    combinations = contents.transitions
    names = list(dict.fromkeys(bracket.name for each in combinations for bracket in each.brackets))
    with_notes = [(each, each.estimate.notes if is_drawn(each) else ()) for each in combinations]
    return {
        "caption": _caption(contents),
        "heads": ["Combination", *names, "Known", "Models", "Runs"],
        "rows": [_of_combination(each, names) for each in combinations],
        "notes": [f"{each.title}: {note}" for each, known in with_notes for note in each.notes if note not in known],
        "criteria": regimes.criteria(contents.study),
        "of_rods": BY_NAME[contents.study.search.of].of_rod,
        "file": regimes.FILE,
    }


def _caption(contents: Contents) -> str:
    """What the brackets of a search are."""
    if contents.study.search.budget is None:
        return "Impact velocities between which the regime changes"
    limit = "the ballistic limit and of " if any(each.estimate.limit for each in contents.transitions) else ""
    return f"90 % intervals of {limit}v50, the impact velocity at which half of the shots end either way"


def _ensembles(contents: Contents, choice: Choice) -> dict:
    """Medians, spreads and shares of regimes, one row for each case; the score; the changes between members; the file."""
    groups = contents.ensembles
    heads, rows = ensembles.table(groups, choice.y)
    scored = ensembles.score(groups)
    return {
        "heads": [head[0].upper() + head[1:] for head in heads], "rows": rows, "score": scored and scored.words,
        "made": _made(groups),
        "file": ensembles.FILE, "csv": to_csv(contents.table_of_ensembles(choice)),
    }


def _made(groups: Sequence[ensembles.Ensemble]) -> str:
    """The number of members of the cases, and their changes."""
    said = []
    for made, number in Counter(each.members[0].case.ensemble for each in groups).items():
        cases, apiece = ("1 case", "") if number == 1 else (f"{number} cases", " each")
        what = f"{made.repeats} members{apiece}, by {', '.join(made.by)}, seed {made.seed}" if made else "one run" + apiece
        said.append(f"{cases} with {what}")
    return "; ".join(said)


def _of_combination(each: regimes.Transitions, names: Sequence[str]) -> list[str]:
    brackets = {bracket.name: model_transition.extent(bracket) for bracket in each.brackets}
    known = [f"{bracket.name}: {model_transition.extent(bracket)}" for bracket in each.known]
    models = [f"{entry.model.name}: {entry.in_words}" for entry in each.predictions]
    return [each.title, *(brackets.get(name, "–") for name in names), "; ".join(known) or "–", "; ".join(models) or "–",
            str(len(each.runs))]


def _decks(contents: Contents) -> dict:
    """The keys in which the decks differ, with the cases of each value, and the keys that all share."""
    decks = {each.case.name: each.deck for each in contents.records if each.deck}
    compared = differences.compare(decks) if decks else differences.Differences({}, {})
    varying = {key: [(value, _who(contents, names)) for value, names in users.items()]
               for key, users in compared.varying.items()}
    return {"number": len(decks), "varying": varying, "common": compared.common, "own": ", ".join(differences.OWN)}


def _who(contents: Contents, names: tuple[str, ...]) -> str:
    """Cases as the value of an axis if they are all cases with it, else by their names."""
    with_deck = {each.case.name: each.case for each in contents.records if each.deck}
    for axis in contents.study.axes:
        for label in axis.values:
            if set(names) == {name for name, case in with_deck.items() if case.values.get(axis.name) == label}:
                return f"{axis.name} = {label} ({len(names)})"
    return differences.shortened(names)


def _origin(each: Record) -> dict:
    """Name, deck as a file, version, machine and command of one case."""
    origin = dict(each.case.summary.provenance or {})
    dirty = {True: ", with local changes", False: "", None: ""}[origin.get("git_dirty")]
    packages = ", ".join(f"{name} {version}" for name, version in (origin.get("packages") or {}).items())
    entries = {
        "status": each.case.status + (f": {each.case.message}" if each.case.message else ""),
        "directory": str(each.case.directory),
        "version": origin.get("version"),
        "commit": f"{origin['git_commit']}{dirty}" if origin.get("git_commit") else "no repository" if origin else None,
        "command": origin.get("command"),
        "written": origin.get("written"),
        "machine": ", ".join(str(origin[key]) for key in ("host", "cpu", "system") if origin.get(key)),
        "threads": origin.get("threads"),
        "packages": packages,
        "deck, SHA-256": each.case.summary.deck_sha256,
    }
    return {
        "name": each.case.name,
        "file": file_name(each.case.name, 200) + ".toml",
        "deck": each.text,
        "entries": {key: value for key, value in entries.items() if value not in (None, "")},
    }
