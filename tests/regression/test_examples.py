"""Every example of the pages runs, as a reader would run it: page by page, in order, in a folder that begins empty.

The folder has the decks and studies of `problems`, cut short: a deck ends after a few cycles, an axis of a study has one value
or two, and the cases of a study run in this process. The commands themselves are those of the page, to the letter, but for the
names that a reader fills in.
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

from hydro2d import toml
from hydro2d.cli.main import app, call
from hydro2d.deck import deck as decks
from hydro2d.study import cases, cluster
from tests.rules import source

QUICK = "problems/cth_nose_shape/hemi_5083_1086_quick.toml"
#: pages with examples; the example of add-a-model has a test of its own
PAGES = {
    str(file.relative_to(source.ROOT)): file.read_text(encoding="utf-8")
    for pattern in ("README.md", "docs/index.md", "docs/tutorials/*.md", "docs/how-to/*.md", "docs/reference/*.md",
                    "docs/explanation/**/*.md", "problems/*/README.md")
    for file in sorted(source.ROOT.glob(pattern)) if file.name != "add-a-model.md"
}  # fmt: skip
#: what is not run, by how it begins, and why
NOT_RUN = {
    "python3 -m venv": "the tests run in an installation",
    ". .venv/bin/activate": "the tests run in an installation",
    "pip install": "the tests run in an installation",
    "python -m pytest": "it is what runs this",
    "python -m sphinx": "test_documentation builds the pages",
    "python -m tests.study.overhead": "a hundred runs: minutes",
    "hydro2d bench": "minutes",
    "dask ": "a cluster",
}
#: what a reader fills in, the longest first, and a window in which a short run has something to see
FILLED = {
    "hydro2d transition STUDY.toml": "hydro2d transition problems/cth_nose_shape/transition_hemi_5083.toml",
    "hydro2d transition FILE": "hydro2d transition problems/cth_nose_shape/transition_hemi_5083.toml",
    "hydro2d report DIRECTORY": "hydro2d report runs/velocity_advection",
    "hydro2d model NAME": "hydro2d model tate",
    "hydro2d info NAME": "hydro2d info johnson-cook",
    "STUDY.toml": "problems/cth_nose_shape/velocity_advection.toml",
    "runs/STUDY": "runs/velocity_advection",
    "FILE.png": "picture.png",
    "FILE": "problems/cth_nose_shape/velocity_advection.toml",
    "DECK": "problems/cth_nose_shape/hemi_5083_1086.toml",
    "DIR": "runs/shot",
    "RUN": "runs/shot",
    "150 mm,215 mm,20 mm": "-5 mm,15 mm,20 mm",
}
#: what a page takes for granted: runs of DECK, and the studies of STUDIES
PRESUMED = {
    "docs/how-to/make-a-film.md": ("runs/shot",),
    "docs/how-to/paraview.md": ("runs/shot",),
    "docs/how-to/perforate-a-plate.md": ("runs/shot",),
    "docs/how-to/report.md": ("runs/rigid_rod_laws", "runs/a", "runs/b"),
    "docs/how-to/restart.md": ("runs/shot",),
    "docs/how-to/use-a-model.md": ("runs/a", "runs/b"),
    "docs/reference/files.md": ("runs/shot",),
    "docs/explanation/penetration/transition.md": ("runs/a", "runs/b"),
    "docs/explanation/rigid-rod.md": ("runs/rigid_rod_laws",),
}
STUDIES = {"runs/rigid_rod_laws": "problems/cth_nose_shape/rigid_rod_laws.toml"}
#: files that a page tells its reader to write, from its first toml block
TO_WRITE = {"docs/tutorials/first-study.md": "first_study.toml"}
#: what a fragment of a deck is laid over
BASES = {"docs/how-to/perforate-a-plate.md": "../perforation/two_plates.toml"}
SEARCH = "problems/cth_nose_shape/transition_hemi_5083.toml"
#: cycles of a run
CYCLES = 40

FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.M | re.S)
INDENTED = re.compile(r"(?:^    .*\n|^\n(?=    ))+", re.M)
INLINE = re.compile(r"`([^`]+)`")
COMMAND = re.compile(r"(?:\.venv/bin/)?(?:hydro2d|python3?|pip|dask) ")
NAME = re.compile(r"hydro2d ([a-z]+)(?: transition)?|python -m (problems[\w.]+)")


def examples(text: str) -> list[tuple[int, str, str]]:
    """The examples of a page in its order: line, kind (command, python, toml, or the name of a command) and text."""
    found = []

    def take(start: int, kind: str, block: str) -> None:
        found.append((text.count("\n", 0, start) + 1, kind, block))

    def take_lines(start: int, block: str) -> None:
        for line in block.replace("\\\n", " ").splitlines():
            for command in re.sub(r"\s#.*", "", line).split("&&"):
                if command.strip():
                    take(start, "command", re.sub(r"^\s*(\.venv/bin/)?|\s*$", "", command))

    def blank(match: re.Match) -> str:
        return re.sub(r"[^\n]", " ", match[0])

    for match in FENCE.finditer(text):
        if match[1] == "sh":
            take_lines(match.start(), match[2])
        elif match[1] in ("python", "toml"):
            take(match.start(), match[1], match[2])
    text = FENCE.sub(blank, text)
    for match in INDENTED.finditer(text):
        block = re.sub(r"^    ", "", match[0], flags=re.M).lstrip("\n")
        if COMMAND.match(block):
            take_lines(match.start(), block)
        elif block.startswith("["):
            take(match.start(), "toml", block)
    text = INDENTED.sub(blank, text)
    for match in INLINE.finditer(text):
        command = " ".join(match[1].split())
        if COMMAND.match(command):
            take(match.start(), "name" if NAME.fullmatch(command) else "command", command)
    return sorted(found, key=lambda example: example[0])


def is_listed(command: str) -> bool:
    return any(command.startswith(beginning) for beginning in NOT_RUN)


EXAMPLES = {page: found for page, text in PAGES.items() if (found := examples(text))}


def of_kind(*kinds: str) -> list:
    return [pytest.param(page, id=page) for page, found in EXAMPLES.items() if any(kind in kinds for _, kind, _ in found)]


@pytest.fixture(scope="module")
def problems(tmp_path_factory) -> Path:
    """The decks and studies, cut short."""
    folder = tmp_path_factory.mktemp("short") / "problems"
    shutil.copytree(source.PROBLEMS, folder, ignore=shutil.ignore_patterns("*.py", "__pycache__"))
    for file in folder.rglob("*.toml"):
        data = tomllib.loads(file.read_text(encoding="utf-8"))
        if file.parent.name != "materials":
            file.write_text(toml.dumps(short_study(data) if toml.is_study(data) else short_deck(data)))
    return folder


def short_deck(data: dict) -> dict:
    return {**data, "stop": {**data.get("stop", {}), "cycles": CYCLES}}


def short_study(data: dict) -> dict:
    """Two values of the first axis and one of the others; a search that looks at the ends alone."""
    for n, axis in enumerate(data.get("axis", ())):
        many = 1 if n else 2
        if "range" in axis:
            axis["values"] = [axis.pop("range")["from"]]
        elif "values" in axis:
            axis["values"] = axis["values"][:many]
        else:
            axis["variants"] = dict(list(axis["variants"].items())[:many])
    if "transition" in data:
        data["transition"]["tolerance"] = "1 km/s"
    return {key: value for key, value in data.items() if key != "exclude"}


class InThisProcess:
    """What a sweep needs of a dask client: the case has run when it is submitted."""

    def submit(self, task, *arguments, key, pure):
        outcome = task(*arguments)
        future = SimpleNamespace(key=key, status="finished", result=lambda: outcome, release=lambda: None)
        future.add_done_callback = lambda tell: tell(future)
        return future

    def scheduler_info(self, n_workers):
        return {"workers": {"here": {}}}


@contextmanager
def in_this_process(workers, threads):
    yield InThisProcess()


@pytest.fixture(scope="module")
def made(problems):
    """Makes a run or a study that a page takes for granted, once."""

    def make(name: str, place: Path) -> None:
        kept = problems.parent / ("runs/shot" if name not in STUDIES else name)
        if not kept.exists():
            command = ["sweep", STUDIES[name]] if name in STUDIES else ["run", FILLED["DECK"]]
            assert call([*command, "--quiet", "--out", str(kept)]) == 0
        shutil.copytree(kept, place / name)

    return make


@pytest.fixture
def folder(problems, made, tmp_path, monkeypatch):
    """A reader's folder for a page."""
    monkeypatch.setattr(cluster, "local", in_this_process)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "problems").symlink_to(problems)

    def prepare(page: str) -> Path:
        for name in PRESUMED.get(page, ()):
            made(name, tmp_path)
        if page in TO_WRITE:
            text = next(text for _, kind, text in EXAMPLES[page] if kind == "toml")
            (tmp_path / TO_WRITE[page]).write_text(text)
        return tmp_path

    return prepare


def filled(command: str) -> str:
    for name, value in FILLED.items():
        command = re.sub(rf"\b{re.escape(name)}(?![\w.])", value, command)
    return command


def run(command: str) -> int:
    """Runs a command of a page and returns its exit status."""
    program, *words = shlex.split(filled(command))
    words = [path for word in words for path in (sorted(glob.glob(word)) if "*" in word else [word])]
    if program == "hydro2d":
        return call(words)
    assert program.startswith("python"), f"{program}: to be run here, or listed with a reason in NOT_RUN"
    assert words[0] == "-m"
    if words[1].startswith("problems."):
        return importlib.import_module(words[1]).main(words[2:])
    return subprocess.run([sys.executable, *words], stdout=subprocess.DEVNULL).returncode


@pytest.mark.parametrize("page", of_kind("command", "python"))
def test_examples_run(page, folder, capsys):
    folder(page)
    names = {"__name__": page}
    for line, kind, text in EXAMPLES[page]:
        if kind == "python":
            exec(compile(text, f"{page}:{line}", "exec"), names)
        elif kind == "command" and not is_listed(text):
            status = run(text)
            assert status == 0, f"{page}:{line}: {text}\n{capsys.readouterr().err}"


@pytest.mark.parametrize("page", of_kind("name"))
def test_names_of_commands_exist(page):
    for line, kind, text in EXAMPLES[page]:
        if kind == "name":
            command, module = NAME.fullmatch(text).groups()
            assert command in app if command else importlib.util.find_spec(module), f"{page}:{line}: {text}"


def test_what_is_not_run_is_in_the_pages():
    commands = {text for found in EXAMPLES.values() for _, kind, text in found if kind == "command"}
    assert [beginning for beginning in NOT_RUN if not any(text.startswith(beginning) for text in commands)] == []


@pytest.mark.parametrize("page", of_kind("toml"))
def test_decks_and_studies_of_the_text_are_valid(page, folder):
    """Beside the decks of the nose shapes; what is not whole is laid over another deck or search."""
    file = folder(page) / "problems" / "cth_nose_shape" / "example.toml"
    for line, text in [(line, text) for line, kind, text in EXAMPLES[page] if kind == "toml"]:
        data = tomllib.loads(text)
        if "transition" in data and "deck" not in data:
            text = toml.dumps(toml.merge(tomllib.loads(Path(SEARCH).read_text(encoding="utf-8")), data))
        elif not {"deck", "include", "mesh", "cores"} & set(data):
            text = f'include = "{BASES.get(page, Path(QUICK).name)}"\n{text}'
        file.write_text(text)
        if "cores" in data:
            assert cluster.read_slurm(file)
        elif toml.is_study(data):
            assert [case.message for case in cases.plan(file, quiet=True).cases if case.message] == [], f"{page}:{line}"
        else:
            assert decks.load(file).body, f"{page}:{line}"
