"""Keeps the numbers that pages quote equal to those of the runs and results that they are of.

    python docs/quoted.py           # makes the runs that are not up to date, and keeps their numbers in docs/quoted.json
    python docs/quoted.py --write   # puts the numbers into the pages as well, and executes notebooks that are not up to date
    python docs/quoted.py --check   # names the pages with other numbers

docs/quoted.toml lists the runs, and the sentences of every page with what stands in their places. A run is up to date if it is
of this version of the method and its decks are those of today. A test does what --check does, without a run.
"""

from __future__ import annotations

import argparse
import ast
import functools
import hashlib
import json
import os
import re
import shlex
import shutil
import string
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path.insert(0, str(ROOT))

import figures  # noqa: E402
import nbformat  # noqa: E402
from _pages import claims  # noqa: E402

import hydro2d  # noqa: E402
from hydro2d.base.method_version import METHOD  # noqa: E402
from hydro2d.study.plan import cases  # noqa: E402

LIST, KEPT = HERE / "quoted.toml", HERE / "quoted.json"
#: where the runs are made, and lie until they are made again
RUNS = HERE / "_build" / "quoted"
#: what a place in a sentence may hold, and digits of a number that is kept
PLACE, DIGITS = r"([^\n|]{1,60}?)", 8
#: the lines with which the log of a run closes, from this beginning; the time before them; what of them the machine decides
CLOSING, TIME, OF_MACHINE = "done: ", re.compile(r"^[\dT:-]{19}  "), re.compile(r"(?<=us) in [\d.]+ .*")
#: the line with the cycles of a run
CYCLES = re.compile(r"\d+ cycles to ")
#: a line that only the closing lines of a run have
OF_A_RUN = re.compile(r"(?m)^(?:done: |perforated {2}|penetration depth {2}|rod length {2}|residual \w+ {2})")
#: pages of a reader's first hour, by their places below the top of the repository
FIRST_HOUR = ("README.md", "docs/tutorials/*.md", "docs/tutorials/*.ipynb", "docs/how-to/*.md", "problems/*/README.md")
#: between the cells of a notebook, whose prose is one text here
CELL = "\f"

Names = Mapping[str, Callable]


@functools.cache
def listed() -> dict:
    """The contents of docs/quoted.toml."""
    return tomllib.loads(LIST.read_text(encoding="utf-8"))


def kept() -> dict[str, dict]:
    """The contents of docs/quoted.json: method, setups, values by their expressions, and closing lines of every run."""
    return json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.is_file() else {}


def read(file: Path) -> nbformat.NotebookNode:
    """A notebook."""
    return nbformat.read(file, as_version=4)


def notebooks() -> list[Path]:
    """The notebooks of the tutorials."""
    return sorted((HERE / "tutorials").glob("*.ipynb"))


# runs


def arguments_of(command: str) -> argparse.Namespace:
    """The deck or study of a command, the keys that it sets, and whether it makes one run."""
    parser = argparse.ArgumentParser()
    parser.add_argument("kind")
    parser.add_argument("file")
    parser.add_argument("--set", action="append", default=[])
    given, rest = parser.parse_known_args(shlex.split(command))
    given.single = given.kind == "run" and "--repeats" not in rest
    return given


@functools.cache
def _saved() -> tempfile.TemporaryDirectory:
    """The folder of files that pages have their readers save."""
    return tempfile.TemporaryDirectory()


def file_of(name: str) -> Path:
    """A deck or study of the repository, or the one that a page has its reader save. Raises FileNotFoundError."""
    if (ROOT / name).is_file():
        return ROOT / name
    for page in listed()["page"]:
        files = {saved: text for saved, _, text in figures.blocks((ROOT / page["file"]).read_text(encoding="utf-8")) if saved}
        if name in files:
            folder = Path(_saved().name) / Path(page["file"]).stem
            folder.mkdir(exist_ok=True)
            for saved, text in files.items():  # a deck may name another file of its page
                (folder / saved).write_text(text, encoding="utf-8")
            return folder / name
    raise FileNotFoundError(f"{LIST.name}: {name} is no file of the repository, and no page has its reader save it")


def setups(command: str) -> dict[str, str]:
    """The hashes of the decks that a command runs; of repeats that of the unchanged deck."""
    given = arguments_of(command)
    file = file_of(given.file)
    if given.kind == "run":
        return {file.name: hydro2d.Deck.from_file(file, given.set).setup}
    return {case.name: hydro2d.Deck.from_toml(case.text).setup for case in cases.plan(file, given.set, quiet=True).cases}


def make(name: str, again: bool) -> tuple[object, Path]:
    """Makes a run. Returns its summary, of several runs their table, and the directory.

    again : makes it even if the directory of an earlier call is up to date; a study that has not ended is continued otherwise
    """
    command, folder = listed()["runs"][name], RUNS / name
    given, wanted_setups = arguments_of(command), set(setups(command).values())
    found = (lambda: hydro2d.open_run(folder).summary) if given.single else (lambda: hydro2d.runs(folder))
    words = [str(file_of(given.file)) if word == given.file else word for word in shlex.split(command)]
    made = hydro2d.runs(folder) if folder.exists() and not again else None
    of_method = made is not None and set(made["method"].dropna()) == {METHOD}
    if of_method and set(made["status"]) == {"done"} and wanted_setups <= set(made["setup"]):
        return found(), folder
    if of_method and given.kind == "sweep":
        words += ["--resume", "--overwrite"]  # what has ended is kept, unless its deck has changed
    else:
        shutil.rmtree(folder, ignore_errors=True)
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    subprocess.run([sys.executable, "-m", "hydro2d", *words, "--quiet", "--out", str(folder)], env=environment, check=True)
    return found(), folder


def closing(folder: Path) -> list[str]:
    """The closing lines of a run, without what the machine decides; none for several runs."""
    log = folder / "log.txt"
    lines = [TIME.sub("", line) for line in log.read_text(encoding="utf-8").splitlines()] if log.is_file() else []
    start = next((number for number, line in enumerate(lines) if line.startswith(CLOSING)), len(lines))
    return [OF_MACHINE.sub("", line).rstrip() for line in lines[start:]]


def expressions(template: str) -> list[tuple[str, str, str]]:
    """The parts of a template: the text before an expression, the expression and its format; the last part is text alone."""
    return [(text, expression or "", form or "") for text, expression, form, _ in string.Formatter().parse(template)]


def run_of(expression: str) -> str | None:
    """The run of which an expression takes its numbers; None for an expression of kept results."""
    names = {node.id for node in ast.walk(ast.parse(expression, mode="eval")) if isinstance(node, ast.Name)}
    return next((name for name in listed()["runs"] if name in names), None)


def wanted(run: str) -> list[str]:
    """The expressions of all quotes that take numbers of a run."""
    found = [expression for page in listed()["page"] for quote in page.get("quotes", ())
             for _, expression, _ in expressions(quote) if expression and run_of(expression) == run]
    return sorted(set(found))


def faults_of_runs(known: Mapping[str, dict]) -> dict[str, str]:
    """The runs that are not up to date, and why."""
    found = {}
    for name, command in listed()["runs"].items():
        entry = known.get(name, {})
        if entry.get("method") != METHOD:
            found[name] = f"is of the method {entry.get('method', 'of no day')}, and this is {METHOD}"
        elif entry["setups"] != setups(command):
            found[name] = "is of another deck"
        elif entry["command"] != command or set(wanted(name)) - set(entry["values"]):
            found[name] = "lacks a number that a page quotes"
    return found


def measured(name: str, again: bool) -> dict:
    """Makes a run, as `make` does. Returns what docs/quoted.json keeps of it."""
    command = listed()["runs"][name]
    found, folder = make(name, again)
    names = {**vars(claims), name: found, "opened": lambda _: hydro2d.open_run(folder)}
    values = {text: eval(text, names) for text in wanted(name)}
    short = {text: value if isinstance(value, str) else float(f"{value:.{DIGITS}g}") for text, value in values.items()}
    return {"command": command, "method": METHOD, "setups": setups(command), "values": short, "closing": closing(folder)}


# pages


def prose(file: Path) -> str:
    """The text of a page; of a notebook its cells of prose."""
    if file.suffix != ".ipynb":
        return file.read_text(encoding="utf-8")
    return CELL.join(cell.source for cell in read(file).cells if cell.cell_type == "markdown")


def save(file: Path, text: str) -> None:
    """Writes what `prose` has read."""
    if file.suffix != ".ipynb":
        file.write_text(text, encoding="utf-8")
        return
    notebook, sources = read(file), iter(text.split(CELL))
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            cell.source = next(sources)
    nbformat.write(notebook, file)


def printed(file: Path) -> Names:
    """What the expressions of a page may use beside runs and claims: of a notebook `said`, for what its cells have printed."""
    if file.suffix != ".ipynb":
        return {}
    cells = {cell.id: cell for cell in read(file).cells}

    def said(name: str, number: int = 0) -> float:
        """A number that a cell of this name has printed, counted from 0."""
        text = "".join(output.get("text", "") for output in cells[name].outputs)
        return float(re.findall(r"-?\d+(?:\.\d+)?", text)[number])

    return {"said": said}


def shown(expression: str, form: str, known: Mapping[str, dict], names: Names) -> str:
    """What stands on a page for an expression, thousands apart by a space. Raises KeyError for a number that is not kept."""
    run = run_of(expression)
    value = known[run]["values"][expression] if run else eval(expression, {**vars(claims), **names})
    text = format(value, form)
    return text.replace(",", " ") if "," in form else text


def quoted(text: str, template: str, known: Mapping[str, dict], names: Names = MappingProxyType({})) -> str:
    """The text of a page with the numbers of one sentence. Raises ValueError unless the page has the sentence just once."""
    parts = expressions(template)
    if parts[-1][1]:
        raise ValueError(f'has a quote that ends with a number: "{template}"')
    literal = [r"\s+".join(map(re.escape, re.split(r"\s+", before))) for before, _, _ in parts]
    pattern = "".join(piece + (PLACE if expression else "") for piece, (_, expression, _) in zip(literal, parts, strict=True))
    found = list(re.finditer(pattern, text))
    if len(found) != 1:
        raise ValueError(f'has {len(found) or "no"} sentence{"s" * (len(found) > 1)} "{template}"')
    places = [(expression, form) for _, expression, form in parts if expression]
    for number, (expression, form) in reversed(list(enumerate(places, 1))):
        start, end = found[0].span(number)
        text = text[:start] + shown(expression, form, known, names) + text[end:]
    return text


def blocks_of_runs(text: str) -> Iterator[re.Match]:
    """The fenced blocks with closing lines of a run, in the order of a page."""
    return (match for match in figures.FENCE.finditer(text) if OF_A_RUN.search(match[2]))


def label(line: str) -> str:
    """What a closing line is of: its beginning without numbers."""
    return re.split(r" {2,}|[\d:]", line.strip())[0]


def excerpt(block: str, lines: list[str]) -> str:
    """The closing lines from the label of a block's first line to that of its last; what the machine decides is kept.

    The line with the cycles is left out if the block has none. Raises ValueError if the run has no such lines.
    """
    shown_lines = block.splitlines()
    labels = [label(line) for line in lines]
    try:
        first, last = labels.index(label(shown_lines[0])), len(labels) - 1 - labels[::-1].index(label(shown_lines[-1]))
    except ValueError:
        raise ValueError(f'has a block "{shown_lines[0]}", and the run has no such line') from None
    machine = next((found[0] for line in shown_lines if (found := OF_MACHINE.search(line))), None)
    of_cycles = [bool(CYCLES.match(line)) for line in lines]
    return "".join(f"{line}{machine if of_cycles[number] else ''}\n" for number, line in enumerate(lines[: last + 1])
                   if number >= first and (machine is not None or not of_cycles[number]))


def renewed(text: str, page: Mapping, known: Mapping[str, dict]) -> tuple[str, list[str]]:
    """The text of a page with the numbers of today, and what is wrong with the page."""
    wrong, names = [], printed(ROOT / page.get("file", ""))
    for template in page.get("quotes", ()):
        try:
            text = quoted(text, template, known, names)
        except (ValueError, KeyError) as error:
            wrong.append(str(error) if isinstance(error, ValueError) else f"quotes {error}, which docs/quoted.json lacks")
    found, runs = list(blocks_of_runs(text)), page.get("blocks", ())
    if len(found) != len(runs):
        wrong.append(f"has {len(found)} block(s) with closing lines of a run, and docs/quoted.toml names {len(runs)}")
        return text, wrong
    for match, run in reversed(list(zip(found, runs, strict=True))):
        try:
            text = text[: match.start(2)] + excerpt(match[2], known[run]["closing"]) + text[match.end(2) :]
        except (ValueError, KeyError) as error:
            wrong.append(str(error))
    return text, wrong


def pages() -> dict[str, dict]:
    """The entries of docs/quoted.toml by their pages, and pages of the first hour without one."""
    first = [str(file.relative_to(ROOT)) for pattern in FIRST_HOUR for file in sorted(ROOT.glob(pattern))]
    return dict.fromkeys(first, {}) | {page["file"]: page for page in listed()["page"]}


def faults_of_pages(known: Mapping[str, dict], write: bool = False) -> list[str]:
    """What is wrong with the numbers of pages, with the page; write : puts the right numbers in."""
    found = []
    for name, page in pages().items():
        text = prose(ROOT / name)
        new, wrong = renewed(text, page, known)
        found += [f"{name}: {each}" for each in wrong]
        if new != text and write:
            save(ROOT / name, new)
            print(f"{name}: written", flush=True)
        elif new != text:
            changed = [f'"{old.strip()}" is "{line.strip()}"' for old, line in
                       zip(text.splitlines(), new.splitlines(), strict=False) if old != line]
            found += [f"{name}: {each}" for each in changed[:1]]
    return found


# notebooks


def stamp(notebook: nbformat.NotebookNode) -> dict:
    """What the outputs of a notebook are of: the method, the shipped decks that it names, and its code."""
    code = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "code")
    decks = sorted(set(re.findall(r'"(problems/[\w/]+\.toml)"', code)))
    return {"method": METHOD, "setups": {deck: hydro2d.Deck.from_file(ROOT / deck).setup for deck in decks},
            "code": hashlib.sha256(code.encode()).hexdigest()[:12]}


def fault_of_notebook(notebook: nbformat.NotebookNode) -> str:
    """How the stamp of a notebook differs from that of today; empty if it does not."""
    now, then = stamp(notebook), notebook.metadata.get("hydro2d", {})
    return ", ".join(f"another {key.removesuffix('s')}" for key in now if then.get(key) != now[key])


def execute(file: Path) -> None:
    """Executes a notebook in a folder of its own, and stores its outputs with the stamp."""
    from nbclient import NotebookClient

    notebook = read(file)
    with tempfile.TemporaryDirectory() as folder:
        NotebookClient(notebook, timeout=None, record_timing=False, resources={"metadata": {"path": folder}}).execute()
    notebook.metadata["hydro2d"] = stamp(notebook)
    nbformat.write(notebook, file)


def main(arguments: list[str] | None = None) -> int:
    """Makes runs, and writes or checks pages. The status is 1 if a page has other numbers."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="*", metavar="RUN", help="these runs and no others")
    parser.add_argument("--again", action="store_true", help="makes runs and notebooks that are up to date as well")
    parser.add_argument("--write", action="store_true", help="writes pages and notebooks")
    parser.add_argument("--check", action="store_true", help="makes no run")
    given = parser.parse_args(arguments)
    stale = faults_of_runs(kept())
    chosen = [name for name in given.runs or listed()["runs"] if given.again or name in stale]
    for name in () if given.check else chosen:
        print(f"{name}: {listed()['runs'][name]}", flush=True)
        known = {**kept(), name: measured(name, given.again)}
        ordered = {each: known[each] for each in listed()["runs"] if each in known}
        KEPT.write_text(json.dumps(ordered, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    for file in notebooks():
        if given.write and not given.check and (given.again or fault_of_notebook(read(file))):
            print(f"{file.name}: executed", flush=True)
            execute(file)
    known = kept()
    wrong = [f"{name}: {why}" for name, why in faults_of_runs(known).items()] + faults_of_pages(known, given.write)
    wrong += [f"{file.name}: is of {why}" for file in notebooks() if (why := fault_of_notebook(read(file)))]
    print("\n".join(wrong) or "all numbers are those of the runs")
    return int(bool(wrong))


if __name__ == "__main__":
    raise SystemExit(main())
