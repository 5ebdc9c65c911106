"""Rules that every file of the repository obeys, and the required contents of a wheel."""

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml

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
    """CITATION names the newest release of the change log, and the version is the next one in the making, or that release."""
    from hydro2d.base.version import __version__

    log = (source.ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    headings = re.findall(r"^## \[(.*?)\](?: - (\S+))?$", log, re.M)
    newest, day = next(heading for heading in headings if heading[1])
    citation = (source.ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {newest}\ndate-released: {day}\n" in citation
    if headings[0][0] == "Unreleased":
        numbers = [[int(part) for part in version.removesuffix(".dev0").split(".")] for version in (newest, __version__)]
        assert __version__.endswith(".dev0")
        assert numbers[0] < numbers[1]
    else:
        assert __version__ == newest


def test_a_release_is_made_from_the_name_of_its_tag(tmp_path):
    """The tagged commit has the version everywhere, the next one opens the next version; nothing else changes."""
    for name in ("hydro2d/base/version.py", "CHANGELOG.md", "CITATION.cff", "pyproject.toml"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source.ROOT / name, tmp_path / name)
    with open(tmp_path / "pyproject.toml", "a", encoding="utf-8") as file:
        file.write('\n[project.urls]\nRepository = "https://example.org/hydro2d"\n')

    def git(*words):
        return subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", *words], cwd=tmp_path, check=True,
                              capture_output=True, encoding="utf-8").stdout

    def release(tag):
        names = {f"GIT_{who}_{what}": "a" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
        return subprocess.run([sys.executable, source.ROOT / ".ci" / "release", tag], cwd=tmp_path, env=os.environ | names,
                              capture_output=True, encoding="utf-8")

    git("init", "-q")
    assert "v0.4.0" in release("0.4.0").stderr
    assert "the checkout has changes" in release("v9.8.7").stderr
    git("add", ".")
    git("commit", "-q", "-m", "before")
    assert release("v9.8.7").returncode == 0
    assert '"9.8.7"' in git("show", "v9.8.7:hydro2d/base/version.py")
    day = re.search(r"^## \[9\.8\.7\] - (\d{4}-\d\d-\d\d)$", git("show", "v9.8.7:CHANGELOG.md"), re.M)[1]
    assert "Unreleased" not in git("show", "v9.8.7:CHANGELOG.md")
    cited = git("show", "v9.8.7:CITATION.cff")
    address = re.escape('repository-code: "https://example.org/hydro2d"')
    assert re.search(rf"^version: 9\.8\.7\ndate-released: {day}\nlicense: .*\n{address}$", cited, re.M)
    assert '"9.9.0.dev0"' in (tmp_path / "hydro2d/base/version.py").read_text()
    assert "## [Unreleased]\n\n## [9.8.7]" in (tmp_path / "CHANGELOG.md").read_text()
    assert "exists" in release("v9.8.7").stderr


def test_workflows_run_what_there_is():
    """Each program of the repository that a step runs, and each deck; schemas of the forms are checked in .ci/run."""
    steps = [step["run"] for file in sorted((source.ROOT / ".github" / "workflows").glob("*.yml"))
             for job in yaml.safe_load(file.read_text(encoding="utf-8"))["jobs"].values()
             for step in job["steps"] if "run" in step]
    named = {word for step in steps for word in step.split() if word.startswith((".ci/", "problems/"))}
    assert named >= {".ci/run", "problems/verification/sod_z.toml"}
    assert [name for name in named if not (source.ROOT / name).is_file()] == []


def test_the_readme_is_one_screen_and_a_page():
    """Words before its first heading, which a reader sees at once, and after it."""
    first, rest = (source.ROOT / "README.md").read_text().split("\n## ", 1)
    assert len(first.split()) <= 300
    assert len(first.split()) + len(rest.split()) <= 800


def test_the_readme_commands_exist():
    """The deck of the first command exists, and the check script runs the second."""
    readme = (source.ROOT / "README.md").read_text()
    decks = re.findall(r"hydro2d run (problems/\S+\.toml)", readme)
    assert decks
    assert [deck for deck in decks if not (source.ROOT / Path(deck)).is_file()] == []
    assert "python -m pytest" in readme
    assert "python\" -m pytest" in (source.ROOT / ".ci" / "run").read_text()
