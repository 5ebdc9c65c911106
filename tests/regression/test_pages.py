"""The Python of pages is run: the commands before it make its runs, of a few cycles each."""

import contextlib
import shlex

import matplotlib
import pytest

import hydro2d
from hydro2d.cli.main import call
from tests.rules import source

DOCS = source.ROOT / "docs"
CYCLES = 30
#: commands that make the files which the Python of a page reads
MAKERS = ("new", "run", "sweep")
OTHER_USES = {"--check", "--status", "--resume", "--list", "--repeats"}
#: pages whose Python is run elsewhere, and where
ELSEWHERE = {"how-to/add-a-model": "tests/regression/test_add_a_model.py follows it word for word",
             "how-to/easyvvuq": "tests/regression/test_easyvvuq.py, in an environment of its own"}
#: pages with studies of several cases, whose workers have to start
LONG = ("how-to/depth-curves", "how-to/run-a-study", "how-to/uncertain-inputs", "tutorials/first-study")


def pages():
    """Pages with Python, by their place in the docs."""
    files = [file for part in ("how-to", "tutorials") for file in (DOCS / part).glob("*.md")]
    names = [str(file.relative_to(DOCS).with_suffix("")) for file in files if "```python" in file.read_text(encoding="utf-8")]
    return [pytest.param(name, marks=[pytest.mark.slow] * (name in LONG)) for name in sorted(names) if name not in ELSEWHERE]


@pytest.fixture
def figures(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    import figures

    return figures


@pytest.fixture
def short(monkeypatch):
    """Decks read by Python end after a few cycles."""
    read = hydro2d.Deck.from_file

    def from_file(path, overrides=None):
        return read(path, {**(overrides or {}), "stop.cycles": CYCLES})

    monkeypatch.setattr(hydro2d.Deck, "from_file", staticmethod(from_file))


@pytest.mark.thorough
@pytest.mark.parametrize("name", pages())
def test_the_python_of_a_page_runs(name, figures, short, tmp_path, capsys):
    text, names = (DOCS / f"{name}.md").read_text(encoding="utf-8"), {"__name__": "page"}
    (tmp_path / "problems").symlink_to(source.PROBLEMS)
    for file, _, block in figures.blocks(text):
        if file is not None:
            (tmp_path / file).write_text(block, encoding="utf-8")
    made, ran = set(), 0
    with contextlib.chdir(tmp_path), matplotlib.rc_context({"backend": "agg"}):
        for kind, step in figures.steps(text):
            if kind == "python":
                exec(step, names)  # as a reader would type it
                ran += 1
                continue
            _, command, *arguments = shlex.split(step)
            if command not in MAKERS or step in made or OTHER_USES & {*arguments}:
                continue
            made.add(step)
            cut = [] if command == "new" else ["--set", f"stop.cycles={CYCLES}", "--quiet"]
            assert call([command, *arguments, *cut]) == 0, capsys.readouterr().err
    assert ran
