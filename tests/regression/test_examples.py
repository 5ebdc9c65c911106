"""Every example of the pages runs as a reader would run it: page by page, in order, in a folder of its own.

The folder has the decks and studies of `problems`, cut short: a deck ends after a few cycles, an axis of a study has one value
or two, and cases run in this process. The commands are those of the page, except for the names that a reader fills in.
"""

import glob
import importlib
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import pytest

from hydro2d import jit
from hydro2d.cli.main import app, call
from hydro2d.deck import deck as decks
from hydro2d.deck import templates
from hydro2d.files import shipped, toml
from hydro2d.study import study_parts
from hydro2d.study.plan import cases
from hydro2d.study.plan.scaling import AS_IT_IS
from hydro2d.study.run import cluster
from tests.rules import source

#: cycles of a run, enough to make a hole
CYCLES = 40
DECK = "problems/cth_nose_shape/hemi_5083_1086.toml"
SWEEP = "problems/cth_nose_shape/velocity_advection.toml"
SEARCH = "problems/cth_nose_shape/transition_hemi_5083.toml"

#: commands that are not run, by their beginnings, and why
NOT_RUN = {
    "python3 -m venv": "the tests run in an installation",
    ". .venv/bin/activate": "the tests run in an installation",
    "pip install": "the tests run in an installation",
    "python -m build": "it compiles all kernels; tests/jit/test_shipped.py builds a wheel",
    "python -m pytest": "it is what runs this",
    "python -m sphinx": "tests/rules/test_documentation.py builds the pages",
    "python -m tests.study.overhead": "a hundred runs: minutes",
    "python -m tests.study.coverage": "1200 made-up searches: minutes",
    "python -m tests.trials.campaign": "5000 runs: an hour; tests/trials/test_mutants.py has some of them",
    "python -m tests.trials.crowd": "1000 decks: a quarter of an hour; tests/trials/test_crowd.py has some of them",
    "hydro2d bench": "minutes",
    "python -m problems.grind_times": "it needs what `hydro2d bench` measured; tests/problems/test_grind_times.py",
    "python docs/gallery.py": "half an hour; tests/regression/test_gallery.py has it in short form",
    "hydro2d diverge": "runs of a few cycles have no time in common; tests/study/test_divergence.py has made-up ones",
    "hydro2d plot runs/ball -o debris.png": "nothing flies behind a plate yet; tests/results/test_line_figures.py draws debris",
    "python -m problems.validation.experience": "a minute; tests/problems/test_experience.py has the quick models",
    "python -m problems.verification.table runs": "five minutes; tests/verification/test_accuracy.py has the cheap runs",
    "dask ": "needs a cluster",
    "hydro2d sweep problems/cth_nose_shape/study.toml --background": "its process would outlive the test",
}
#: names that a reader fills in, the longest first, and a window in which a short run shows something
FILLED = {
    "hydro2d transition STUDY.toml": f"hydro2d transition {SEARCH}",
    "hydro2d transition FILE": f"hydro2d transition {SEARCH}",
    "hydro2d report DIRECTORY": "hydro2d report runs/velocity_advection",
    "hydro2d model NAME": "hydro2d model tate",
    "hydro2d info NAME": "hydro2d info johnson-cook",
    "hydro2d new KIND": "hydro2d new --list",
    "STUDY.toml": SWEEP,
    "runs/STUDY": "runs/velocity_advection",
    "FILE.png": "picture.png",
    "FILE": SWEEP,
    "DECK": DECK,
    "DIR": "runs/shot",
    "RUN": "runs/shot",
    "150 mm,215 mm,20 mm": "-5 mm,15 mm,20 mm",
}
#: files that a page assumes in its folder: a deck or a study that has run, or one of its blocks, by number
PRESUMED = {
    "docs/how-to/index.md": {"runs/shot": DECK},
    "docs/tutorials/first-study.md": {"first_study.toml": 0},
    "docs/how-to/depth-curves.md": {"curve.toml": 0},
    "docs/how-to/find-a-transition.md": {"limit.toml": 0},
    "docs/how-to/make-a-film.md": {"runs/shot": DECK},
    "docs/how-to/own-result.md": {"bulge.py": 0},
    "docs/how-to/paraview.md": {"runs/shot": DECK},
    "docs/how-to/perforate-a-plate.md": {"runs/shot": DECK},
    "docs/how-to/restart.md": {"runs/shot": DECK},
    "docs/how-to/uncertain-inputs.md": {"uncertain.toml": 0, "both_laws.toml": 2, "with_salib.toml": 4},
    "docs/how-to/use-a-model.md": {"runs/a": DECK, "runs/b": DECK},
    "docs/how-to/write-a-deck.md": {"my_deck.toml": 0},
    "docs/reference/files.md": {"runs/shot": DECK},
    "docs/explanation/penetration/transition.md": {"runs/a": DECK, "runs/b": DECK},
}
#: pages whose commands take longer than five seconds
LONG = (
    "README.md", "docs/explanation/how-sure.md", "docs/explanation/sanity.md", "docs/gallery.md", "docs/how-to/depth-curves.md",
    "docs/how-to/find-a-transition.md", "docs/how-to/index.md", "docs/how-to/report.md", "docs/how-to/run-a-shot.md",
    "docs/how-to/run-a-study.md", "docs/how-to/uncertain-inputs.md", "docs/tutorials/first-study.md",
    "problems/ceramics/README.md", "problems/cth_nose_shape/README.md", "problems/verification/README.md",
)
#: decks under which keys are laid, in addition to those of the nose shapes
BASES = {
    "docs/how-to/perforate-a-plate.md": "../perforation/two_plates.toml",
    "docs/how-to/jackets.md": "../classic/jacketed_rod.toml",
    "docs/explanation/explosives.md": "../explosives/cylinder.toml",
}
QUICK = "hemi_5083_1086_quick.toml"

FENCE = re.compile(r"^```([^\n`]*)\n(.*?)^```", re.M | re.S)
INDENTED = re.compile(r"(?<=\n\n)(?:    .*\n|\n(?=    ))+")
INLINE = re.compile(r"`([^`]+)`")
#: words of fences: blocks that run or must be valid, and blocks that are only shown
LANGUAGES, SHOWN = ("sh", "python", "toml"), ("", "text", "json", "csv")
COMMAND = re.compile(r"(?:\.venv/bin/)?(?:hydro2d|python3?|pip|dask) ")
#: a command that the text names without giving it in full
NAME = re.compile(r"hydro2d ([a-z-]+)(?: transition)?|python -m (problems[\w.]+)")


def commands(block: str) -> list[tuple[int, str]]:
    """The commands of a block with their line numbers in it."""
    lines = [re.sub(r"\s#.*", "", line) for line in block.splitlines()]
    parts = [(number, part.strip()) for number, line in enumerate(lines) for part in line.split("&&")]
    return [(number, part.removeprefix(".venv/bin/")) for number, part in parts if part]


def examples(text: str) -> list[tuple[int, str, str]]:
    """The examples of a page in order: line, kind (sh, python, toml, or the name of a command) and text."""
    texts = []

    def taken(match: re.Match, kind: str, block: str) -> str:
        """Keeps an example and returns blank lines for it."""
        line = text.count("\n", 0, match.start(match.lastindex or 0)) + 1
        if kind == "sh":
            texts.extend((line + number, "sh", command) for number, command in commands(block))
        elif kind:
            texts.append((line, kind, block))
        return re.sub(r"[^\n]", " ", match[0])

    def fence(match: re.Match) -> str:
        return taken(match, match[1] if match[1] in LANGUAGES else "", match[2])

    def indented(match: re.Match) -> str:
        block = re.sub(r"^    ", "", match[0], flags=re.M)
        kind = "sh" if COMMAND.match(block) else "toml" if block.startswith("[") else ""
        return taken(match, kind, block) if kind else match[0]

    def inline(match: re.Match) -> str:
        command = " ".join(match[1].split())
        return taken(match, ("name" if NAME.fullmatch(command) else "sh") if COMMAND.match(command) else "", command)

    INLINE.sub(inline, INDENTED.sub(indented, FENCE.sub(fence, text)))
    return sorted(texts, key=lambda example: example[0])


#: pages with examples; add-a-model and easyvvuq have tests of their own
TEXTS = {
    name: file.read_text(encoding="utf-8")
    for file in source.tracked_files()
    if re.fullmatch(r"(docs|problems)/.*\.md|README\.md", name := str(file.relative_to(source.ROOT)))
    and file.name not in ("add-a-model.md", "easyvvuq.md")
}
PAGES = {page: found for page, text in TEXTS.items() if (found := examples(text))}


def with_kind(*kinds: str) -> list[str]:
    return [page for page, examples_of_page in PAGES.items() if any(kind in kinds for _, kind, _ in examples_of_page)]


def of_kind(page: str, *kinds: str) -> list[tuple[int, str, str]]:
    return [(line, kind, text) for line, kind, text in PAGES[page] if kind in kinds]


@pytest.fixture(scope="module")
def short(tmp_path_factory) -> Path:
    """A folder with the decks and studies, cut short."""
    folder = tmp_path_factory.mktemp("short")
    shutil.copytree(source.PROBLEMS, folder / "problems", ignore=shutil.ignore_patterns("*.py", "__pycache__"))
    for file in folder.rglob("*.toml"):
        data = tomllib.loads(file.read_text(encoding="utf-8"))
        if file.parent.name != "materials":
            data = short_study(data) if toml.is_study(data) else toml.merge(data, {"stop": {"cycles": CYCLES}})
            file.write_text(toml.dumps(data))
    return folder


def short_study(data: dict) -> dict:
    """Two values of the first axis and one of the others; a search is reduced to its ends."""
    for number, axis in enumerate(data.get("axis", ())):
        several = slice(1 if number else 2)
        if "range" in axis:
            axis["values"] = [axis.pop("range")["from"]]
        elif "values" in axis:
            axis["values"] = axis["values"][several]
        else:
            axis["variants"] = dict(list(axis["variants"].items())[several])
    if "budget" in data.get("transition", {}):
        data["transition"]["budget"] = 4
    else:
        data.get("transition", {})["tolerance"] = "1 km/s"
    data.get("ensemble", {})["repeats"] = 2
    for part in data.get("part", ()):
        for key in ("only", "skip"):
            part.pop(key, None)
    return {key: value for key, value in data.items() if key != "exclude"}


class Client:
    """The part of dask that a sweep needs: a case runs, in this process, as it is submitted."""

    def submit(self, task, *arguments, key, pure):
        outcome = task(*arguments)
        future = SimpleNamespace(key=key, status="finished", result=lambda: outcome, release=lambda: None)
        future.add_done_callback = lambda tell: tell(future)
        return future

    def scheduler_info(self, n_workers):
        return {"workers": {"here": {}}}


@contextmanager
def in_this_process(workers, threads):
    yield Client()


@pytest.fixture
def folder(short, tmp_path, monkeypatch):
    """Prepares a reader's folder for a page; the runs that it assumes have been made once."""
    monkeypatch.setattr(cluster, "local", in_this_process)
    shutil.copytree(short / "problems", tmp_path / "problems")  # no rows of one page reach the next one
    for module in (templates, shipped):
        monkeypatch.setattr(module, "problems_folder", lambda: tmp_path / "problems")
    monkeypatch.chdir(tmp_path)
    threads = jit.threads()

    def prepare(page: str) -> None:
        for name, file in PRESUMED.get(page, {}).items():
            if isinstance(file, int):
                Path(name).write_text(of_kind(page, "toml" if name.endswith(".toml") else "python")[file][2])
                continue
            kept = short / "runs" / Path(file).stem
            if not kept.exists():
                assert call(["sweep" if file == SWEEP else "run", file, "--quiet", "--out", str(kept)]) == 0
            shutil.copytree(kept, name)

    yield prepare
    jit.set_threads(threads)


def run(command: str) -> int:
    """Runs a command of a page and returns its exit status."""
    for name, value in FILLED.items():
        command = re.sub(rf"(?<!\w){re.escape(name)}(?![\w.])", value, command)
    program, *words = shlex.split(command)
    words = [path for word in words for path in sorted(glob.glob(word)) or [word]]
    if program == "hydro2d":
        return call(words)
    assert program in ("python", "python3"), f"{command}: it is neither run nor listed in NOT_RUN"
    if words[1].startswith("problems."):
        return importlib.import_module(words[1]).main(words[2:])
    return subprocess.run([sys.executable, *words], stdout=subprocess.DEVNULL).returncode


@pytest.mark.parametrize("page", [pytest.param(page, marks=[pytest.mark.thorough] * (page in LONG))
                                  for page in with_kind("sh", "python")])
def test_examples_run(page, folder, capsys):
    folder(page)
    names = {"__name__": page}
    for line, kind, text in of_kind(page, "sh", "python"):
        if kind == "python":
            exec(compile("\n" * (line - 1) + text, page, "exec"), names)
        elif not text.startswith(tuple(NOT_RUN)):
            assert run(text) == 0, f"{page}:{line}: {text}\n{capsys.readouterr().err}"


@pytest.mark.parametrize("page", with_kind("name"))
def test_names_of_commands_exist(page):
    for line, _, text in of_kind(page, "name"):
        command, module = NAME.fullmatch(text).groups()
        assert command in app if command else importlib.util.find_spec(module), f"{page}:{line}: {text}"


@pytest.mark.parametrize("page", with_kind("toml"))
def test_toml_of_the_text_is_valid(page, folder):
    """With the decks of the nose shapes and the tables of the page; an incomplete part is laid over a deck or a search."""
    folder(page)
    for _, _, text in of_kind(page, "sh"):
        if text.startswith("hydro2d tabulate "):
            assert run(text.replace(" -o ", " -o problems/cth_nose_shape/")) == 0
    for line, _, text in of_kind(page, "toml"):
        data, file = tomllib.loads(text), Path(f"problems/cth_nose_shape/line_{line}.toml")
        if "sample" in data:
            data = {"deck": DECK} | data
            text = toml.dumps(data)
            if table := data["sample"].get("table"):  # the page makes it
                body = decks.load(data["deck"]).body[0]
                file.with_name(table).write_text(f"body.{body.name}.strength_factor\n1.05\n")
        if {"transition", "ensemble", "keep"} & set(data) and "deck" not in data:
            whole = tomllib.loads(Path(SEARCH if "transition" in data else SWEEP).read_text(encoding="utf-8"))
            if "budget" in data.get("transition", {}):
                del whole["transition"]["tolerance"]
            data = toml.merge(whole, data)
            text = toml.dumps(data)
        elif not {"deck", "include", "mesh", "cores", "part"} & set(data):
            text = f'include = "{BASES.get(page, QUICK)}"\n{text}'
        if str(data.get("include", "")).startswith("problems/"):
            file = Path(file.name)  # a deck in the reader's folder
        file.write_text(text)
        if "cores" in data:
            assert cluster.read_slurm(file)
        elif "part" in data:
            assert [each.states[0] for each in study_parts.plans(file, (), AS_IT_IS, quiet=True)], f"{page}:{line}"
        elif toml.is_study(data):
            assert [case.message for case in cases.plan(file, quiet=True).cases if case.message] == [], f"{page}:{line}"
        else:
            assert decks.load(file).body, f"{page}:{line}"


def test_listed_names_are_in_the_pages():
    """Names to fill in, pages, and commands that are not run; and every block is in a language that is checked."""
    given = [text for page in PAGES for _, _, text in of_kind(page, "sh")]
    assert [name for name in FILLED if not any(name in text for text in given)] == []
    assert [begin for begin in NOT_RUN if not any(text.startswith(begin) for text in given)] == []
    assert set(PRESUMED) | set(BASES) <= set(PAGES)
    languages = {match[1] for text in TEXTS.values() for match in FENCE.finditer(text)}
    assert {word for word in languages if not word.startswith("{")} <= {*LANGUAGES, *SHOWN}
