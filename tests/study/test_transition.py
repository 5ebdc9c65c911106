"""Searches: the study file, which cases run, the report on them, and a real shot from rigid to eroding."""

import json
import shutil
import signal
import time
import tomllib

import pytest

import hydro2d
from hydro2d.cli.main import call
from hydro2d.measure.regime import RULE
from hydro2d.study.outcomes.regime import Regime
from hydro2d.study.plan import cases
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.run.case import Outcome
from tests.decks import mesh, plate, rod, stop, table
from tests.study import made_up, tubes
from tests.study.html import Page

#: a deck with a fixed mesh, in which the plate may move too
BASE = "problems/cth_nose_shape/hemi_5083_1086_layer.toml"
STUDY = f"""
title = "A search"
deck = "{BASE}"
[transition]
from = "900 m/s"
to = "1500 m/s"
tolerance = "50 m/s"
[[axis]]
name = "advection"
key = "numerics.advection"
values = ["ke", "momentum"]
"""
ALONE = STUDY.partition("[[axis]]")[0]


def write(folder, text=STUDY):
    return made_up.study_file(folder, text)


def search(folder, client, text=STUDY, **options):
    return made_up.search(folder, client, text, **options)


def brackets(saved):
    """Low and high end of every transition, by combination."""
    return [{each["name"]: (each["low_m_s"], each["high_m_s"]) for each in one["transitions"]} for one in saved["combinations"]]


def usual(velocity, deck):
    """With `ke` the rod deforms from 1085 m/s on and erodes from 1310, with `momentum` 100 m/s later."""
    later = 100.0 * (deck["numerics"]["advection"] == "momentum")
    word = made_up.regime(velocity, 1085.0 + later, 1310.0 + later)
    return {"regime": word, "depth": (velocity if word == "rigid" else 0.5 * velocity) * 4e-4}


# ------------------------------------------------------------------------------------------------ the study file


def test_the_cases_are_the_combinations_at_all_velocities(tmp_path):
    plan = cases.plan(write(tmp_path, STUDY.replace('"50 m/s"', '"250 m/s"')))
    ends = [f"{advection}_{speed}m-s" for advection in ("ke", "momentum") for speed in (900, 1150, 1400, 1500)]
    assert [case.name for case in plan.cases] == ends
    assert plan.cases[1].values == {"advection": "ke", "velocity": "1150 m/s"}
    assert tomllib.loads(plan.cases[1].text)["body"][0]["velocity"] == [0.0, 1150.0]
    assert (plan.search.key, plan.search.tolerance) == ("body.rod.velocity", 250.0)
    assert plan.axes[-1] == {"name": "velocity", "key": "body.rod.velocity", "values": list(plan.search.labels)}


def test_defaults_of_the_table_and_no_axis(tmp_path):
    plan = cases.plan(write(tmp_path, ALONE.replace('tolerance = "50 m/s"', "").replace('"900 m/s"', '"1.2 km/s"')))
    assert plan.search.labels == tuple(f"{speed} m/s" for speed in range(1200, 1501, 25))
    assert [case.name for case in plan.cases[:2]] == ["1200m-s", "1225m-s"]


def test_a_rod_that_flies_to_minus_z(tmp_path):
    text = ALONE.replace('"900 m/s"', '"-900 m/s"').replace('"1500 m/s"', '"-1500 m/s"')
    assert cases.plan(write(tmp_path, text)).search.labels[:2] == ("-900 m/s", "-950 m/s")


WRONG = [
    ("[transition]", "[transitoin]", 'search.toml:4: transitoin: unknown key "transitoin"; did you mean "transition"'),
    ('tolerance = "50 m/s"', 'tolerence = "50 m/s"', 'search.toml:7: transition.tolerence: unknown key "tolerence"; did you'),
    ('from = "900 m/s"', "", "search.toml:4: transition.from: is missing"),
    ('"900 m/s"', '"900 mm"', 'search.toml:5: transition.from: "900 mm" is a length; expected a velocity'),
    ('"900 m/s"', '"1600 m/s"', "search.toml:4: transition: from = 1600 m/s, to = 1500 m/s: to must be faster"),
    ('"900 m/s"', '"-900 m/s"', "in the same direction"),
    ('"50 m/s"', '"0 m/s"', "search.toml:7: transition.tolerance: must be positive"),
    ('"50 m/s"', '"1 mm/s"', "search.toml:4: transition: has 600001 values; at most 10000"),
    ('"50 m/s"', '"50 m/s"\nkey = "body.rd.velocity"', 'toml:8: no deck has the key body.rd.velocity: body: unknown entry'),
    ('"50 m/s"', '"50 m/s"\nkey = "body.plate.thickness"', 'body[1].thickness: "900 m/s" is a velocity; expected a length'),
    ('"50 m/s"', '"50 m/s"\nkey = "body.rod.velocity"\n[set]\n"body.plate.velocity" = "-9 m/s"',
     "search.toml:8: transition.key: with body.rod.velocity = 900 m/s the projectile hits the target at 909 m/s"),
    ('"numerics.advection"\nvalues = ["ke", "momentum"]', '"body.rod.velocity"\nvalues = ["900 m/s", "1000 m/s"]',
     'search.toml:8: axis "advection" sets body.rod.velocity, and the search varies body.rod.velocity'),
    ('name = "advection"', 'name = "velocity"',
     'search.toml:8: axis[0].name: "velocity" is the name of the axis that [transition] adds'),
    ('["ke", "momentum"]', '["ke"]\n[[exclude]]\nvelocity = "900 m/s"', 'exclude[0]: unknown axis "velocity"'),
    ('"problems/', '"problem/', "no such file"),
    (BASE, "problems/verification/sod_z.toml", "search.toml:4: transition: sod_z.toml has no projectile and target"),
]


@pytest.mark.parametrize(("old", "new", "said"), WRONG, ids=[new or f"no {old}" for old, new, _ in WRONG])
def test_a_wrong_file_is_one_message_and_status_2(tmp_path, capsys, old, new, said):
    assert old in STUDY
    assert call(["transition", str(write(tmp_path, STUDY.replace(old, new))), "--check"]) == 2
    shown = capsys.readouterr()
    assert said in shown.err + shown.out
    assert "Traceback" not in shown.err


def test_each_command_says_what_the_others_file_is_for(tmp_path, capsys):
    file = write(tmp_path)
    assert call(["sweep", str(file), "--check"]) == 2
    said = f"search.toml:4: transition: the study is a search in velocity; run it with `hydro2d transition {file}`"
    assert said in capsys.readouterr().err
    assert call(["transition", str(tubes.write(tmp_path)), "--check"]) == 2
    assert "tubes.toml: transition: is missing: a table with the velocities to search" in capsys.readouterr().err


def test_check_prints_the_ends_and_the_number_of_runs(tmp_path, capsys):
    assert call(["transition", str(write(tmp_path)), "--check", "--workers", "2"]) == 0
    shown = capsys.readouterr().out
    assert [line.split()[0] for line in shown.splitlines() if line.startswith(("ke", "mom"))] == [
        "ke_900m-s", "ke_1500m-s", "momentum_900m-s", "momentum_1500m-s",
    ]
    assert "2 combinations of the axes, 13 velocities 50 m/s apart by body.rod.velocity" in shown
    assert "at most about 10 runs each" in shown


# ------------------------------------------------------------------------------------------------ made-up runs


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A finished search, its client and what it printed."""
    folder, client = tmp_path_factory.mktemp("finished"), made_up.Client(usual)
    assert search(folder, client)[0] == 0
    return folder, client


@pytest.fixture
def again(finished, tmp_path):
    """A copy of the finished search."""
    shutil.copytree(finished[0], tmp_path / "copy")
    return tmp_path / "copy"


def test_every_combination_has_its_brackets(finished):
    folder, client = finished
    result = json.loads((folder / "out" / "transition.json").read_text())
    ke, momentum = brackets(result)
    assert (ke["rigid to deforming"], ke["to eroding"], ke["depth falls"]) == ((1050, 1100), (1300, 1350), (1050, 1100))
    assert (momentum["rigid to deforming"], momentum["to eroding"]) == ((1150, 1200), (1400, 1450))
    assert result["complete"]
    assert len(client.submitted) == len(set(client.submitted)) <= 2 * 10
    assert [case.name for case in hydro2d.open_study(folder / "out").cases] == [
        case.name for case in cases.plan(folder / "search.toml").cases if case.name in client.submitted
    ]
    assert {case.status for case in hydro2d.open_study(folder / "out").cases} == {"done"}


def test_a_free_worker_gets_its_next_case_before_the_last_one_is_reported(finished):
    """When the first outcome is requested, two cases have been given out, and so on; none follows the last."""
    client = finished[1]
    assert client.ahead == [*range(2, len(client.submitted) + 1), len(client.submitted)]


def test_the_hydrodynamic_limit_is_that_of_the_experiments(finished):
    """L sqrt(rho_p/rho_t) is 25 cm; rigid rods go 36 cm and deeper, others 22 cm at 1100 m/s and 27 cm at 1350 m/s."""
    result = json.loads((finished[0] / "out" / "transition.json").read_text())
    assert brackets(result)[0]["hydrodynamic limit"] == (1050, 1100)
    notes = [note for note in result["combinations"][0]["notes"] if note.startswith("out of order")]
    assert [note.partition("; ")[0] for note in notes] == [
        "out of order: no deeper than the limit at 1250 m/s, deeper than the hydrodynamic limit at 1300 m/s"]


def test_the_printed_results(again, capsys):
    client = made_up.Client(usual)
    search(again, client, resume=True)
    shown = capsys.readouterr().out
    assert "advection = ke\n  rigid to deforming  1050 to 1100 m/s" in shown
    assert "rigid at 1050 m/s, deforming at 1100 m/s" in shown
    assert "hydrodynamic limit  1050 to 1100 m/s" in shown
    assert "  experiment  1086 to 1200 m/s  shots 4344, 4345, 4346" in shown
    assert "  hydro2d     1050 to 1100 m/s" in shown
    assert "walker-anderson" in shown
    assert all(words in shown for words in RULE.values())


def test_a_second_call_runs_nothing_and_says_the_same(again):
    before = (again / "out" / "transition.json").read_text()
    with pytest.raises(StudyError, match="--resume continues it"):
        search(again, made_up.Client(usual))
    client = made_up.Client(usual, workers=4)
    assert search(again, client, resume=True)[0] == 0
    assert client.submitted == []
    assert (again / "out" / "transition.json").read_text().replace(str(again), "") == before
    assert search(again, client, overwrite=True)[0] == 0
    assert len(client.submitted) == len(set(client.submitted)) > 8
    assert set(client.submitted) == {case.name for case in hydro2d.open_study(again / "out").cases}


def test_a_smaller_tolerance_uses_the_runs_that_are_there(again):
    client = made_up.Client(usual)
    status, result = search(again, client, STUDY.replace('"50 m/s"', '"25 m/s"'), resume=True)
    assert status == 0
    assert sorted(client.submitted) == ["ke_1075m-s", "ke_1325m-s", "momentum_1175m-s", "momentum_1425m-s"]
    assert brackets(result)[0]["rigid to deforming"] == (1075, 1100)


def test_an_interrupted_search_goes_on_where_it_was(tmp_path, finished, capsys):
    whole = set(finished[1].submitted)
    first = made_up.Client(usual, interrupt_at=6)
    status, result = search(tmp_path, first)
    assert (status, result["complete"]) == (130, False)
    assert "not narrowed to 50 m/s" in capsys.readouterr().out
    again = made_up.Client(usual)
    status, result = search(tmp_path, again, resume=True)
    assert (status, result["complete"]) == (0, True)
    assert set(first.submitted) & set(again.submitted) == {first.submitted[-1]}
    assert set(first.submitted) | set(again.submitted) == whole


def test_a_search_that_broke_off_runs_no_case_twice(tmp_path, finished):
    """It ends in the middle of a case, without a last message; transition.json does not exist yet."""

    def dying(velocity, deck):
        if len(first.submitted) == 6:
            raise MemoryError
        return usual(velocity, deck)

    first, again = made_up.Client(dying), made_up.Client(usual)
    with pytest.raises(MemoryError):
        search(tmp_path, first)
    assert not (tmp_path / "out" / "transition.json").exists()
    assert search(tmp_path, again, resume=True)[1]["complete"]
    assert [*first.submitted[:-1], *again.submitted] == finished[1].submitted


def test_more_workers_than_combinations_try_several_velocities(tmp_path):
    client = made_up.Client(usual, workers=6)
    status, result = search(tmp_path, client)
    assert status == 0
    first = client.submitted[:6]
    assert [name.partition("_")[0] for name in first].count("ke") == 3
    assert {"ke_900m-s", "ke_1500m-s", "ke_1200m-s"} <= set(first)
    assert brackets(result)[0]["rigid to deforming"] == (1050, 1100)


def test_a_case_that_fails_does_not_sink_the_rest(tmp_path, capsys):
    """Its bracket stays as wide as it is and gives the reason; the others are found; --resume tries it again."""

    def failing(velocity, deck):
        lost = deck["numerics"]["advection"] == "ke" and velocity in (1050, 1100)
        return Outcome("failed", "a fault that nobody foresaw") if lost else usual(velocity, deck)

    status, result = search(tmp_path, made_up.Client(failing))
    assert status == 3
    ke, momentum = brackets(result)
    assert (ke["rigid to deforming"], ke["to eroding"]) == ((1000, 1150), (1300, 1350))
    assert momentum["rigid to deforming"] == (1150, 1200)
    assert not result["complete"]
    assert [each["settled"] for each in result["combinations"][0]["transitions"][:2]] == [False, True]
    lost = "rigid to deforming: not narrowed to 50 m/s: 1050 m/s failed: a fault that nobody foresaw; 1100 m/s failed: a fault"
    assert lost in capsys.readouterr().out
    client = made_up.Client(usual)
    status, result = search(tmp_path, client, resume=True)
    assert (status, brackets(result)[0]["rigid to deforming"]) == (0, (1050, 1100))
    assert set(client.submitted) <= {"ke_1050m-s", "ke_1100m-s"}


def test_a_combination_whose_deck_is_wrong_does_not_sink_the_rest(tmp_path):
    client = made_up.Client(usual)
    status, result = search(tmp_path, client, STUDY.replace('"momentum"', '"kinetic"'))
    assert status == 3
    ke, wrong = brackets(result)
    assert ke["rigid to deforming"] == (1050, 1100)
    assert wrong["rigid to deforming"] == (None, None)
    assert all(name.startswith("ke") for name in client.submitted)
    assert 'unknown value "kinetic"' in " ".join(result["combinations"][1]["notes"])


def test_a_search_whose_runs_all_fail_ends(tmp_path):
    client = made_up.Client(lambda velocity, deck: Outcome("failed", "the disk is full"))
    status, result = search(tmp_path, client, ALONE)
    assert (status, len(client.submitted)) == (3, 4)
    assert "nothing to compare with" in result["combinations"][0]["notes"][-1]


@pytest.mark.parametrize(
    ("ends", "expected", "said"),
    [
        ((500, 500), (None, 900), "reached already at 900 m/s, the slow end of the interval"),
        ((2000, 2000), (1500, None), "not reached at 1500 m/s, the fast end of the interval"),
    ],
)
def test_an_interval_that_is_too_short_is_reported(tmp_path, capsys, ends, expected, said):
    client = made_up.Client(lambda velocity, deck: {"regime": made_up.regime(velocity, *ends)})
    status, result = search(tmp_path, client, ALONE)
    assert (status, len(client.submitted), result["complete"]) == (0, 2, True)
    assert brackets(result)[0]["rigid to deforming"] == brackets(result)[0]["to eroding"] == expected
    assert f"rigid to deforming: open, {said}" in capsys.readouterr().out


def test_regimes_out_of_order_are_reported(tmp_path, capsys):
    def strange(velocity, deck):
        return {"regime": "rigid" if velocity == 1500 else made_up.regime(velocity, 1000, 1100)}

    search(tmp_path, made_up.Client(strange, workers=3), ALONE)
    shown = capsys.readouterr().out
    assert "out of order: eroding at 1200 m/s, rigid at 1500 m/s; the slowest change is given" in shown


def test_a_rod_that_left_the_mesh_has_no_regime(tmp_path):
    def through(velocity, deck):
        gone = {"depth": 0.54, "rod_mass_kg": 0.0, "rod_core_mass_kg": 0.0, "regime": "eroding"}
        return gone if velocity > 1400 else usual(velocity, deck)

    status, result = search(tmp_path, made_up.Client(through), ALONE)
    assert status == 0
    assert brackets(result)[0]["to eroding"] == (1300, 1350)
    runs = {run["velocity_m_s"]: run for run in result["combinations"][0]["runs"]}
    assert runs[1500]["regime"] is None
    assert "left the mesh; stop.perforation = true" in runs[1500]["reason"]


def test_a_rod_that_left_a_short_mesh_has_no_regime_either(tmp_path, capsys):
    def out(velocity, deck):
        gone = {"depth": 0.3, "rod_mass_kg": 0.0, "regime": "left the mesh", "rod_residual_velocity_m_s": 700.0}
        return gone if velocity > 1400 else usual(velocity, deck)

    status, result = search(tmp_path, made_up.Client(out), ALONE)
    assert status == 0
    assert brackets(result)[0]["to eroding"] == (1300, 1350)
    runs = {run["velocity_m_s"]: run for run in result["combinations"][0]["runs"]}
    assert (runs[1500]["regime"], runs[1500]["reason"]) == (None, "the projectile left the mesh before it came to rest")
    assert "1500 m/s  done" in (said := capsys.readouterr().out)
    assert "at least 30.00 cm" in said


def test_a_run_that_was_cut_short_is_reported(tmp_path, capsys):
    cut = {"stop_reason": "end time", "rod_core_velocity_m_s": 300.0}
    search(tmp_path, made_up.Client(lambda velocity, deck: usual(velocity, deck) | cut), ALONE)
    assert "runs that did not end at rest, whose regime is that at their end: 900 m/s, " in capsys.readouterr().out


def test_another_rod_than_the_experiments_is_reported(tmp_path, capsys):
    text = ALONE.replace("[transition]", '[set]\n"body.rod.length" = "80 mm"\n[transition]')
    _, result = search(tmp_path, made_up.Client(usual), text)
    assert "the experiments' rods were 97.79 x 6.757 mm" in result["combinations"][0]["notes"]


def test_status_and_report_show_the_transitions(again, capsys):
    assert call(["transition", str(again / "out"), "--status"]) == 0
    shown = capsys.readouterr().out
    assert "ke_1050m-s" in shown
    assert "rigid to deforming  1050 to 1100 m/s" in shown
    assert call(["sweep", str(again / "out"), "--status"]) == 0
    assert call(["report", str(again / "out")]) == 0
    page = Page((again / "out" / "report" / "report.html").read_text(encoding="utf-8"))
    assert page.faults == []
    assert "Transitions" in page.text
    assert "advection = momentum 1150 to 1200 m/s 1400 to 1450 m/s" in page.text
    assert "experiment: 1086 to 1200 m/s" in page.text
    assert Regime.terms["rigid"] in page.text


# ------------------------------------------------------------------------------------------------ a real shot

SHOT = (
    mesh([{"to": "6 mm", "size": "1 mm"}, {"cells": 6, "ratio": 1.2}], ("-16 mm", "46 mm", "1 mm"))
    + rod("3 mm", "14 mm", tip=0.0, velocity="1000 m/s")
    + plate("44 mm")
    + stop("30 us")
    + table("output", vtk_interval="30 us")
)
SHORT_ROD = """
title = "A short rod, three cells across its radius"
deck = "shot.toml"
[transition]
from = "300 m/s"
to = "1900 m/s"
tolerance = "200 m/s"
"""


@pytest.mark.thorough
def test_a_real_search_is_interrupted_and_goes_on(tmp_path):
    """Rigid at 300 m/s, eroding from about 1500 m/s on; SIGINT while the third case runs."""
    (tmp_path / "shot.toml").write_text(SHOT)
    file, out = write(tmp_path, SHORT_ROD), tmp_path / "out"
    process = tubes.start(file, "--workers", 1, "--out", out, command="transition", start_new_session=True)
    tubes.wait_for(lambda: len(list(out.glob("cases/*/run.lock"))) == 1 and len(list(out.glob("cases/*/summary.json"))) >= 2)
    time.sleep(0.2)
    process.send_signal(signal.SIGINT)
    said, _ = process.communicate(timeout=300)
    assert process.returncode == 130, said
    assert not json.loads((out / "transition.json").read_text())["complete"]
    before = {case.name: case.directory.joinpath("summary.json").stat().st_mtime_ns
              for case in hydro2d.open_study(out).cases if case.status == "done"}
    process = tubes.start(file, "--workers", 1, "--out", out, "--resume", command="transition")
    said, _ = process.communicate(timeout=300)
    assert process.returncode == 0, said
    assert "Traceback" not in said
    result = json.loads((out / "transition.json").read_text())
    (ends,) = brackets(result)
    low, high = ends["rigid to deforming"]
    assert (high - low, 300 <= low < 900) == (200, True)
    low, high = ends["to eroding"]
    assert (high - low, 1100 <= low < 1900) == (200, True)
    assert result["complete"]
    assert len(hydro2d.open_study(out).cases) <= 8
    after = {case.name: case.directory.joinpath("summary.json").stat().st_mtime_ns for case in hydro2d.open_study(out).cases}
    assert len(before) >= 2
    assert {name: after[name] for name in before} == before


# ------------------------------------------------------------------------------------------------ ballistic limit


LIMIT = ALONE.replace("[transition]", '[transition]\nof = "perforation"')


def plate(velocity, deck):
    """A target that is perforated from 1185 m/s on, with the residual velocity of Recht and Ipson's model."""
    if velocity < 1185.0:
        return {"regime": "rigid", "depth": 0.3}
    left = (velocity**2 - 1185.0**2) ** 0.5
    return {"regime": "eroding", "depth": 0.54, "exit_time_s": 4e-4, "rod_residual_velocity_m_s": left,
            "rod_residual_mass_kg": 0.05, "stop_reason": "perforation of plate"}


def test_a_ballistic_limit_is_searched(tmp_path, capsys):
    client = made_up.Client(plate)
    status, result = search(tmp_path, client, LIMIT)
    assert (status, result["complete"], result["of"]) == (0, True, "perforation")
    assert brackets(result) == [{"ballistic limit": (1150, 1200)}]
    assert len(client.submitted) <= 6
    runs = {run["velocity_m_s"]: run for run in result["combinations"][0]["runs"]}
    assert (runs[1150]["regime"], runs[1200]["regime"]) == ("stopped", "perforated")
    assert runs[1500]["residual_velocity_m_s"] == pytest.approx(919.6, abs=0.1)
    shown = capsys.readouterr().out
    assert "ballistic limit  1150 to 1200 m/s  stopped at 1150 m/s, perforated at 1200 m/s" in shown
    assert "perforation of plate, 920 m/s left" in shown
    assert "between the fastest run that is stopped and the slowest that perforates" in shown
    assert "rigid" not in shown


def test_a_rod_that_stops_in_a_bulge_has_not_perforated(tmp_path):
    """Its nose was beyond the rear, and it turned back."""
    stuck = {"regime": "rigid", "depth": 0.6, "exit_time_s": 4e-4, "rod_residual_velocity_m_s": 2.0,
             "stop_reason": "rebound of rod"}
    client = made_up.Client(lambda velocity, deck: stuck if velocity < 1185.0 else plate(velocity, deck))
    _, result = search(tmp_path, client, LIMIT)
    assert brackets(result) == [{"ballistic limit": (1150, 1200)}]


def test_a_rod_that_left_sideways_has_no_say_in_a_ballistic_limit(tmp_path):
    gone = {"depth": 0.1, "regime": "left the mesh", "rod_mass_kg": 0.0}
    client = made_up.Client(lambda velocity, deck: gone if velocity == 900.0 else plate(velocity, deck))
    _, result = search(tmp_path, client, LIMIT)
    runs = {run["velocity_m_s"]: run["regime"] for run in result["combinations"][0]["runs"]}
    assert runs[900] is None
    assert brackets(result) == [{"ballistic limit": (1150, 1200)}]


def test_slow_rods_have_no_say_in_the_hydrodynamic_limit(tmp_path):
    """A rigid rod below 1035 m/s stops before it reaches 25.5 cm."""
    def rod(velocity, deck):
        return usual(velocity, deck) | {"depth": 0.2 if velocity < 1035.0 else 0.3 if velocity < 1235.0 else 0.15}

    _, result = search(tmp_path, made_up.Client(rod), ALONE)
    low, high = brackets(result)[0]["hydrodynamic limit"]
    assert 1035 <= low < 1235 <= high


def test_a_hydrodynamic_limit_that_no_rod_exceeds_gives_no_transition(tmp_path):
    _, result = search(tmp_path, made_up.Client(lambda velocity, deck: usual(velocity, deck) | {"depth": 0.2}), ALONE)
    assert "hydrodynamic limit" not in brackets(result)[0]


# ------------------------------------------------------------------------------------------------ the loss of length

LENGTH = ALONE.replace("[transition]", '[transition]\nof = "length"')


def test_the_velocity_at_which_a_third_of_the_rod_is_used_up(tmp_path, capsys):
    """The regime, which is eroding from 1000 m/s on, does not matter in this search."""
    def rod(velocity, deck):
        left = 0.0977 * (0.68 if velocity < 1185.0 else 0.65)
        return {"regime": "eroding" if velocity > 1000.0 else "rigid", "depth": 4.0 * left, "rod_length_m": left}

    client = made_up.Client(rod)
    status, result = search(tmp_path, client, LENGTH)
    assert (status, result["complete"], result["of"]) == (0, True, "length")
    assert brackets(result)[0]["a third of the length lost"] == (1150, 1200)
    assert {*brackets(result)[0]} == {"a third of the length lost", "depth falls", "hydrodynamic limit"}
    assert len(client.submitted) <= 6
    shown = capsys.readouterr().out
    assert "a third of the length lost  1150 to 1200 m/s  kept at 1150 m/s, used up at 1200 m/s" in shown
    assert "at least two thirds of the projectile's length are left at the end" in shown
    assert "rigid to deforming" not in shown


def test_the_target_of_a_search_must_be_known(tmp_path, capsys):
    assert call(["transition", str(write(tmp_path, LIMIT.replace('"perforation"', '"perforatoin"'))), "--check"]) == 2
    said = 'transition.of: unknown value "perforatoin"; did you mean "perforation"? (allowed: deeper, erosion, '
    assert f"search.toml:5: {said}" in capsys.readouterr().err
