"""A study directory is read back as it was written, at any stage of completion."""

import io
from dataclasses import replace
from pathlib import Path

import pytest
import rich.console

import hydro2d
from hydro2d.base.method_version import METHOD
from hydro2d.cli.main import call
from hydro2d.files.whole import write_json
from hydro2d.measure.summary import Summary
from hydro2d.study.plan import cases
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.velocities import Velocities
from hydro2d.study.records import study_directory
from hydro2d.study.run import monitor, sweep
from tests.locks import held
from tests.study import tubes


@pytest.fixture
def plan(tmp_path):
    return cases.plan(tubes.write(tmp_path, tubes.STUDY.replace("0.2]", "0.2, '2 mm']")))


@pytest.fixture
def written(plan, tmp_path):
    study_directory.make(tmp_path / "out")
    study_directory.write(plan, tmp_path / "out")
    return tmp_path / "out"


def state(directory, name):
    return next(case for case in hydro2d.open_study(directory).cases if case.name == name)


def pretend(directory, plan, name, status, **extra):
    """The files that the run of a case leaves behind."""
    place = directory / "cases" / name
    place.mkdir(exist_ok=True)
    planned = next(case for case in plan.cases if case.name == name)
    (place / "deck.toml").write_text(planned.text)
    if status is not None:
        write_json(place / "summary.json", {
            "status": status, "stop_reason": "a reason", "deck_sha256": planned.sha256, "method": METHOD, "wall_s": 100.0,
            "penetration_depth_m": 0.123} | extra)
    return place


def test_round_trip(plan, written):
    study = hydro2d.open_study(written)
    assert (study.title, study.name, study.directory) == ("Shock tubes", "tubes", written)
    assert [(axis.name, axis.key, axis.values) for axis in study.axes] == [
        ("advection", "numerics.advection", ("ke", "momentum")),
        ("pressure", "body.low.pressure", ("0.1", "0.2", "2 mm")),
    ]
    assert [case.name for case in study.cases] == [case.name for case in plan.cases]
    first = study.cases[0]
    assert first.values == {"advection": "ke", "pressure": "0.1"}
    assert first.directory == written / "cases" / "ke_0.1"
    assert (first.base, first.status, first.summary, first.deck) == ("tube.toml", "waiting", Summary(), None)
    assert first.deck_sha256 == plan.cases[0].sha256
    assert "ke_2mm" == study.cases[2].name
    assert study.cases[2].status == "invalid"
    assert "body[1].pressure" in study.cases[2].message
    assert (written / "study.toml").read_text() == plan.text


def test_every_status(plan, written):
    place = pretend(written, plan, "ke_0.1", "done")
    assert state(written, "ke_0.1").status == "done"
    assert state(written, "ke_0.1").deck["numerics"]["advection"] == "ke"
    write_json(place / "progress.json", {"fraction": 0.25, "left_s": 60.0, "host": "here", "process": 7})
    with held(place / "run.lock"):
        assert state(written, "ke_0.1").status == "running"
        assert monitor.row(state(written, "ke_0.1"))[3:] == ("25 %", "1 min 00 s", "here:7")
    pretend(written, plan, "ke_0.1", "unphysical")
    assert state(written, "ke_0.1").message == "a reason"
    pretend(written, plan, "ke_0.1", "interrupted")
    assert state(written, "ke_0.1").status == "interrupted"
    write_json(place / "failed.json", {"reason": "the disk is full", "kind": "OSError", "host": "here", "time": ""})
    assert (state(written, "ke_0.1").status, state(written, "ke_0.1").message) == ("failed", "the disk is full")
    place = pretend(written, plan, "ke_0.2", None)
    assert state(written, "ke_0.2").status == "waiting"
    (place / "restart.h5").touch()
    assert state(written, "ke_0.2").status == "interrupted"  # it was killed
    pretend(written, plan, "momentum_0.1", "done")
    (written / "cases" / "momentum_0.1" / "deck.toml").write_text("title = 'another'")
    assert state(written, "momentum_0.1").status == "waiting"
    (written / "cases" / "momentum_0.2").touch()
    assert "is a file" in state(written, "momentum_0.2").message


def test_status_command(plan, written, tmp_path, capsys):
    pretend(written, plan, "ke_0.1", "done")
    assert call(["sweep", str(written), "--status"]) == 0
    shown = capsys.readouterr().out
    assert "ke_0.1        done     12.30 cm  100 %" in shown
    assert "1 of 6 done, 3 waiting, 2 invalid" in shown
    assert call(["sweep", str(tmp_path / "tubes.toml"), "--out", str(written), "--status"]) == 0
    assert call(["sweep", str(tmp_path), "--status"]) == 2
    assert "not a study directory" in capsys.readouterr().err
    (written / "study.json").write_text("{")
    assert call(["sweep", str(written), "--status"]) == 2


def test_time_left():
    def case(status, **told):
        return study_directory.Case("a", Path("a"), status=status, **told)

    done, waiting = case("done", summary=Summary(wall_s=100.0)), case("waiting")
    running = case("running", progress={"left_s": 40.0, "wall_s": 60.0})
    assert monitor.left([done, waiting, waiting, running], 2) == 120.0
    assert monitor.left([running, waiting], 1) == 140.0
    assert monitor.left([waiting], 1) is None
    assert monitor.left([done, waiting, running], 1, further=2) == 340.0


def test_an_existing_study_is_kept_without_overwrite(plan, written, tmp_path):
    sweep.changes(plan, written, resume=False, overwrite=False)  # no case has begun
    pretend(written, plan, "ke_0.1", "done")
    with pytest.raises(StudyError, match=r"1 of 6 done.*--resume continues it"):
        sweep.changes(plan, written, resume=False, overwrite=False)
    assert sweep.changes(plan, written, resume=True, overwrite=False) == []
    with pytest.raises(StudyError, match="no study to continue"):
        sweep.changes(plan, tmp_path / "none", resume=True, overwrite=False)
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "summary.json").write_text("{}")
    with pytest.raises(StudyError, match="holds a run; give the study a directory of its own"):
        sweep.changes(plan, tmp_path / "run", resume=False, overwrite=True)
    with pytest.raises(StudyError, match="is a file"):
        sweep.changes(plan, tmp_path / "tube.toml", resume=False, overwrite=False)
    with pytest.raises(NotADirectoryError):
        study_directory.make(tmp_path / "tube.toml" / "out")


def test_a_changed_study_is_reported(plan, written, tmp_path):
    pretend(written, plan, "ke_0.1", "done")
    wider = cases.plan(tubes.write(tmp_path, tubes.STUDY.replace("[0.1, 0.2]", "[0.1, 0.3]")))
    changes = sweep.changes(wider, written, resume=True, overwrite=False)
    assert changes == [
        "2 cases (ke_0.3, momentum_0.3) new",
        "4 cases (ke_0.2, ke_2mm, momentum_0.2, momentum_2mm) no longer in the study; the files in cases are kept",
    ]
    search = Velocities("body.rod.velocity", ("100 m/s",), 1.0)  # it may draw unfinished velocities again
    assert sweep.changes(replace(wider, search=search), written, resume=True, overwrite=False) == changes[:1]
    study_directory.write(wider, written)
    other = cases.plan(tubes.write(tmp_path), ["numerics.courant=0.3"])
    with pytest.raises(StudyError, match=r"1 case \(ke_0.1\) had a different deck.*--overwrite"):
        sweep.changes(other, written, resume=True, overwrite=False)
    changes = sweep.changes(other, written, resume=True, overwrite=True)
    assert "1 case (ke_0.1) with a different deck than before" in changes


def test_the_board_tells_of_running_cases(plan, written, capsys, monkeypatch):
    monkeypatch.setattr(monitor, "LINE_SECONDS", 0.0)
    place = pretend(written, plan, "ke_0.2", None)
    pretend(written, plan, "ke_0.1", "done")
    write_json(place / "progress.json", {"fraction": 0.5, "left_s": 30.0, "wall_s": 30.0, "host": "here", "process": 7})
    with held(place / "run.lock"), monitor.board(hydro2d.open_study(written), quiet=False) as board:
        board.workers = lambda: 1
        board.line("two\nlines")
        board.update()
        board.further = 5
        assert "2 invalid, about 5 to come; 12 min 10 s left" in board.summary()
    shown = capsys.readouterr().out
    assert "1 of 6 done, 2 waiting, 1 running, 2 invalid; 3 min 50 s left" in shown
    assert "  ke_0.2  running  -  50 %  30 s  here:7" in shown
    assert [line.split("  ")[1] for line in (written / "sweep.log").read_text().splitlines()] == ["two", "lines"]


def test_the_live_table_fits_the_terminal(plan, written):
    pretend(written, plan, "ke_0.1", "done")
    board = monitor.Live(hydro2d.open_study(written), io.StringIO(), False)
    board.close()
    console = rich.console.Console(file=io.StringIO(), width=100, height=monitor.FRAME + 2)
    board._live.console = console
    console.print(board._picture())
    shown = console.file.getvalue().splitlines()
    assert shown[0].split() == ["case", "status", "depth", "done", "time", "left", "worker"]
    assert shown[-2].strip() == "... and 4 more"
    assert shown[-1].startswith("1 of 6 done")


def test_the_board_says_how_far_compilation_is(tmp_path):
    """The cases wait meanwhile."""
    board = monitor.Board(study_directory.Study(tmp_path, "", "a", (), ()), io.StringIO(), quiet=True)
    board.compiling = lambda: "compiling kernels: 14 of 23, 21 s"
    assert board.summary() == "0 of 0 done; compiling kernels: 14 of 23, 21 s"
    board.compiling = lambda: ""
    assert board.summary() == "0 of 0 done"
