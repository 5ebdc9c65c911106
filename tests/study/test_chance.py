"""Searches with a budget: which shots run, the report on them, interruptions, bad input, and a real shot."""

import base64
import csv
import json
import math

import numpy as np
import pytest

from hydro2d.cli.main import call
from hydro2d.deck import deck as decks
from hydro2d.study.plan import draws, members
from hydro2d.study.plan.definition import Ensemble
from hydro2d.study.report.report import report
from hydro2d.study.run.case import Outcome
from tests.study import fake, made_up, test_transition, tubes
from tests.study.html import Page

BASE = "problems/cth_nose_shape/hemi_5083_1086_layer.toml"
STUDY = f"""
title = "A search"
deck = "{BASE}"
[transition]
from = "900 m/s"
to = "1500 m/s"
of = "erosion"
budget = 16
seed = 3
"""


def write(folder, text=STUDY):
    return made_up.study_file(folder, text)


def search(folder, client, text=STUDY, **options):
    """A search with a made-up client: exit status and the only combination of transition.json."""
    status, result = made_up.search(folder, client, text, **options)
    return status, result["combinations"][0]


def erodes(velocity, deck, scale=25.0):
    """Whether a rod erodes: chance, with v50 = 1180 m/s; the draw of the deck decides."""
    number = np.random.default_rng(int(deck["numerics"]["initial_dt_factor"] * 1e15)).random()
    return number < 1.0 / (1.0 + math.exp(-(velocity - 1180.0) / scale))


def chancy(velocity, deck):
    return {"regime": "eroding" if erodes(velocity, deck) else "rigid", "depth": 0.2 if erodes(velocity, deck) else 0.4}


def names(folder):
    return [entry["name"] for entry in json.loads((folder / "out" / "study.json").read_text())["cases"]]


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """An undisturbed search of one worker: folder, client, exit status, result."""
    folder, client = tmp_path_factory.mktemp("chance"), made_up.Client(chancy)
    return folder, client, *search(folder, client)


# ------------------------------------------------------------------------------------------------ what runs


def test_the_budget_is_spent_and_v50_found(whole):
    _, client, status, result = whole
    assert (status, len(client.submitted)) == (0, 16)
    assert result["estimate"]["v50_low_m_s"] < 1180.0 < result["estimate"]["v50_high_m_s"]
    assert result["transitions"][0]["settled"]
    assert (result["estimate"]["runs"], result["estimate"]["budget"]) == (16, 16)


def test_every_shot_is_another_draw(whole):
    folder = whole[0]
    with open(folder / "out" / "transition.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    deck = decks.load(BASE)
    half = 0.5 * np.diff(decks.edges(deck)[1]).min()
    for column, low, high in (("first_step_factor", 0.0996, 0.1),
                              ("z_start_m", deck.mesh.z_start - half, deck.mesh.z_start + half)):
        drawn = [float(row[column]) for row in rows]
        assert len(set(drawn)) == 16
        assert all(low <= each <= high for each in drawn)
    assert [row["case"] for row in rows] == names(folder)
    assert {row["outcome"] for row in rows} == {"eroding", "not eroding"}


@pytest.mark.thorough
@pytest.mark.parametrize("workers", [2, 3, 7])
def test_the_same_seed_gives_the_same_search_with_any_number_of_workers(tmp_path, whole, workers):
    client = made_up.Client(chancy, workers=workers)
    result = search(tmp_path, client)[1]
    assert names(tmp_path) == names(whole[0])
    assert result["estimate"] == whole[3]["estimate"]


def test_another_seed_gives_other_draws(tmp_path, whole):
    search(tmp_path, made_up.Client(chancy), STUDY.replace("seed = 3", "seed = 4"))
    first = [json.loads((folder / "out" / "study.json").read_text())["cases"][0] for folder in (tmp_path, whole[0])]
    assert first[0]["name"] == first[1]["name"]
    assert first[0]["deck_sha256"] != first[1]["deck_sha256"]


def test_a_draw_is_a_member_of_an_ensemble():
    text = fake.deck_text()
    drawn = [draws.overrides(text, 3, number) for number in (1, 1, 2)]
    assert drawn[0] == drawn[1] != drawn[2]
    deck = decks.loads(text)
    assert drawn[2] == members.overrides(deck, members.amounts(Ensemble(repeats=2, seed=3), 2))
    keys = {entry.split("=")[0] for entry in drawn[2]}
    assert keys >= {"numerics.initial_dt_factor", "mesh.z_start"}


def test_a_deck_whose_mesh_must_not_move_is_drawn_by_its_first_step_alone():
    walled = decks.load(BASE, ['boundaries.z_max="wall"']).to_toml()
    assert {entry.split("=")[0] for entry in draws.overrides(walled, 3, 1)} == {"numerics.initial_dt_factor"}


@pytest.mark.parametrize("workers", [1, 3])
def test_an_interrupted_search_goes_on_to_the_same_end(tmp_path, whole, workers):
    first = made_up.Client(chancy, workers=workers, interrupt_at=7)
    status, result = search(tmp_path, first)
    assert status == 130
    assert not result["transitions"][0]["settled"]
    assert "the budget is not spent; --resume continues" in result["notes"]
    again = made_up.Client(chancy, workers=workers)
    status, result = search(tmp_path, again, resume=True)
    assert status == 0
    assert result["estimate"] == whole[3]["estimate"]
    assert names(tmp_path) == names(whole[0])
    assert set(first.submitted) & set(again.submitted) == {first.submitted[6]}


def test_a_larger_budget_goes_on_with_the_shots_that_are_there(tmp_path, whole):
    search(tmp_path, made_up.Client(chancy), STUDY.replace("16", "8"))
    client = made_up.Client(chancy)
    status, result = search(tmp_path, client, resume=True)
    assert (status, len(client.submitted)) == (0, 8)
    assert result["estimate"] == whole[3]["estimate"]


def test_another_seed_is_not_mixed_with_the_shots_that_are_there(tmp_path, capsys):
    search(tmp_path, made_up.Client(chancy), STUDY.replace("16", "4"))
    file = write(tmp_path, STUDY.replace("seed = 3", "seed = 5"))
    assert call(["transition", str(file), "--out", str(tmp_path / "out"), "--resume"]) == 2
    assert "had a different deck when the study was begun; --overwrite runs them again" in capsys.readouterr().err


def test_outcomes_that_are_all_alike_end_the_search(tmp_path, capsys):
    client = made_up.Client(lambda velocity, deck: {"regime": "rigid"})
    status, result = search(tmp_path, client)
    assert (status, len(client.submitted)) == (0, 8)
    assert "8 of 8 shots not eroding; it lies above 1500 m/s, or chance hid it" in capsys.readouterr().out
    assert result["estimate"]["v50_m_s"] is None
    assert result["transitions"][0]["settled"]


def test_shots_that_fail_cost_their_part_of_the_budget(tmp_path, capsys):
    client = made_up.Client(lambda v, deck: Outcome("failed", "a fault") if v == 1300.0 else chancy(v, deck))
    status, result = search(tmp_path, client)
    assert (status, len(client.submitted), result["estimate"]["runs"]) == (3, 16, 15)
    assert "bought with 15 of 16 runs" in capsys.readouterr().out


def test_a_search_whose_shots_all_fail_ends(tmp_path):
    client = made_up.Client(lambda velocity, deck: Outcome("failed", "the disk is full"))
    status, result = search(tmp_path, client)
    assert (status, len(client.submitted)) == (3, 4)
    assert result["notes"][0] == "v50 is not known: no run has an outcome"


AXIS = """[[axis]]
name = "advection"
key = "numerics.advection"
values = ["ke", "momentum"]
"""


def test_every_combination_has_its_budget_and_its_v50(tmp_path):
    client = made_up.Client(chancy, workers=2)
    search(tmp_path, client, STUDY + AXIS)
    assert sum(name.startswith("ke_") for name in client.submitted) == 16
    result = json.loads((tmp_path / "out" / "transition.json").read_text())
    assert [each["title"] for each in result["combinations"]] == ["advection = ke", "advection = momentum"]
    assert all(each["estimate"]["v50_m_s"] for each in result["combinations"])


def test_a_combination_whose_deck_is_wrong_does_not_sink_the_rest(tmp_path):
    client = made_up.Client(chancy)
    status, result = search(tmp_path, client, STUDY + AXIS.replace('"momentum"', '"kinetic"'))
    assert (status, len(client.submitted)) == (3, 16)
    assert result["estimate"]["v50_m_s"] is not None


# ------------------------------------------------------------------------------------------------ other outcomes


def plate(velocity, deck):
    if not erodes(velocity, deck, 4.0):
        return {"regime": "rigid", "depth": 0.3}
    left = 0.9 * max(velocity**2 - 1180.0**2, 400.0) ** 0.5
    return {"regime": "eroding", "depth": 0.54, "exit_time_s": 4e-4, "rod_residual_velocity_m_s": left,
            "stop_reason": "perforation of plate"}


def test_a_ballistic_limit_has_the_estimate_of_the_military_standard_as_well(tmp_path, capsys):
    text = STUDY.replace("erosion", "perforation").replace("16", "40")
    status, result = search(tmp_path, made_up.Client(plate), text)
    assert status == 0
    shown = capsys.readouterr().out
    assert f"V50 of MIL-STD-662F: {result['estimate']['mil_std_662f_m_s']:.1f} m/s from" in shown
    assert result["estimate"]["mil_std_662f_m_s"] == pytest.approx(1180.0, abs=40.0)
    assert result["estimate"]["outcome"] == "perforated"


@pytest.mark.parametrize(("of", "slow", "fast"), [("deeper", "shallower", "deeper"), ("shallower", "deeper", "shallower")])
def test_a_threshold_of_depth(tmp_path, of, slow, fast):
    """Fast shots go less deep here, so only the search for a depth finds a transition."""
    text = STUDY.replace('"erosion"', f'"{of}"\ndepth = "30 cm"')
    result = search(tmp_path, made_up.Client(chancy), text)[1]
    assert {run["regime"] for run in result["runs"]} == {slow, fast}
    assert (result["estimate"]["v50_m_s"] is None) == (of == "deeper")


def test_a_rod_that_left_the_mesh_before_the_depth_has_no_outcome(tmp_path):
    gone = {"depth": 0.1, "regime": "left the mesh", "rod_mass_kg": 0.0}
    text = STUDY.replace('"erosion"', '"shallower"\ndepth = "30 cm"')
    result = search(tmp_path, made_up.Client(lambda v, deck: gone if v == 1300.0 else chancy(v, deck)), text)[1]
    assert [run["regime"] for run in result["runs"] if run["velocity_m_s"] == 1300.0] == [None]


def test_erosion_is_found_by_bisection_too(tmp_path):
    text = STUDY.replace("budget = 16\nseed = 3", 'tolerance = "50 m/s"')
    outcome = {False: {"regime": "deforming"}, True: {"regime": "eroding"}}
    client = made_up.Client(lambda velocity, deck: outcome[velocity > 1185.0])
    result = search(tmp_path, client, text)[1]
    assert (result["transitions"][0]["low_m_s"], result["transitions"][0]["high_m_s"]) == (1150, 1200)
    assert result["estimate"] is None


# ------------------------------------------------------------------------------------------------ the report


def test_the_printed_and_drawn_results(tmp_path, capsys):
    search(tmp_path, made_up.Client(chancy))
    shown = capsys.readouterr().out
    for words in ("v50 = ", "90 % interval", "width, 10 to 90 %", "bought with 16 of 16 runs", "wrote ", "velocity "):
        assert words in shown
    assert (tmp_path / "out" / "transition.png").read_bytes()[:4] == b"\x89PNG"


def test_status_and_report_show_v50(whole, capsys):
    out = whole[0] / "out"
    assert call(["transition", str(out), "--status"]) == 0
    assert "bought with 16 of 16 runs" in capsys.readouterr().out
    assert call(["report", str(out)]) == 0
    page = Page((out / "report" / "report.html").read_text(encoding="utf-8"))
    assert page.faults == []
    fit = whole[3]["estimate"]
    for words in (f"V50 = {fit['v50_m_s']:.1f} m/s, 90 % interval {fit['v50_low_m_s']:.1f} to {fit['v50_high_m_s']:.1f}",
                  f"width, 10 to 90 %: {fit['width_m_s']:.3g} m/s", "bought with 16 of 16 runs"):
        assert page.text.count(words) == 1
    (shots,) = [each for each in page.all("img") if each["alt"].startswith("Outcome of 16 shots against impact velocity")]
    picture = (out / "report" / "transition_01.png").read_bytes()
    assert base64.b64decode(shots["src"].partition(",")[2]) == picture


def test_the_report_has_a_picture_of_every_combination_with_an_outcome(tmp_path):
    search(tmp_path, made_up.Client(chancy), STUDY + AXIS.replace('"momentum"', '"kinetic"'))
    page = Page(report([tmp_path / "out"], say=lambda line: None).read_text(encoding="utf-8"))
    assert page.faults == []
    assert [path.name for path in (tmp_path / "out" / "report").glob("transition_*")] == ["transition_01.png"]
    assert "advection = kinetic: v50 is not known: no run has an outcome" in page.text
    assert "advection = ke: v50" not in page.text


def test_check_tells_the_budget(tmp_path, capsys):
    assert call(["transition", str(write(tmp_path)), "--check"]) == 0
    shown = capsys.readouterr().out
    assert "velocities from 900 m/s to 1500 m/s, 4 at a time by body.rod.velocity" in shown
    assert "at most 16 runs" in shown


WRONG = [
    ("budget = 16", "budget = 3", "budget = 3: the first round takes 4 runs; give a budget of at least 4, or round = 3"),
    ("budget = 16", "budget = 2", "budget = 2: the first round takes 4 runs; give a budget of at least 4"),
    ("budget = 16", "budget = 16\nround = 20", "budget = 16: the first round takes 20 runs"),
    ("budget = 16", "budget = 0", "search.toml:8: transition.budget: should be greater than or equal to 1"),
    ("budget = 16", "budget = 1e9", "search.toml:8: transition.budget: "),
    ("budget = 16", "budget = 1000000000", "search.toml:8: transition.budget: should be less than or equal to 10000"),
    ("budget = 16", "budget = 16\nround = 1", "transition.round: should be greater than or equal to 3"),
    ("budget = 16", 'budget = 16\ntolerance = "5 m/s"', "tolerance belongs to a bisection"),
    ("budget = 16", "", "seed: belongs to a search with a budget; give budget, or leave it out"),
    ("seed = 3", "seed = -1", "transition.seed: should be greater than or equal to 0"),
    ('"erosion"', '"regime"', 'the outcome must be one of two, and of = "regime" has more; give of = "erosion"'),
    ('"erosion"', '"deeper"', 'depth is the threshold of of = "deeper" and of = "shallower"; give both or neither'),
    ('"erosion"', '"erosion"\ndepth = "30 cm"', "give both or neither"),
    ('"erosion"', '"deeper"\ndepth = "-30 cm"', "transition.depth: must be positive"),
    ('"erosion"', '"deeper"\ndepth = "30 kg"', '"30 kg" is a mass; expected a length'),
]


@pytest.mark.parametrize(("old", "new", "said"), WRONG)
def test_bad_input_gets_one_message(tmp_path, capsys, old, new, said):
    assert call(["transition", str(write(tmp_path, STUDY.replace(old, new))), "--check"]) == 2
    shown = capsys.readouterr().err
    assert said in shown
    assert shown.count("\n") == 1


# ------------------------------------------------------------------------------------------------ a real shot


@pytest.mark.thorough
def test_a_real_shot_whose_outcome_is_rough_in_velocity(tmp_path):
    """The short rod of test_transition.py: rigid at 1000 m/s and below, eroding at 1400 m/s and above; 1180, 1240: either."""
    (tmp_path / "shot.toml").write_text(test_transition.SHOT)
    text = STUDY.replace(BASE, "shot.toml").replace("900", "1000").replace("1500", "1400").replace("budget = 16", "budget = 8")
    out = tmp_path / "out"
    process = tubes.start(write(tmp_path, text), "--workers", 1, "--out", out, command="transition")
    said, _ = process.communicate(timeout=300)
    assert process.returncode == 0, said
    result = json.loads((out / "transition.json").read_text())["combinations"][0]
    assert 1000.0 < result["estimate"]["v50_m_s"] < 1400.0
    assert "bought with 8 of 8 runs" in said
    assert {run["regime"] for run in result["runs"]} == {"eroding", "not eroding"}
