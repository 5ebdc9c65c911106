"""Rules that every file of the repository obeys, and the required contents of a wheel."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from tests.rules import source

HERE = source.ROOT.parent
TEXT = {".py", ".md", ".toml", ".cff", ".txt", ".rst", ".cfg", ".css", ".yml", ".yaml", ".ipynb", ""}
#: in pieces, so that this file does not break its own rule
MACHINE = re.compile(r"(?<![\w.~-])/(?:" + "|".join(["home", "root", "Users", "work", "mnt", "tmp"]) + r")/")
INDEX = re.compile("|".join(["py" + r"pi\.org", "python" + "hosted", "index" + "-url", r"://[^/\s]*:[^/\s]*@"]))


def faults(text: str) -> list[str]:
    """Machine paths and package index hosts in a text, with their lines."""
    wrong = []
    for number, line in enumerate(text.splitlines(), 1):
        for pattern, name in ((MACHINE, "a path of one machine"), (INDEX, "a package index")):
            if pattern.search(line):
                wrong.append(f"line {number}: {name}: {line.strip()[:100]}")
        if len(HERE.parts) > 1 and re.search(r"(?<![\w.~-])" + re.escape(f"{HERE}/"), line):
            wrong.append(f"line {number}: this checkout's folder")
    return wrong


TEXT_FILES = [file for file in source.tracked_files() if file.suffix in TEXT]


@pytest.mark.parametrize("file", TEXT_FILES, ids=lambda file: str(file.relative_to(source.ROOT)))
def test_no_machine_paths_or_index_hosts(file):
    assert faults(file.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    "line", ["/".join(["see ", "home", "me", "x"]), "/".join(["", "work", "main"]), "--extra-index" + "-url x"]
)
def test_a_machine_path_is_found(line):
    assert faults(line) != []


@pytest.mark.parametrize("file", TEXT_FILES, ids=lambda file: str(file.relative_to(source.ROOT)))
def test_decks_that_are_named_exist(file):
    named = set(re.findall(r"\bproblems/[\w./-]+\.toml\b", file.read_text(encoding="utf-8")))
    assert [deck for deck in sorted(named) if not (source.ROOT / deck).is_file()] == []


def project() -> dict:
    return tomllib.loads((source.ROOT / "pyproject.toml").read_text())


def built(target: str) -> dict:
    """The message of building the wheel or the sdist."""
    return project()["tool"]["hatch"]["build"]["targets"][target]


def test_the_wheel_carries_every_package_and_every_file_of_problems_but_programs():
    wheel = built("wheel")
    assert set(wheel["only-include"]) == {*source.PACKAGES, "problems"}
    assert wheel["sources"] == {"problems": "hydro2d/problems"}
    assert wheel["exclude"] == ["/problems/**/*.py"]


def test_the_sdist_carries_every_folder_that_the_wheel_and_the_tests_need():
    assert set(built("sdist")["only-include"]) >= {*source.PACKAGES, "problems", "tests", "docs"}


def test_no_file_that_is_tracked_is_ignored():
    """The wheel and the sdist leave out all files that .gitignore names."""
    names = "\n".join(str(file.relative_to(source.ROOT)) for file in source.tracked_files())
    done = subprocess.run(["git", "check-ignore", "--no-index", "--stdin"], cwd=source.ROOT, input=names, text=True,
                          capture_output=True, check=False)
    assert (done.returncode, done.stdout) == (1, "")


def test_the_installed_problems_are_the_shipped_ones():
    from importlib import import_module

    assert Path(next(iter(import_module("hydro2d.problems").__path__))) == source.PROBLEMS


EXTRAS = project()["project"]["optional-dependencies"]


def test_every_dependency_says_what_it_is_for():
    text = (source.ROOT / "pyproject.toml").read_text()
    lines = text[text.index("\ndependencies = ["): text.index("[project.optional-dependencies]")].splitlines()
    entries = [line for line in lines if line.startswith('    "')]
    assert len(entries) == len(project()["project"]["dependencies"])
    assert [line for line in entries if not re.search(r",\s+# \w", line)] == []


def test_messages_and_pages_name_extras_that_there_are():
    files = [file for file in TEXT_FILES if file.suffix in (".py", ".md") and "tests" not in file.parts]
    text = "\n".join(file.read_text(encoding="utf-8") for file in files)
    named = {*re.findall(r'from_extra\("(\w+)"', text), *re.findall(r"'hydro2d\[(\w+)\]'", text)}
    assert named >= {"report", "data", "slurm", "movie"}
    assert named - set(EXTRAS) == set()


def test_versions_agree():
    from hydro2d.base.version import __version__

    assert project()["project"]["version"] == __version__
    assert f"\nversion: {__version__}\n" in (source.ROOT / "CITATION.cff").read_text()
    assert f"## [{__version__}]" in (source.ROOT / "CHANGELOG.md").read_text()


def test_the_readme_is_one_screen_and_a_page():
    """Words before its first heading, which a reader sees at once, and after it."""
    first, rest = (source.ROOT / "README.md").read_text().split("\n## ", 1)
    assert len(first.split()) <= 300
    assert len(rest.split()) <= 600


def test_the_readme_commands_exist():
    """The deck of the first command exists, and the check script runs the second."""
    readme = (source.ROOT / "README.md").read_text()
    decks = re.findall(r"hydro2d run (problems/\S+\.toml)", readme)
    assert decks
    assert [deck for deck in decks if not (source.ROOT / Path(deck)).is_file()] == []
    assert "python -m pytest" in readme
    assert "python\" -m pytest" in (source.ROOT / ".ci" / "run").read_text()
