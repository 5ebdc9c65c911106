"""Rules that every analytic model obeys."""

import contextlib
import functools
import inspect
import itertools
import math
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from hydro2d.analytic import models
from hydro2d.base.parameters import ANY, FRACTION, POSITIVE
from hydro2d.penetration import catalogue
from hydro2d.penetration.model import InputError, Model

ROOT = Path(__file__).resolve().parents[2]
MODELS = list(catalogue.MODELS.values())
INPUTS = [pytest.param(model, entry, id=f"{model.name}-{entry.name}") for model in MODELS for entry in model.inputs]


def by_name(models: list[Model]):
    return pytest.mark.parametrize("model", models, ids=lambda model: model.name)


@functools.cache
def example(name: str) -> models.Case:
    return models.example(catalogue.MODELS[name])


def values_of(model: Model) -> dict:
    return example(model.name).values


def test_names_are_unique_and_every_module_is_listed():
    assert len(catalogue.MODELS) == sum(len(catalogue.of(module)) for module in catalogue.MODULES)
    folder = Path(catalogue.__file__).parent
    with_models = {
        file.stem for file in folder.glob("*.py")
        if any(line.startswith(("MODEL =", "MODELS =", "MODEL:", "MODELS:")) for line in file.read_text().splitlines())
    } - {"catalogue"}
    assert with_models == {module.__name__.rsplit(".", 1)[-1] for module in catalogue.MODULES}


def test_import_needs_nothing_heavy():
    """The page of a model has its data at once; scipy and pint are imported where they are used."""
    heavy = set("scipy numba matplotlib pint h5py pydantic".split())
    script = f"import sys; from hydro2d.penetration import catalogue; print(sorted({heavy!r} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@by_name(MODELS)
def test_arguments_are_the_inputs(model):
    """evaluate and transition take every input by keyword, and name none that the model does not have."""
    keywords = {entry.keyword: None for entry in model.inputs}
    for function, positional in ((model.evaluate, ("velocity",)), (model.transition, ())):
        if function is None:
            continue
        signature = inspect.signature(function)
        signature.bind(*(1.0 for _ in positional), **keywords)
        named = [entry for entry in signature.parameters.values() if entry.kind is not inspect.Parameter.VAR_KEYWORD]
        assert tuple(entry.name for entry in named)[: len(positional)] == positional
        assert {entry.name for entry in named[len(positional) :]} <= set(keywords)
        assert {entry.kind for entry in named[len(positional) :]} <= {inspect.Parameter.KEYWORD_ONLY}


@by_name(MODELS)
def test_the_example_has_every_output_and_they_are_finite(model):
    low, high = model.example.velocities
    assert 0.0 <= low < high
    known = {entry.name for entry in model.inputs}
    assert set(model.example.values) <= known
    for row in example(model.name).rows([low, model.example.velocity, high]):
        assert set(row) == {models.VELOCITY, *(entry.name for entry in model.outputs)}
        for entry in model.outputs:
            value = row[entry.name]
            if entry.unit == "":
                assert isinstance(value, str), entry.name
                assert value
            else:
                assert isinstance(value, (int, float)), entry.name
                assert not isinstance(value, bool)
                assert math.isfinite(value), entry.name


@by_name(MODELS)
def test_the_same_twice(model):
    case = example(model.name)
    assert case.rows([model.example.velocity]) == case.rows([model.example.velocity])


@by_name([model for model in MODELS if model.transition is not None])
def test_the_example_has_a_transition_or_none(model):
    velocity = example(model.name).transition()
    assert velocity is None or (math.isfinite(velocity) and velocity >= 0.0)


@pytest.mark.parametrize(("model", "entry"), INPUTS)
def test_impossible_values_are_refused(model, entry):
    """Not a number, infinite, or of the wrong sign: InputError with the input's name."""
    if entry.choices:
        bad = ["no such word", -1.0]
    else:
        bad = [math.nan, math.inf, "a word"]
        bad += [] if entry.sign == ANY else [-1.0]
        bad += {POSITIVE: [0.0], FRACTION: [1.0]}.get(entry.sign, [])
    for value in bad:
        with pytest.raises(InputError, match=entry.name.replace(".", r"\.")):
            model(model.example.velocity, {**values_of(model), entry.name: value})


@by_name(MODELS)
def test_a_missing_and_an_unknown_input_are_refused(model):
    values = values_of(model)
    for entry in model.inputs:
        if entry.required:
            with pytest.raises(InputError, match="is missing"):
                model(model.example.velocity, {name: value for name, value in values.items() if name != entry.name})
    with pytest.raises(InputError, match='unknown input'):
        model(model.example.velocity, {**values, "rod.colour": 1.0})


@by_name(MODELS)
@pytest.mark.parametrize("velocity", [-1.0, math.nan, math.inf])
def test_an_impossible_velocity_is_refused(model, velocity):
    with pytest.raises(InputError, match="velocity"):
        model(velocity, values_of(model))


def outcome(model: Model, velocity: float, values: dict | None = None) -> str:
    """"numbers", or the message of the InputError; any other exception propagates."""
    try:
        result = model(velocity, values or values_of(model))
    except InputError as error:
        return str(error)
    numbers = [result[entry.name] for entry in model.outputs if entry.unit != ""]
    assert not any(map(math.isnan if values else lambda number: not math.isfinite(number), numbers))
    return "numbers"


@by_name(MODELS)
def test_velocity_zero_gives_numbers_or_one_message(model):
    """A model that needs a moving rod says so; none divides by zero."""
    said = outcome(model, 0.0)
    assert said == "numbers" or "velocity" in said
    assert "\n" not in said


@by_name(MODELS)
@pytest.mark.parametrize("velocity", [1.0, 30.0, 2000.0])
def test_small_and_large_velocities_give_numbers_or_one_message(model, velocity):
    assert "\n" not in outcome(model, velocity)


#: numbers from nothing to everything; every run of the tests uses the short list
SOME, ALL = (1e-30, 1e-6, 1e6, 1e30), (1e-300, 1e-30, 1e-18, 1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e12, 1e18, 1e30, 1e300)
#: the longest time that a model may take for one shot, s; a shot takes milliseconds, a rigid body in soft soil ten seconds
PATIENCE = 60.0


def survives(model: Model, numbers: tuple[float, ...]) -> int:
    """Every input at every number, and the velocity: numbers or one message, in time. Returns the number of trials."""
    names = [None, *(entry.name for entry in model.inputs if not entry.choices)]
    for name, number in itertools.product(names, numbers):
        values = values_of(model) if name is None else {**values_of(model), name: number}
        began = time.perf_counter()
        assert "\n" not in outcome(model, number if name is None else model.example.velocity, values)
        if model.transition is not None:
            with contextlib.suppress(InputError):
                model.limit(values)
        assert time.perf_counter() - began < PATIENCE, (name, number)
    return len(names) * len(numbers)


@pytest.mark.thorough
@by_name(MODELS)
def test_absurd_numbers_give_numbers_or_one_message(model):
    assert survives(model, SOME) >= 8


@pytest.mark.slow
def test_two_thousand_absurd_numbers(capsys):
    count = sum(survives(model, ALL) for model in MODELS)
    with capsys.disabled():
        print(f"\n{count} absurd numbers, 0 failures")
    assert count > 2000


@pytest.mark.parametrize(("changes", "message"), [
    ({"target.density": 1.2, "target.strength": 1.0}, "hardly resists"),
    ({"rod.diameter": 1e-6}, "too slender"), ({"target.density": 1e30}, "no matter on earth")])
def test_a_rigid_body_says_what_it_cannot_follow(changes, message):
    model = catalogue.MODELS["rigid-body"]
    with pytest.raises(InputError, match=message):
        model(model.example.velocity, {**values_of(model), **changes})


def test_a_rod_without_end_is_refused_at_once():
    model = catalogue.MODELS["walker-anderson"]
    for length, message in ((1e30, "1000 km"), (1e5, "have not ended after")):
        with pytest.raises(InputError, match=message):
            model(model.example.velocity, {**values_of(model), "rod.length": length})


@pytest.mark.parametrize(("name", "change"), [
    *((model.name, {}) for model in MODELS if model.motion is not None),
    ("forrestal", {"nose.entry": "resisted"}), ("forrestal", {"nose.entry": "resisted", "nose.shape": "flat"}),
    ("forrestal", {"nose.entry": "resisted", "cavity.a": 1e5}),  # it stops before its nose is inside
])
def test_a_motion_ends_where_the_model_says(name, change):
    """From contact at the impact velocity to the depth and the duration of the model; slower and deeper all the way."""
    model, values = catalogue.MODELS[name], values_of(catalogue.MODELS[name]) | change
    speed = model.example.velocity
    motion, end = model.moves(speed, values), model(speed, values)
    assert (motion.time[0], motion.velocity[0], motion.depth[0]) == (0.0, speed, 0.0)
    assert motion.depth[-1] == pytest.approx(end["depth"])
    assert motion.time[-1] == pytest.approx(end["duration"])
    assert (np.diff(motion.time) >= 0.0).all()
    assert (np.diff(motion.depth) >= 0.0).all()
    assert (np.diff(motion.velocity) <= 1e-9 * speed).all()
    if motion.length is None:  # a rigid rod: its depth is the integral of its velocity
        steps = np.diff(motion.time) * 0.5 * (motion.velocity[1:] + motion.velocity[:-1])
        assert np.cumsum(steps)[-1] == pytest.approx(motion.depth[-1], rel=2e-3)
    else:
        assert motion.length[-1] == pytest.approx(end["residual_length"])
