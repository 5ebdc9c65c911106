"""The page of a report: one HTML file that needs nothing else."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from datetime import UTC, datetime
from importlib import resources

from hydro2d import __version__
from hydro2d.analytic import model_transition
from hydro2d.study import differences, regimes
from hydro2d.study.contents import Contents
from hydro2d.study.markup import Html, element, table
from hydro2d.study.pictures import Picture
from hydro2d.study.record import Record
from hydro2d.study.table import Column, Row, columns_of_books, columns_of_results

STYLE, SCRIPT = "report.css", "report.js"
#: the page fetches nothing, and browsers see to it
POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"


def page(contents: Contents, pictures: Sequence[Picture]) -> str:
    """The whole file."""
    study = contents.study
    search = [("transitions", "Transitions", _transitions(contents))] if study.search else []
    sections = [
        *search,
        ("results", "Results", _results(contents)),
        ("figures", "Figures", _figures(pictures)),
        ("conservation", "Conservation and cost", _books(contents)),
        ("decks", "Decks", _decks(contents)),
        ("provenance", "Where it comes from", _provenance(contents)),
    ]
    links = element("nav", element("ul", [element("li", element("a", head, href=f"#{key}")) for key, head, _ in sections]),
                    aria_label="Sections")  # fmt: skip
    bodies = [
        element("section", element("h2", head, id=key), body, aria_labelledby=key) for key, head, body in sections
    ]
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", http_equiv="Content-Security-Policy", content=POLICY),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", study.title),
        element("style", Html(_file(STYLE))),
    )
    top = element("header", element("h1", study.title), _lead(contents), links)
    body = element("body", top, element("main", bodies), element("script", Html(_file(SCRIPT))))
    return "<!DOCTYPE html>\n" + element("html", head, body, lang="en") + "\n"


def _file(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


def _lead(contents: Contents) -> Html:
    """What this is, when it was made, how far the study is, and what could not be read."""
    states = Counter(each.case.status for each in contents.records)
    counted = ", ".join(f"{number} {status}" for status, number in states.items())
    now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
    made = f"hydro2d {__version__}, {now}. {len(contents.records)} cases: {counted}."
    notes = [element("li", note) for note in contents.notes]
    told = [element("p", element("strong", "Not everything could be used:")), element("ul", notes)] if notes else None
    return element("div", element("p", made), element("div", told, class_="notes", role="note") if told else None)


def _heads(columns: Sequence[Column]) -> list[str]:
    return ["Case", *(column.head for column in columns)]


def _cells(row: Row, columns: Sequence[Column], number: int) -> Html:
    """One row of a table; the name of the case leads to where it comes from."""
    name = element("th", element("a", row["case"], href=f"#case-{number}"), scope="row")
    cells = [_cell(row, column) for column in columns]
    return element("tr", name, cells, class_=None if row["status"] == "done" and not row["message"] else "unfinished")


def _cell(row: Row, column: Column) -> Html:
    shown = column.show(row) or "–"
    if column.name == "status" and row["message"]:
        return element("td", shown, element("span", row["message"], class_="message"))
    value = row.get(column.name) if column.number else None
    return element("td", shown, class_="number" if column.number else None, data_value=value)


def _transitions(contents: Contents) -> Html:
    """The brackets of a search, one row for each combination of the axes; what is open; the criteria."""
    found = regimes.of_study(contents.study, contents.records)
    names = list(dict.fromkeys(bracket.name for each in found for bracket in each.brackets))
    rows = [_of_combination(each, names) for each in found]
    notes = [element("li", f"{each.title}: {note}") for each in found for note in each.notes]
    criteria = [(element("dt", name), element("dd", text)) for name, text in regimes.criteria(contents.study).items()]
    caption = "Impact velocities between which the regime changes, beside what is known and what analytic models predict"
    legend = f"Known and models: where a rod is no longer rigid. {regimes.FILE} has all of it, with the models' inputs."
    return Html(
        table(caption, ("Combination", *names, "Known", "Models", "Runs"), rows)
        + (element("ul", notes, class_="legend") if notes else "")
        + element("dl", criteria)
        + element("p", legend, class_="legend")
    )


def _of_combination(each: regimes.Transitions, names: Sequence[str]) -> Html:
    brackets = {bracket.name: regimes.in_words(bracket) for bracket in each.brackets}
    known = [f"{bracket.name}: {model_transition.extent(bracket)}" for bracket in each.known]
    models = [f"{entry.model.name}: {entry.in_words}" for entry in each.predictions]
    cells = [*(brackets.get(name, "–") for name in names), "; ".join(known) or "–", "; ".join(models) or "–", len(each.runs)]
    return element("tr", element("th", each.title, scope="row"), [element("td", cell) for cell in cells])


def _results(contents: Contents) -> Html:
    columns = columns_of_results(contents.study)
    rows = [_cells(row, columns, number) for number, row in enumerate(contents.rows)]
    caption = "Cases: depth below the original surface, experiment, and the rod at the end"
    legend = (
        "Error: run less experiment, for runs that are done and within 0.5 % of its velocity. ≈ estimated; ≥ at least: "
        "the plate was perforated, or the rod left the mesh. An error is then at least (≥) or at most (≤) what is shown, or "
        "the experiment's depth was reached. Values of runs that are not done are the last that were written. All columns "
        "in SI: cases.csv."
    )
    return Html(table(caption, _heads(columns), rows, class_="sortable") + element("p", legend, class_="legend"))


def _books(contents: Contents) -> Html:
    columns = columns_of_books()
    rows = [_cells(row, columns, number) for number, row in enumerate(contents.rows)]
    caption = "Relative changes from start to end, less what is booked; the largest booked sinks of energy; cost"
    return table(caption, _heads(columns), rows, class_="sortable")


def _figures(pictures: Sequence[Picture]) -> Html:
    if not pictures:
        return element("p", "There is no figure: no run has a rod and a target.")
    return Html("".join(_figure(picture) for picture in pictures))


def _figure(picture: Picture) -> Html:
    notes = element("ul", [element("li", note) for note in picture.notes], class_="legend") if picture.notes else None
    image = element("img", src=picture.data, alt=picture.alt)
    about = element("figcaption", picture.caption, f" File: {picture.file.name}.")
    return element("div", element("h3", picture.heading), element("figure", image, about), notes, class_="figure")


def _decks(contents: Contents) -> Html:
    decks = {each.case.name: each.deck for each in contents.records if each.deck}
    if not decks:
        return element("p", "No case has a deck yet.")
    found = differences.compare(decks)
    rows = [row for key, users in found.varying.items() for row in _key_rows(contents, key, users)]
    common = [element("tr", element("th", key, scope="row"), element("td", value)) for key, value in found.common.items()]
    own = ", ".join(differences.OWN)
    caption = "Keys in which the decks differ, in SI"
    varying = table(caption, ("Key", "Value", "Cases"), rows, class_="decks") if rows else element("p", "They are the same.")
    folded = element("details", element("summary", f"What all {len(decks)} decks share: {len(common)} keys"),
                     table("Keys of all decks, in SI", ("Key", "Value"), common), class_="common")  # fmt: skip
    note = element("p", f"Resolved decks, every default written out. Left out: {own}.", class_="legend")
    return Html(varying + note + folded)


def _key_rows(contents: Contents, key: str, users: dict[str, tuple[str, ...]]) -> list[Html]:
    """The rows of one key: a value and the cases that have it."""
    rows = []
    for number, (value, names) in enumerate(users.items()):
        head = element("th", key, scope="rowgroup", rowspan=len(users) if len(users) > 1 else None) if number == 0 else None
        rows.append(element("tr", head, element("td", value), element("td", _who(contents, names))))
    return rows


def _who(contents: Contents, names: tuple[str, ...]) -> str:
    """Cases by the value of an axis where that is the same, else by their names."""
    with_deck = {each.case.name: each.case for each in contents.records if each.deck}
    for axis in contents.study.axes:
        for label in axis.values:
            if set(names) == {name for name, case in with_deck.items() if case.values.get(axis.name) == label}:
                return f"{axis.name} = {label} ({len(names)})"
    return differences.shortened(names)


def _provenance(contents: Contents) -> Html:
    return Html("".join(_origin(each, number) for number, each in enumerate(contents.records)))


def _origin(each: Record, number: int) -> Html:
    """Version, machine and command of one case, folded."""
    found = each.case.summary.get("provenance") or {}
    dirty = {True: ", with local changes", False: "", None: ""}[found.get("git_dirty")]
    packages = ", ".join(f"{name} {version}" for name, version in (found.get("packages") or {}).items())
    entries = {
        "status": each.case.status + (f": {each.case.message}" if each.case.message else ""),
        "directory": str(each.case.directory),
        "version": found.get("version"),
        "commit": f"{found['git_commit']}{dirty}" if found.get("git_commit") else "no repository" if found else None,
        "command": found.get("command"),
        "written": found.get("written"),
        "machine": ", ".join(str(found[key]) for key in ("host", "cpu", "system") if found.get(key)),
        "threads": found.get("threads"),
        "packages": packages,
        "deck, SHA-256": each.case.summary.get("deck_sha256"),
    }
    terms = [(element("dt", key), element("dd", value)) for key, value in entries.items() if value not in (None, "")]
    return element("details", element("summary", each.case.name), element("dl", terms), id=f"case-{number}")
