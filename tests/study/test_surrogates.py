"""Surrogates and Sobol indices against functions whose indices are known; fractions against a known probability."""

import numpy as np
import pandas
import pytest
from scipy.special import ndtri
from scipy.stats import qmc

from hydro2d.study.plan import joint
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.distributions import Distribution
from hydro2d.study.plan.sample_section import Joint
from hydro2d.study.samples import gaussian, sobol, surrogates, text
from hydro2d.study.samples.results import Samples

#: constants of Ishigami's function sin x1 + A sin^2 x2 + B x3^4 sin x1 on -pi to pi; rows of its samples
A, B, ROWS = 7.0, 0.1, 128
#: its variance, and its indices: Ishigami & Homma, Proc. ISUMA (1990) 398
VARIANCE = A**2 / 8 + B * np.pi**4 / 5 + B**2 * np.pi**8 / 18 + 0.5
FIRST = np.array([0.5 * (1 + B * np.pi**4 / 5) ** 2, A**2 / 8, 0.0]) / VARIANCE
TOTAL = FIRST + B**2 * np.pi**8 * (1 / 18 - 1 / 50) / VARIANCE * np.array([1, 0, 1])
ANGLES = [Distribution(f"x{n}", "uniform", "", (-np.pi, np.pi)) for n in (1, 2, 3)]


def sample(inputs, function, rows, seed):
    """A sample of a function by Sobol's points: Samples, with the result "y"."""
    cube = joint.correlated(inputs, qmc.Sobol(len(inputs), seed=np.random.default_rng(seed)).random(rows))
    values = {each.head: np.array(each.values(points)) for each, points in zip(inputs, cube.T, strict=True)}
    columns = {"row": np.arange(1.0, rows + 1), **values, "status": np.full(rows, "done"), "y": function(*values.values())}
    return Samples("a function", inputs, pandas.DataFrame(columns))


def ishigami(x1, x2, x3):
    return np.sin(x1) + A * np.sin(x2) ** 2 + B * x3**4 * np.sin(x1)


def covered(seed):
    """Which indices of Ishigami's function lie in their intervals, bool[2, 3]: first-order, total."""
    found = sample(ANGLES, ishigami, ROWS, seed).indices("y").inputs
    return np.array([[each.first_low <= first <= each.first_high for each, first in zip(found, FIRST, strict=True)],
                     [each.total_low <= total <= each.total_high for each, total in zip(found, TOTAL, strict=True)]])


def test_ishigami():
    assert covered(0).all()


@pytest.mark.slow
def test_ishigami_with_ten_seeds():
    """Each of the six indices lies in its interval for nine of ten samples."""
    hits = sum(covered(seed).astype(int) for seed in range(10))
    assert hits.min() >= 9, hits


@pytest.mark.parametrize("seed", range(3))
def test_chance_is_not_taken_for_interactions(seed):
    """A sum of five inputs with chance of 0.5 of its standard deviation: the chance is found, and the indices are the sum's."""
    slopes = np.array([2.0, 1.2, 0.8, 0.4, 0.0])
    inputs = [Distribution(f"x{n}", "uniform", "", (0.0, 1.0)) for n in range(5)]
    chance = 0.5 * np.sqrt(slopes @ slopes / 12.0)
    noise = chance * np.random.default_rng(seed).standard_normal(64)
    found = sample(inputs, lambda *x: slopes @ np.array(x) + noise, 64, seed).indices("y")
    assert found.surrogate.noise == pytest.approx(chance, rel=0.35)
    assert found.surrogate.rmse == pytest.approx(chance, rel=0.35)
    shares = slopes**2 / (slopes @ slopes)
    for each, true in zip(found.inputs, shares, strict=True):
        assert each.total == pytest.approx(true, abs=0.13)
    assert sum(each.total for each in found.inputs) < 1.15


def test_sums_have_no_interactions_and_choices_have_levels():
    law = Distribution("law", "choice", levels=("x", "y", "z"), weights=(1 / 3,) * 3)
    inputs = [Distribution("a", "normal", "", (0.0, 1.0)), law]
    heights = {"x": -2.0, "y": 0.0, "z": 2.0}
    samples = sample(inputs, lambda a, law: 2.0 * a + np.array([heights[each] for each in law]), 64, 1)
    found = samples.indices("y")
    share = 4.0 / (4.0 + 8.0 / 3.0)
    for each, true in zip(found.inputs, (share, 1.0 - share), strict=True):
        assert each.first_low <= true <= each.first_high
        assert each.total == pytest.approx(each.first, abs=0.05)
    assert found["law"] is found.inputs[1]
    assert found.surrogate.q2 > 0.99
    assert found.doubt == ""
    numbers, law = sorted(samples.effects("y"), key=lambda each: each.input)
    assert (numbers.low, numbers.high) == pytest.approx((-4.563, 0.563), abs=0.1), "with the first of the equal levels"
    assert (numbers.at_low, numbers.at_high) == ("-1.282", "1.282")
    assert (law.at_low, law.at_high) == ("x", "z")
    assert law.high - law.low == pytest.approx(4.0, abs=0.1)
    assert [len(figure.axes) for figure in (samples.scatter("y"), samples.tornado("y"))] == [2, 1]


def test_inputs_of_a_joint_distribution_have_the_indices_of_their_group():
    """A sum a + 2 b + 3 c with an independent c: the variance of a + 2 b is 1 + 4 + 2 * 2 * 0.8."""
    pair = Joint(keys=("a", "b"), mean=(5.0, -1.0), covariance=((1.0, 0.8), (0.8, 1.0)))
    inputs = [Distribution("c", "normal", "", (0.0, 1.0)), *Distribution.of_joint(pair)]
    made = sample(inputs, lambda c, a, b: a + 2.0 * b + 3.0 * c, 64, 0)
    shares, alone = made.indices("y"), 9.0 / (9.0 + 8.2)
    assert [each.input for each in shares.inputs] == ["c", "a with b"]
    assert [each.first for each in shares.inputs] == pytest.approx([alone, 1.0 - alone], abs=0.02)
    assert [each.total for each in shares.inputs] == pytest.approx([alone, 1.0 - alone], abs=0.02)
    assert shares["a"] == shares["b"] == shares.inputs[1]
    assert sobol.GROUPED in text.indices(made, "y")[1]
    slopes = {each.input: (each.high - each.low) / (2.0 * ndtri(0.9)) for each in made.effects("y")}
    assert slopes == pytest.approx({"c": 3.0, "a": 1.0 + 2.0 * 0.8, "b": 2.0 + 0.8}, rel=0.05), "the other one follows"
    assert made.scatter("y").axes


def test_the_ends_of_a_bar_stand_apart_even_on_one_side_of_the_middle():
    samples = sample(ANGLES[:1], lambda x1: (x1 + 0.5) ** 2, 64, 0)
    (effect,), axes = samples.effects("y"), samples.tornado("y").axes[0]
    middle = float(samples.surrogate("y")(np.array([[0.5]]))[0])
    assert min(effect.low, effect.high) > middle
    places = sorted((text.xy[0], text.get_ha()) for text in axes.texts)
    assert places == [(pytest.approx(middle), "right"), (pytest.approx(max(effect.low, effect.high)), "left")]


def test_pictures_name_tables_by_their_beginning():
    laws = tuple(f'{{ model = "{name}", yield_stress = "276 MPa", n = 1 }}' for name in ("power-law", "voce"))
    inputs = [Distribution("law", "choice", levels=laws, weights=(0.5, 0.5)), ANGLES[0]]
    made = sample(inputs, lambda law, x: np.where(law == laws[0], 1.0, 3.0) + x, 32, 0)
    assert [label.get_text() for label in made.scatter("y").axes[0].get_xticklabels()] == [
        '"power-law", yield_stre\u2026', '"voce", yield_stress = \u2026']


def test_labels_of_a_tornado_lie_within_its_frame():
    """Also long ones at both ends of the longest bar."""
    laws = ("copper_OFHC:johnson-cook", "copper_OFHC:zerilli-armstrong")
    law = Distribution("law", "choice", levels=laws, weights=(0.5, 0.5))
    samples = sample([Distribution("a", "normal", "", (0.0, 1.0)), law], lambda a, law: a + 9.0 * (law == law[0]), 64, 1)
    figure = samples.tornado("y")
    figure.draw_without_rendering()
    (place,) = figure.axes
    frame, extents = place.get_window_extent(), [text.get_window_extent() for text in place.texts if text.get_text()]
    assert len(extents) == 4
    assert all(frame.x0 <= extent.x0 < extent.x1 <= frame.x1 for extent in extents), extents


def test_chance_is_told_from_the_inputs():
    noise = 0.3 * np.random.default_rng(3).standard_normal(128)
    samples = sample(ANGLES[:2], lambda x1, x2: x1 + 0.0 * x2 + noise, 128, 0)
    made = samples.surrogate("y")
    assert made.noise == pytest.approx(0.3, rel=0.25)
    assert made.rmse == pytest.approx(0.3, rel=0.3)
    assert made.q2 == pytest.approx(1.0 - 0.09 / (np.pi**2 / 3 + 0.09), abs=0.02)


def test_refusals():
    noise = np.random.default_rng(0).standard_normal(32)
    samples = sample(ANGLES[:2], lambda x1, x2: noise, 32, 0)
    with pytest.raises(StudyError, match=r"y: no indices, since its surrogate predicts .* of the variance"):
        samples.indices("y")
    assert samples.scatter("y").axes
    with pytest.raises(StudyError, match="the same in every row"):
        sample(ANGLES, lambda *_: np.ones(16), 16, 0).surrogate("y")
    with pytest.raises(StudyError, match="3 inputs needs at least 8 rows with a result, and there are 4"):
        sample(ANGLES, ishigami, 4, 0).surrogate("y")


def test_runs_that_are_cut_off_or_not_trusted_are_counted():
    samples = sample(ANGLES[:1], lambda x1: x1, 8, 0)
    assert samples.doubts == []
    samples.table = samples.table.assign(depth_m=1.0, final=["True"] + ["False"] * 2 + ["True"] * 5,
                                         trustworthy=["True"] * 6 + ["False"] * 2)
    poor, cut = samples.doubts
    assert poor.startswith("2 of 8 runs are not trustworthy")
    assert cut.startswith("2 of 8 runs ended at their end time or number of cycles")
    assert cut in list(text.report(samples, shares=False))


def test_a_doubtful_surrogate_says_so():
    noise = np.random.default_rng(5).standard_normal(64)
    found = sample(ANGLES[:1], lambda x1: x1 + 1.1 * noise, 64, 0).indices("y")
    assert sobol.POOR <= found.surrogate.q2 < sobol.FAIR
    assert f"Q2 {found.surrogate.q2:.2f}" in sample(ANGLES[:1], lambda x1: x1 + 1.1 * noise, 64, 0).scatter("y").get_suptitle()
    assert "the indices are rough" in found.doubt


# ------------------------------------------------------------------------------------------------ the process itself


@pytest.fixture(scope="module")
def process():
    """A process through 32 rows, and the logarithms of its numbers."""
    cube = qmc.Sobol(3, seed=1).random(32)
    x = [cube[:, :1], cube[:, 1:2], np.eye(3)[(3 * cube[:, 2]).astype(int)]]
    y = np.sin(5 * cube[:, 0]) + cube[:, 1] * x[2][:, 0]
    theta, _ = gaussian.most_probable(x, y := (y - y.mean()) / y.std())
    return gaussian.Process(x, y, theta), theta


def test_gradient_of_the_misfit(process):
    made, _ = process
    distances = gaussian.squares(made.x, made.x)
    at = gaussian._prior(3)[0] + 0.3 * np.random.default_rng(0).standard_normal(11)
    _, slope = gaussian._misfit(at, distances, made.y)
    for n in range(len(at)):
        step = 1e-5 * np.eye(len(at))[n]
        ends = [gaussian._misfit(at + sign * step, distances, made.y)[0] for sign in (1, -1)]
        assert slope[n] == pytest.approx((ends[0] - ends[1]) / 2e-5, rel=1e-4, abs=1e-5)


def test_leave_one_out_is_that(process):
    made, theta = process
    for row in (0, 17):
        rest = [np.delete(each, row, axis=0) for each in made.x]
        without = gaussian.Process(rest, np.delete(made.y, row), theta)
        predicted = without.mean([each[row : row + 1] for each in made.x])[0]
        assert made.missed()[row] == pytest.approx(made.y[row] - predicted, rel=1e-5, abs=1e-8)


def test_draws_have_the_mean_and_the_variance_of_the_posterior(process):
    made, _ = process
    cube = qmc.Sobol(3, seed=2).random(64)
    points = [cube[:, :1], cube[:, 1:2], np.eye(3)[(3 * cube[:, 2]).astype(int)]]
    found = made.draws(points, 400, np.random.default_rng(0))
    assert np.sqrt(np.mean((found.mean(axis=1) - made.mean(points)) ** 2)) < 0.15 * np.sqrt(made.variance(points).mean())
    assert found.var(axis=1).mean() == pytest.approx(made.variance(points).mean(), rel=0.1)
    at_rows = made.draws(made.x, 10, np.random.default_rng(0))
    assert np.abs(at_rows - made.y[:, None]).max() < 10.0 * np.sqrt(made.numbers.c) + 1e-3


def test_the_same_seed_gives_the_same_bits():
    first, second = (sample(ANGLES, ishigami, 32, 0).surrogate("y") for _ in range(2))
    cube = np.random.default_rng(0).random((50, 3))
    assert np.array_equal(first(cube), second(cube))
    assert np.array_equal(first.draws(cube, 10), second.draws(cube, 10))
    assert not np.array_equal(first.draws(cube, 10), first.draws(cube, 10, seed=1))


# ------------------------------------------------------------------------------------------------ fractions


def test_a_known_probability_is_in_its_interval():
    """A failure of probability 0.1, in nine of ten random samples of 200 points, and its bounds if a tenth of the runs fail."""
    hits = bounds = 0
    for seed in range(10):
        generator = np.random.default_rng(seed)
        strength = generator.random(200)
        table = pandas.DataFrame({"row": np.arange(1.0, 201), "x": strength, "status": "done",
                                  "perforated": np.where(strength < 0.1, "yes", "no")})
        share = Samples("", (), table).fractions("perforated")["yes"].share
        hits += share.low <= 0.1 <= share.high
        table["status"] = np.where(generator.random(200) < 0.1, "failed", "done")
        among = Samples("", (), table).fractions("perforated")["yes"]
        bounds += among.low <= np.mean(strength < 0.1) <= among.high
    assert hits >= 9
    assert bounds == 10


def test_the_smooth_interval_is_wilsons():
    from hydro2d.study.ensemble.chance import wilson, wilson_interval

    for successes, trials in ((0, 8), (3, 8), (8, 8), (10, 200)):
        assert wilson_interval(successes / trials, trials) == pytest.approx(wilson(successes, trials)[3:], abs=1e-12)


def test_coordinates_of_a_choice():
    each = Distribution("law", "choice", levels=("x", "y"), weights=(0.5, 0.5))
    (found,) = surrogates.coordinates([each], np.array([[0.2], [0.9]]))
    assert found.tolist() == [[1.0, 0.0], [0.0, 1.0]]
