"""`hydro2d run --repeats` and `--member`: the same bits serially and on workers, on one thread and two, after a kill."""

import os
import signal

import pytest

import hydro2d
from hydro2d.deck import deck as decks
from hydro2d.running.run import run
from hydro2d.study.plan import cases
from tests.study import tubes

ENSEMBLE = ["--repeats", 3, "--by", "first step"]


@pytest.fixture(scope="module")
def tube(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tube")
    tubes.write(folder)
    return folder / "tube.toml"


@pytest.fixture(scope="module")
def serially(tube):
    """Bits of every member, run one after the other in this process."""
    tables = {"deck": str(tube), "ensemble": {"repeats": 3, "by": ["first step"]}}
    plan = cases.plan_of(tables, "tube", tubes.LONG[1::2])
    for case in plan.cases:
        run(decks.loads(case.text, name="tube"), tube.parent / case.name, quiet=True)
    return {case.name: tubes.bits(tube.parent / case.name) for case in plan.cases}


@pytest.mark.thorough
def test_members_differ(serially):
    first, second, third = serially.values()
    assert first != second != third != first


@pytest.mark.thorough
def test_one_member_again_on_two_threads(tube, serially, tmp_path):
    command = [tube, *tubes.LONG, "--by", "first step", "--member", 2, "--threads", 2, "--out", tmp_path / "one"]
    status, said = tubes.sweep(*command, command="run")
    assert status == 0, said
    assert tubes.bits(tmp_path / "one") == serially["m2"]


@pytest.mark.thorough
def test_killed_in_the_middle_and_resumed_on_workers(tube, serially, tmp_path):
    out, command = tmp_path / "out", [tube, *ENSEMBLE, *tubes.LONG, "--out", tmp_path / "out", "--workers", 2]
    process = tubes.start(*command, command="run", start_new_session=True)
    tubes.wait_for(lambda: list(out.glob("cases/*/restart.h5")))
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    assert any(case.status != "done" for case in hydro2d.open_study(out).cases)
    status, said = tubes.sweep(*command, command="run")
    assert (status, "; --restart continues it" in said) == (2, True)  # the option of this command, not of `sweep`
    status, said = tubes.sweep(*command, "--restart", command="run")
    assert status == 0, said
    assert "3 of 3 done" in said
    assert f"a page of all cases: hydro2d report {out}\n" in said
    assert {name: tubes.bits(out / "cases" / name) == bits for name, bits in serially.items()} == dict.fromkeys(serially, True)


@pytest.mark.thorough
def test_an_ensemble_can_be_enlarged(tube, tmp_path):
    """The members that are there stay, and the new ones are run."""
    short = ["--set", "stop.time=0.01", "--by", "first step", "--workers", 1, "--out", tmp_path / "out"]
    assert tubes.sweep(tube, "--repeats", 2, *short, command="run")[0] == 0
    before = (tmp_path / "out" / "cases" / "m1" / "summary.json").stat().st_mtime_ns
    status, said = tubes.sweep(tube, "--repeats", 3, *short, "--restart", command="run")
    assert status == 0, said
    assert (tmp_path / "out" / "cases" / "m1" / "summary.json").stat().st_mtime_ns == before
    assert [case.member for case in hydro2d.open_study(tmp_path / "out").cases] == [0, 1, 2]


@pytest.mark.parametrize(("options", "said"), [
    (["--repeats", "0"], "from 2 to 1000"), (["--repeats", "1e9"], "from 2 to 1000"), (["--member", "-1"], "from 0 to 999"),
    (["--repeats", "3", "--member", "1"], "give one of them"), (["--seed", "1"], "needs --repeats or --member"),
    (["--workers", "1"], "needs --repeats"), (["--repeats", "3", "--by", "luck"], 'unknown value "luck"'),
    (["--repeats", "3", "--restart", "--overwrite"], "give one of them"),
])
def test_wrong_options_are_one_message(tube, options, said, capsys, tmp_path):
    from hydro2d.cli.main import call

    assert call(["run", str(tube), "--out", str(tmp_path / "out"), *options]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
    assert not (tmp_path / "out").exists()
