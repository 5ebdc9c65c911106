"""A shot as a function for optimisers: points with units, runs that are read again, suggestions after the standard."""

import tomllib

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
    with pytest.raises(ValueError, match="a point has no depth_m"):
        function.ingest([function.suggest()[0]])


def test_results_that_tell_nothing_and_points_that_are_none(tmp_path):
    """Equal results and NaN leave the suggestions as they are; what is refused changes nothing."""
    function, points = objective(tmp_path), objective(tmp_path).suggest(40)
    for wrong in ({NAME: 1.0}, [{**points[0], "depth_m": "a"}], [{**points[0], "depth_m": None}], [{NAME: 1.0}]):
        with pytest.raises(ValueError, match=r"single one|not a number|has no"):
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
