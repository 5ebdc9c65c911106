"""The command line: one message and status 2 for a user's mistake; no traceback."""

import functools
import json
import operator
import os
import re
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import pytest

from hydro2d.cli.main import app, call
from hydro2d.output import snapshot, vtk
from tests import fake

DECK = """
[mesh]
r = [{to = "12 mm", cells = 12}]
z_start = "-25 mm"
z = [{to = "30 mm", size = "1 mm"}]
[[body]]
name = "rod"
material = "W_alloy"
shape = "rod"
nose = "hemispherical"
radius = "4 mm"
length = "20 mm"
tip = 0.0
velocity = "1000 m/s"
[[body]]
name = "plate"
material = "Al5083"
shape = "plate"
z_front = 0.0
thickness = "40 mm"
[[tracer]]
name = "nose"
r = 0.0
z = 0.0
[[tracer]]
name = "deep"
r = "1 mm"
z = "5 mm"
[stop]
time = "20 us"
[experiment]
penetration = "12.1 mm"
source = "a laboratory"
"""


@pytest.fixture
def deck(tmp_path):
    file = tmp_path / "shot.toml"
    file.write_text(DECK)
    return str(file)


def test_run_plot_export(simulation, deck, tmp_path, capsys):
    out = tmp_path / "out"
    assert call(["run", deck, "--out", str(out)]) == 0
    assert "penetration depth" in capsys.readouterr().out
    assert call(["run", deck, "--out", str(out)]) == 2
    assert "--overwrite" in capsys.readouterr().err
    picture = tmp_path / "x.png"
    assert call(["plot", str(out), "-o", str(picture), "--field", "density", "--time", "10 us", "--time", "20 us"]) == 0
    assert call(["plot", str(out), "-o", str(picture), "--window", "-2 cm,2 cm,5 mm"]) == 0
    assert call(["plot", str(out), "-o", str(picture), "--kind", "history", "--quantity", "rod_length_m"]) == 0
    assert call(["export", str(out), "-o", str(tmp_path / "e"), "--fields", "pressure", "velocity"]) == 0
    (_, file), *_ = vtk.read_series(tmp_path / "e" / "series.pvd")
    assert set(vtk.read_grid(tmp_path / "e" / file).fields) == {
        "Pressure [Pa]", "Velocity [m/s]", "Material",
        *(f"{what} for {body}{unit}" for body in ("rod", "plate")
          for what, unit in (("Volume Fraction", ""), ("Centroid Offset r", " [m]"), ("Centroid Offset z", " [m]"))),
    }
    assert (tmp_path / "e" / "history.csv").read_text().startswith("time [s],")
    assert call(["export", str(out)]) == 0
    assert (out / "export" / "interfaces.pvd").exists()


def test_kernels_are_compiled_before_they_are_needed(simulation, deck, monkeypatch, capsys):
    """The runs that compile leave nothing behind; without a deck, shipped ones are run."""
    from hydro2d.running import compile_all

    monkeypatch.chdir(Path(deck).parent)
    before = set(Path().iterdir())
    assert call(["compile", deck]) == 0
    first, kept = capsys.readouterr().out.splitlines()
    assert first == "shot.toml: was compiled already"  # a fake simulation has no kernels
    assert kept.startswith("compiled for ")
    assert set(Path().iterdir()) == before
    assert call(["compile", "none.toml", deck]) == 2
    assert capsys.readouterr().out == ""
    files = []
    monkeypatch.setattr(compile_all, "compile_decks", files.extend)
    assert call(["compile"]) == 0
    assert files == compile_all.shipped_decks()
    assert all(file.is_file() for file in files)


def test_native_kernels_take_the_place_of_those_of_the_package(simulation, deck, monkeypatch, capsys):
    from hydro2d.jit import shipped

    monkeypatch.setenv("HYDRO2D_TARGET", "")
    asked = []
    monkeypatch.setattr(shipped, "prefer_native", lambda: asked.append(os.environ["HYDRO2D_TARGET"]))
    assert call(["compile", deck]) == 0
    assert asked == []
    assert call(["compile", "--native", deck]) == 0
    assert asked == ["native"]
    monkeypatch.setattr(shipped, "IN_USE", True)  # too late: this process has begun with other code
    assert call(["compile", "--native", deck]) == 2
    assert "--native" in capsys.readouterr().err
    assert len(asked) == 1


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["[1]", '["a", "b"]', '{"a": 1}', "null"])
def test_a_directory_may_have_a_name_that_json_would_read(simulation, deck, tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    for command in (["run", deck, "--out", name, "--quiet"], ["status", name], ["plot", name, name, "-o", "a.png"],
                    ["export", name, "-o", f"{name} once more"], ["report", name, "-o", f"{name} as a page"]):
        assert call(command) == 0, command
    assert {file.name for file in tmp_path.iterdir() if file.is_dir()} == {name, f"{name} once more", f"{name} as a page"}


def test_export_without_dumps_takes_the_restart_file(simulation, deck, tmp_path):
    out = tmp_path / "out"
    call(["run", deck, "--out", str(out), "--quiet"])
    for file in ("series.pvd", "interfaces.pvd", "tracers.pvd"):
        (out / file).unlink()
    assert call(["export", str(out)]) == 0
    ((when, file),) = vtk.read_series(out / "export" / "series.pvd")
    assert "Pressure of rod [Pa]" in vtk.read_grid(out / "export" / file).fields
    assert when == snapshot.read(out / "restart.h5").scalars["time"]


def test_restart_after_an_interruption(simulation, deck, tmp_path):
    out = str(tmp_path / "out")
    assert call(["run", deck, "--out", out, "--set", "stop.cycles=50", "--quiet"]) == 0
    assert call(["run", deck, "--out", out, "--restart", "--quiet"]) == 0
    assert json.loads(Path(out, "summary.json").read_text())["time_s"] >= fake.STOP


def test_a_quiet_run_says_in_one_line_that_it_ended_unphysical(simulation, deck, tmp_path, capsys):
    simulation.fail_at = 7
    out = tmp_path / "out"
    assert call(["run", str(deck), "--out", str(out), "--quiet"]) == 3
    printed = capsys.readouterr()
    reason = json.loads((out / "summary.json").read_text())["stop_reason"]
    assert (printed.out, printed.err) == ("", f"hydro2d: {out}: unphysical: {reason}\n")
    assert "unphysical" not in reason  # the word comes before it
    simulation.fail_at = None
    assert call(["run", str(deck), "--out", str(out), "--quiet", "--overwrite"]) == 0
    assert capsys.readouterr() == ("", "")


def test_unphysical_is_status_3(simulation, deck, tmp_path, capsys):
    simulation.fail_at = 7
    assert call(["run", deck, "--out", str(tmp_path / "out")]) == 3
    assert "density -1 kg/m3" in capsys.readouterr().out


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["rnu"], 'Did you mean "run"'),
        (["run"], "requires an argument"),
        (["run", "none.toml"], "no such file"),
        (["run", "{deck}", "--thread", "2"], "--threads"),
        (["run", "{deck}", "--threads", "0"], "a whole number from 1 to 1024"),
        (["run", "{deck}", "--threads", "2.5"], "a whole number from 1 to 1024"),
        (["run", "{deck}", "--threads", "100000"], "a whole number from 1 to 1024"),
        (["run", "{deck}", "--set", "numerics.corant=0.5"], 'did you mean "courant"'),
        (["run", "{deck}", "--set", "stop.time=5 mm"], "time"),
        (["run", "{deck}", "--set", 'output.fields=["presure"]'], 'did you mean "pressure"'),
        (["run", "{deck}", "--restart", "--overwrite"], "one of them"),
        (["run", "{deck}", "--out", "{deck}"], "is a file"),
        (["run", "{deck}", "--out", "{tmp}/none", "--restart"], "no run to continue"),
        (["plot", "{tmp}", "-o", "x.png"], "not a run directory"),
        (["plot", "{tmp}/out", "-o", "x.png", "--time", "5 mm"], "--time"),
        (["plot", "{tmp}/out", "-o", "x.png", "--window", "1,2"], "three lengths"),
        (["plot", "{tmp}/out", "-o", "x.xyz"], "picture format"),
        (["plot", "{tmp}/out", "-o", "x.png", "--kind", "sideways"], "--kind"),
        (["export", "{tmp}/out", "--fields", "presure"], 'did you mean "pressure"'),
        (["info", "presure"], 'did you mean "pressure"'),
    ],
)
def test_one_clear_message_and_status_2(simulation, deck, tmp_path, capsys, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    if "{tmp}/out" in arguments:
        call(["run", deck, "--out", str(tmp_path / "out"), "--quiet"])
    capsys.readouterr()
    assert call([word.format(deck=deck, tmp=tmp_path) for word in arguments]) == 2
    message = capsys.readouterr().err
    assert said in message
    assert "Traceback" not in message


def test_a_damaged_restart_file_is_one_message(simulation, deck, tmp_path, capsys):
    out = tmp_path / "out"
    call(["run", deck, "--out", str(out), "--quiet"])
    os.truncate(out / "restart.h5", 3000)
    assert call(["run", deck, "--out", str(out), "--restart", "--quiet"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_a_damaged_summary_is_one_message(simulation, deck, tmp_path, capsys):
    out = tmp_path / "out"
    call(["run", deck, "--out", str(out), "--quiet"])
    (out / "summary.json").write_text('{"status": "do')
    assert call(["plot", str(out), "-o", str(tmp_path / "x.png")]) == 2
    assert "summary.json cannot be read" in capsys.readouterr().err


def test_check(deck, tmp_path, capsys):
    assert call(["check", deck, "--picture", str(tmp_path / "start.png"), "--threads", "2"]) == 0
    shown = capsys.readouterr().out
    assert "12 x 55 = 660 cells" in shown
    assert "4 cells across the radius of 4 mm" in shown
    assert "warning" in shown  # under five cells
    volume = 3.141592653589793 * (4e-3**2 * 16e-3 + 2 / 3 * 4e-3**3)
    assert f"{volume * 18160 * 1e3:.5g}" in shown
    assert (tmp_path / "start.png").stat().st_size > 5000


def test_info(capsys):
    for name in ("W_alloy", "johnson-cook", "pressure", "numerics.courant", "radius", "mesh.r"):
        assert call(["info", name]) == 0
    assert call(["info"]) == 0
    shown = capsys.readouterr().out
    assert "numerics.courant (deck key)" in shown
    assert '"Pressure [Pa]"' in shown


def test_schema(capsys):
    assert call(["schema"]) == 0
    assert "numerics" in json.loads(capsys.readouterr().out)["properties"]


def test_every_command_has_an_example():
    for name in ("run", "check", "info", "plot", "export", "bench", "schema", "sweep"):
        assert f"Example: hydro2d {name}" in app[name].help


@pytest.mark.parametrize("command", ["run", "plot", "movie", "view", "export", "report", "sweep", "transition"])
def test_the_output_option_has_one_name(command, capsys):
    assert call([command, "--help"]) == 0
    said = capsys.readouterr().out
    assert "--out" in said
    assert "-o" in said.replace("--out", "")
    assert call([command, "somewhere", "--output", "x.png"]) == 2
    assert capsys.readouterr().err == "hydro2d: --output is now --out in every command, or -o for short\n"


def commands():
    return [*(name for name in app if not name.startswith("-")), "model transition"]


@pytest.mark.parametrize("command", commands())
def test_help_breaks_lines_at_the_width_of_the_terminal_and_negates_no_option_in_vain(command, capsys, monkeypatch):
    """A paragraph, and what explains an option, is one line of the text that is wrapped."""
    first, _, options = functools.reduce(operator.getitem, command.split(), app).help.partition("\nParameters\n")
    assert not re.search(r"\S\n\S", first)
    assert not re.search(r"^ .*\n ", options, re.M)
    for width in (80, 120):
        monkeypatch.setenv("COLUMNS", str(width))
        assert call([*command.split(), "--help"]) == 0
        shown = capsys.readouterr().out
        assert max(map(len, shown.splitlines())) <= width
        assert set(re.findall(r"--(?:no|empty)-\w+", shown)) <= {"--no-open", "--no-plot", "--no-watch"}


def test_help_is_light():
    """Printing the commands imports nothing heavy."""
    code = """
        import sys
        from hydro2d.cli.main import call
        call(["--help"]); call(["run", "--help"])
        heavy = {"numpy", "numba", "h5py", "pint", "pyvista", "vtkmodules", "matplotlib", "scipy"} & set(sys.modules)
        assert not heavy, heavy
    """
    subprocess.run([sys.executable, "-c", textwrap.dedent(code)], check=True, capture_output=True)


@pytest.mark.thorough
@pytest.mark.parametrize(("number", "status"), [(signal.SIGTERM, 143), (signal.SIGINT, 130), (signal.SIGHUP, 129)])
def test_signals_write_a_restart_file(deck, tmp_path, number, status):
    code = """
        import sys, time, types
        from tests import fake
        class Slow(fake.Simulation):
            def step(self):
                time.sleep(0.02)
                super().step()
        sys.modules["hydro2d.solver.simulation"] = types.SimpleNamespace(
            Simulation=Slow, UnphysicalState=fake.UnphysicalState)
        from hydro2d.cli.main import main
        main(sys.argv[1:])
    """
    out = tmp_path / "out"
    root = Path(__file__).parents[2]
    child = subprocess.Popen([sys.executable, "-c", textwrap.dedent(code), "run", deck, "--out", str(out)], cwd=root,
                             stdout=subprocess.DEVNULL,
                             preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL))
    until = time.monotonic() + 60
    while not (out / "vtk" / "dump_000001.vtr").exists() and time.monotonic() < until:
        time.sleep(0.05)
    child.send_signal(number)
    assert child.wait(60) == status
    summary = json.loads((out / "summary.json").read_text())
    assert summary["status"] == "interrupted"
    assert signal.Signals(number).name in summary["stop_reason"]
    assert snapshot.read(out / "restart.h5").scalars["cycle"] == summary["cycles"]


def test_kill_leaves_whole_files(deck, tmp_path):
    """kill -9 in the middle of constant writing: all files that exist can be read."""
    code = """
        import sys, types
        from tests import fake
        sys.modules["hydro2d.solver.simulation"] = types.SimpleNamespace(
            Simulation=fake.Simulation, UnphysicalState=fake.UnphysicalState)
        from hydro2d.cli.main import main
        main(sys.argv[1:])
    """
    out = tmp_path / "out"
    root = Path(__file__).parents[2]
    options = ["--set", "output.restart_interval=1 ns", "--set", "output.vtk_interval=100 ns", "--set", "stop.time=1 ms"]
    child = subprocess.Popen([sys.executable, "-c", textwrap.dedent(code), "run", deck, "--out", str(out), *options],
                             cwd=root, stdout=subprocess.DEVNULL)
    until = time.monotonic() + 60
    while not (out / "restart.previous.h5").exists() and time.monotonic() < until:
        time.sleep(0.05)
    time.sleep(0.3)
    child.kill()
    child.wait(60)
    snapshot.read_latest(out)
    for _, file in vtk.read_series(out / "series.pvd"):
        vtk.read_grid(out / file)


@pytest.mark.parametrize("command", [["run", "DECK", "--out"], ["export", "RUN", "--out"], ["report", "RUN", "--out"]])
def test_a_directory_below_a_file_is_one_line(deck, finished, tmp_path, capsys, command):
    file = tmp_path / "file"
    file.write_text("")
    words = [{"DECK": deck, "RUN": str(finished)}.get(word, word) for word in command]
    assert call([*words, str(file / "below")]) == 2
    assert f"{file} is a file, not a directory" in capsys.readouterr().err


@pytest.mark.parametrize(("arguments", "said"), [
    (["info", "W_aloy"], "W_alloy"), (["run", "none.toml"], "there is no such file"), (["sweep", "none.toml"], "none.toml"),
    (["plot", "nowhere", "-o", "x.png"], "is not a run directory"), (["model", "tat"], 'did you mean "tate"?'),
])
def test_errors_of_users_are_one_message(arguments, said, capsys):
    assert call(arguments) == 2
    message = capsys.readouterr().err
    assert said in message
    assert message.startswith("hydro2d: ")


def test_the_options_of_workers_are_the_same_in_all_commands_that_run_many_cases():
    """They are options of the command itself, in one order and with the same words."""
    shown = [
        [(entry.names[0], entry.parameter.help, entry.field_info.default) for entry in arguments
         if entry.names[0][2:] in ("workers", "threads", "scheduler", "slurm", "resume", "overwrite")]
        for arguments in (app[name].assemble_argument_collection(parse_docstring=True)
                          for name in ("sweep", "transition", "converge"))
    ]
    assert shown[0] == shown[1] == shown[2]
    assert [name for name, _, _ in shown[0]] == ["--workers", "--threads", "--scheduler", "--slurm", "--resume", "--overwrite"]
    assert all(words for _, words, _ in shown[0])


@pytest.mark.parametrize("command", ["sweep", "transition", "converge"])
def test_ways_to_get_workers_that_exclude_each_other(command, capsys):
    cells = ["--cells", "4,6"] if command == "converge" else []
    for more, said in ((["--slurm", "job.toml"], "--scheduler joins workers and --slurm starts them"),
                       (["--workers", "2"], "--workers starts workers and --scheduler joins running ones")):
        assert call([command, "file.toml", *cells, "--scheduler", "tcp://host:1", *more]) == 2
        assert said in capsys.readouterr().err
    assert call([command, "file.toml", *cells, "--workers", "none"]) == 2
    assert capsys.readouterr().err == "hydro2d: --workers none: must be a whole number from 1 to 1024\n"
