"""Modules and settings in the current directory are not run by any process that hydro2d starts."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import hydro2d
from hydro2d.base import children
from hydro2d.jit.compilation import Second
from hydro2d.study.run import cluster
from tests.materials.made_models import DECK, VOCE

#: further modules that someone might plant; those of `eos`, `strength` and `hydro2d` are determined here
FURTHER = ("numpy", "h5py", "numba", "pyvista", "yaml", "cyclopts", "distributed", "sitecustomize", "usercustomize")


@pytest.fixture
def planted(tmp_path, monkeypatch):
    """The current directory with a file for every module; the file that records which was run."""
    record = tmp_path / "told"
    folder = tmp_path / "planted"
    folder.mkdir()
    for name in (*sys.stdlib_module_names, *FURTHER):
        (folder / f"{name}.py").write_text(f"open({str(record)!r}, 'a').write('{name} ')\nraise SystemExit('planted')\n")
    monkeypatch.chdir(folder)
    return record


def found(record: Path) -> str:
    return record.read_text() if record.exists() else ""


def test_a_planted_module_is_run_by_python(planted):
    """The other tests rely on this."""
    done = subprocess.run([sys.executable, "-c", "import json"], capture_output=True, check=False)
    assert done.returncode != 0
    assert "json " in found(planted)


@pytest.mark.parametrize("start", [[sys.executable, "-m", "hydro2d"], [str(Path(sys.executable).with_name("hydro2d"))]])
def test_the_command(planted, start):
    """With -m, Python itself looks for the modules that it needs to find hydro2d, before hydro2d can prevent it."""
    if "-m" in start:
        loaded = subprocess.run([sys.executable, "-P", "-c", "import runpy, sys; print(*sys.modules)"], capture_output=True,
                                text=True, check=True, cwd="/").stdout.split()
        for name in {name.partition(".")[0] for name in loaded}:
            Path(f"{name}.py").unlink(missing_ok=True)
    done = subprocess.run([*start, "info", "pressure"], capture_output=True, text=True, check=False)
    assert (done.returncode, found(planted)) == (0, ""), done.stderr
    assert "pressure (field)" in done.stdout


def test_the_second_compiler(planted, monkeypatch):
    class NoDeck:
        def to_toml(self) -> str:
            return "["

    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1}, raising=False)
    second = Second(NoDeck())
    second.start(print)
    assert second._process.wait(timeout=60) == 1  # it got as far as the deck, which is wrong
    assert found(planted) == ""


def test_the_process_that_renders(planted):
    done = subprocess.run(children.python("hydro2d.results.cutaway"), input="{}", capture_output=True, text=True, check=False)
    assert "_render() missing" in done.stderr
    assert found(planted) == ""


def test_workers(planted):
    before = os.environ.get(children.SAFE)
    with cluster.local(1, 1) as client:
        flags = client.run(lambda: (sys.flags.safe_path, os.environ[children.SAFE]))
    assert list(flags.values()) == [(True, "1")]
    assert found(planted) == ""
    assert os.environ.get(children.SAFE) == before


def test_workers_of_slurm_get_the_setting():
    assert f"export {children.SAFE}=1" in cluster.Slurm(cores=1, memory="1 GB").arguments(1)["job_script_prologue"]


def test_model_files_next_to_a_deck_are_found_from_elsewhere(planted, tmp_path):
    """Files named in a deck are run, relative to the deck."""
    (tmp_path / "shot").mkdir()
    (tmp_path / "shot" / "my_model.py").write_text(VOCE)
    (tmp_path / "shot" / "shot.toml").write_text(DECK)
    command = [str(Path(sys.executable).with_name("hydro2d")), "check", str(tmp_path / "shot" / "shot.toml")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, found(planted)) == (0, ""), done.stderr
    assert "strength own-voce" in done.stdout


def test_settings_of_matplotlib_in_the_current_directory_name_no_program(tmp_path):
    root = Path(hydro2d.__file__).parent.parent
    (tmp_path / "matplotlibrc").write_text("animation.ffmpeg_path: ./evil\nbackend: module://evil\ntext.usetex: True\n")
    script = (
        "from hydro2d.cli.base import import_matplotlib\n"
        "import_matplotlib()\n"
        "import os, matplotlib\n"
        "print(matplotlib.rcParams['animation.ffmpeg_path'], matplotlib.rcParams['text.usetex'], os.getcwd())\n"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, check=True,
                          env={**os.environ, "PYTHONPATH": str(root), "MPLBACKEND": "agg"})
    assert done.stdout.split() == ["ffmpeg", "False", str(tmp_path.resolve())]


@pytest.mark.parametrize("command", ["plot", "movie", "report", "curve", "check"])
def test_every_command_that_draws_imports_it_so(command, tmp_path, monkeypatch):
    from hydro2d.cli import curve, main, pictures, report

    class Asked(Exception):
        pass

    def ask() -> None:
        raise Asked

    for module in (main, pictures, curve, report):
        monkeypatch.setattr(module, "import_matplotlib", ask)
    picture = str(tmp_path / "a.png")
    words = {"plot": ["-o", picture], "movie": ["-o", picture], "report": [], "curve": ["--figure", picture],
             "check": ["--picture", picture]}[command]
    what = {"curve": "Al5083", "check": "problems/perforation/sphere.toml"}.get(command, str(tmp_path))
    with pytest.raises(Asked):
        main.call([command, what, *words])
