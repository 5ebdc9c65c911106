"""A shot as a function for optimisers: points with units, runs that are read again, suggestions after the standard."""

import threading
import time
import tomllib
from itertools import count

import numpy as np
import pytest

import hydro2d
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.run.case import Outcome
from hydro2d.study.samples import objective as objectives
from tests.study import fake, made_up

KEYS = {"body.rod.velocity": ("1000 m/s", "1.2 km/s"), "body.rod.material": {"W_alloy", "Al5083"}}
NAME = "body.rod.velocity [m/s]"


@pytest.fixture
def runs(monkeypatch):
    """The directories that were run: in place of runs, finished ones are written, 0.1 mm deep per m/s."""
    made = []

    def run(place, text, threads):
        made.append(place.name)
        if not place.exists():
            velocity = tomllib.loads(text)["body"][0]["velocity"][1]
            made_up.write(place, text, depth=1e-4 * velocity, exit_time_s=None)
        return Outcome("done")

    monkeypatch.setattr(objectives, "run_case", run)
    return made


def objective(folder, result="depth_m", **options):
    return hydro2d.Objective(fake.BASE, KEYS, result, directory=folder / "runs", **options)


def test_a_point_by_key_or_by_name(runs, tmp_path):
    function = objective(tmp_path)
    assert function({"body.rod.velocity": "1.1 km/s"}) == pytest.approx(0.11)
    assert function({NAME: 1100.0, "_id": 7}) == pytest.approx(0.11)
    assert function({"body.rod.velocity": 1100}) == pytest.approx(0.11)
    assert len(set(runs)) == 1, "the same deck in the same directory"
    assert function({NAME: 1100.0, "body.rod.material": "Al5083"}) == pytest.approx(0.11)
    assert len(set(runs)) == 2
    assert objective(tmp_path, "penetration_depth_m")({}) == pytest.approx(0.1086), "the deck as it is"
    assert objective(tmp_path, "perforated")({}) == 0.0
    assert objective(tmp_path, "depth_m > 0.1")({}) == 1.0


def test_refusals(runs, tmp_path, monkeypatch):
    function = objective(tmp_path)
    with pytest.raises(StudyError, match=r'unknown key "body.rod.velcity"; did you mean "body.rod.velocity \[m/s\]"'):
        function({"body.rod.velcity": 1})
    with pytest.raises(hydro2d.DeckError, match="is a mass"):
        function({"body.rod.velocity": "3 kg"})
    with pytest.raises(StudyError, match='unknown result "dept_m"'):
        objective(tmp_path, "dept_m")({})
    with pytest.raises(StudyError, match='unknown goal "minimise"; did you mean "minimize"'):
        objective(tmp_path, goal="minimise")
    with pytest.raises(hydro2d.DeckError, match="velcity"):
        hydro2d.Objective(fake.BASE, {"body.rod.velcity": ("1 m/s", "2 m/s")}, "depth_m", directory=tmp_path)
    with pytest.raises(StudyError, match="body.rod.velocity: uniform: the second number must be greater"):
        hydro2d.Objective(fake.BASE, {"body.rod.velocity": ("3 m/s", "2 m/s")}, "depth_m", directory=tmp_path)
    monkeypatch.setattr(objectives, "run_case", lambda *_, **__: Outcome("failed", "the disk is full"))
    with pytest.raises(StudyError, match="the run is failed: the disk is full"):
        function({})


def test_suggestions_fill_the_bounds(tmp_path):
    function = objective(tmp_path)
    assert function.variables == {NAME: [1000.0, 1200.0], "body.rod.material": {"W_alloy", "Al5083"}}
    points = function.suggest(16)
    assert {point["body.rod.material"] for point in points} == KEYS["body.rod.material"]
    assert all(1000.0 <= point[NAME] <= 1200.0 and point.keys() == function.variables.keys() for point in points)
    assert len({point[NAME] for point in points + function.suggest(16)}) == 32, "the next ones are others"
    assert objective(tmp_path).suggest(16) == points
    assert len(function.suggest()) == 1
    with pytest.raises(ValueError, match="at least one is needed"):
        function.suggest(0)


@pytest.mark.parametrize(("goal", "best"), [("minimize", 1130.0), ("maximize", 1000.0)])
def test_suggestions_after_results_are_near_the_best(tmp_path, goal, best):
    function = objective(tmp_path, goal=goal)
    for point in function.suggest(16):
        function.ingest([{**point, "depth_m": (point[NAME] - 1130.0) ** 2}])
    assert len(function.data) == 16
    for point in function.suggest(3):
        assert point[NAME] == pytest.approx(best, abs=8.0)
    with pytest.raises(StudyError, match="a point has no depth_m"):
        function.ingest([function.suggest()[0]])


def test_results_that_tell_nothing_and_points_that_are_none(tmp_path):
    """Equal results and NaN leave the suggestions as they are; what is refused changes nothing."""
    function, points = objective(tmp_path), objective(tmp_path).suggest(40)
    for wrong in ({NAME: 1.0}, [{**points[0], "depth_m": "a"}], [{**points[0], "depth_m": None}], [{NAME: 1100.0}]):
        with pytest.raises(StudyError, match=r"single one|not a number|has no"):
            function.ingest(wrong)
    with pytest.raises(TypeError):
        function.suggest(2.5)
    assert function.data == []
    useless = (0.1, 0.1, 0.1, float("nan"))
    for first in range(0, 20, 4):
        batch = function.suggest(4)
        assert batch == points[first : first + 4]
        function.ingest([{**point, "depth_m": value} for point, value in zip(batch, useless, strict=True)])
    function.ingest([{**point, "depth_m": 1e-4 * point[NAME]} for point in points])
    assert min(point[NAME] for point in function.suggest(4)) < 1010.0, "the shallowest"
    with pytest.raises(StudyError, match="keys: is empty"):
        hydro2d.Objective(fake.BASE, {}, "depth_m", directory=tmp_path)


def test_the_standard_takes_its_variables(tmp_path):
    vocs = pytest.importorskip("gest_api.vocs", reason="gest-api, the standard for generators, is not installed")
    function = objective(tmp_path)
    made = vocs.VOCS(variables=function.variables, objectives={function.result: "MINIMIZE"})
    assert made.variables[NAME].domain == [1000.0, 1200.0]
    assert made.variables["body.rod.material"].values == KEYS["body.rod.material"]


@pytest.mark.parametrize("kind", [np.float64, np.float32, np.int64, np.array])
def test_numbers_of_numpy_are_numbers(runs, tmp_path, kind):
    function = objective(tmp_path)
    assert function({NAME: kind(1100)}) == function({"body.rod.velocity": kind(1100)}) == pytest.approx(0.11)
    plain = hydro2d.Objective(fake.BASE, {"body.rod.strength_factor": (kind(1), kind(2))}, "depth_m", directory=tmp_path)
    assert plain.variables == {"body.rod.strength_factor": [1.0, 2.0]}
    assert plain.deck_at({"body.rod.strength_factor": kind(2)}).body[0].strength_factor == 2.0


def test_none_and_a_key_given_twice_are_refused(runs, tmp_path):
    function = objective(tmp_path)
    with pytest.raises(StudyError, match=r"body.rod.velocity \[m/s\]: is None"):
        function({NAME: None})
    with pytest.raises(StudyError, match="body.rod.velocity: is given twice"):
        function({NAME: 1100.0, "body.rod.velocity": "1.1 km/s"})
    assert runs == []


def test_a_point_is_taken_as_in_a_call(tmp_path):
    keys = {"body.rod.velocity": ("1000 m/s", "1.2 km/s"), "body.rod.strength_factor": {1.0, 2}}
    function = hydro2d.Objective(fake.BASE, keys, "depth_m", directory=tmp_path)
    taken = {NAME: 1100.0, "body.rod.strength_factor": 1.0, "depth_m": 0.5}
    for velocity, cells in (("1.1 km/s", 1), (1100, np.float64(1.0)), (np.float32(1100.0), np.int64(1))):
        function.ingest([{NAME: velocity, "body.rod.strength_factor": cells, "depth_m": 0.5, "_id": 3}])
        function.ingest([{"body.rod.velocity": velocity, "body.rod.strength_factor": cells, "depth_m": np.float64(0.5)}])
    assert [{**point, "_id": 3} for point in function.data] == [{**taken, "_id": 3}] * 6


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"body.rod.material": "W_aloy"}, r'body.rod.material: unknown value "W_aloy"; did you mean "W_alloy"'),
        ({NAME: 900.0}, r"velocity \[m/s\]: is 900.0; expected a number from 1000 to 1200 m/s"),
        ({NAME: "3 kg"}, r"velocity \[m/s\]: is '3 kg'"),
        ({NAME: float("nan")}, r"velocity \[m/s\]: is nan"),
        ({NAME: True}, r"velocity \[m/s\]: is True"),
        ({NAME: None}, r"velocity \[m/s\]: is None"),
    ],
)
def test_a_wrong_point_adds_none(tmp_path, wrong, said):
    function, right = objective(tmp_path), {NAME: 1100.0, "body.rod.material": "W_alloy", "depth_m": 0.1}
    with pytest.raises(StudyError, match=said):
        function.ingest([right, {**right, **wrong}])
    assert function.data == []


def test_suggestions_find_the_least_value_without_repeats(tmp_path):
    keys = {"body.rod.velocity": ("1000 m/s", "1200 m/s"), "numerics.courant": (0.2, 0.5)}
    function = hydro2d.Objective(fake.BASE, keys, "depth_m", directory=tmp_path)
    seen = set()
    for _ in range(10):
        points = function.suggest(4)
        seen |= {tuple(point.values()) for point in points}
        function.ingest([{**point, "depth_m": (point[NAME] - 1114.0) ** 2 / 4e4 + (point["numerics.courant"] - 0.3) ** 2 / 0.09}
                         for point in points])
    assert len(seen) == 40
    best = min(function.data, key=lambda point: point["depth_m"])
    assert best[NAME] == pytest.approx(1114.0, abs=0.2)
    assert best["numerics.courant"] == pytest.approx(0.3, abs=3e-4)
    anew = hydro2d.Objective(fake.BASE, keys, "depth_m", directory=tmp_path)
    anew.ingest(function.data[:5])
    assert not {tuple(point.values()) for point in anew.suggest(4)} & {(each[NAME], each["numerics.courant"])
                                                                        for each in function.data[:5]}


@pytest.mark.parametrize("goal", ["minimize", "explore"])
def test_all_combinations_come_before_any_comes_again(tmp_path, goal):
    keys = {"body.rod.material": {"W_alloy", "Al5083"}, "body.rod.strength_factor": {1, 2, 3, 4}}
    function = hydro2d.Objective(fake.BASE, keys, "depth_m", directory=tmp_path, goal=goal)
    depth, points = count(), []
    for _ in range(4):
        points += function.suggest(2)
        function.ingest([{**point, "depth_m": next(depth)} for point in points[-2:]])
    assert len({tuple(point.values()) for point in points}) == 8
    assert len({tuple(point.values()) for point in function.suggest(10)}) == 8


def test_an_interrupt_ends_the_caller(tmp_path, monkeypatch):
    monkeypatch.setattr(objectives, "run_case", lambda *_, **__: Outcome("interrupted", "interrupted (SIGINT)"))
    with pytest.raises(KeyboardInterrupt, match="SIGINT"):
        objective(tmp_path)({})


def test_callers_of_one_point_take_turns(tmp_path, monkeypatch, runs):
    """The second one comes to a finished run."""
    function, run, inside, most = objective(tmp_path), objectives.run_case, [], []

    def slow(place, text, threads):
        inside.append(place)
        most.append(len(inside))
        time.sleep(0.2)
        outcome = run(place, text, threads)
        inside.pop()
        return outcome

    monkeypatch.setattr(objectives, "run_case", slow)
    callers = [threading.Thread(target=function, args=({NAME: 1100.0},)) for _ in range(3)]
    for caller in callers:
        caller.start()
    for caller in callers:
        caller.join()
    assert most == [1, 1, 1]
