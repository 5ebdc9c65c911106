"""Bias and scatter of ratios of computed to measured values."""

import math

import numpy as np
import pytest

import hydro2d


def made_up(bias, scatter, count, seed=1):
    """Ratios whose logarithms have exactly this mean and sample standard deviation."""
    logs = np.random.default_rng(seed).normal(size=count)
    logs = (logs - logs.mean()) / logs.std(ddof=1)
    return np.exp(math.log(bias) + scatter * logs)


@pytest.mark.parametrize(("bias", "scatter", "count"), [(0.97, 0.13, 21), (1.5, 0.4, 3), (1.0, 0.02, 2)])
def test_made_up_ratios_give_back_their_bias_and_scatter(bias, scatter, count):
    ratios = made_up(bias, scatter, count)
    found = hydro2d.bias_and_scatter(ratios)
    assert (found.bias, found.scatter) == pytest.approx((bias, scatter), rel=1e-12)
    assert (found.least, found.most, found.count) == (min(ratios), max(ratios), count)
    assert found.model is None


def test_the_bias_of_ratios_turned_round_is_turned_round():
    found, turned = (hydro2d.bias_and_scatter(ratios) for ratios in ((0.8, 1.1, 1.3), (1 / 0.8, 1 / 1.1, 1 / 1.3)))
    assert (turned.bias, turned.low, turned.high) == pytest.approx((1 / found.bias, 1 / found.high, 1 / found.low))
    assert turned.scatter == pytest.approx(found.scatter)


def test_the_interval_is_students():
    """With three values t is 2.920 at 90 % and 4.303 at 95 %, by tables, and the error of the mean the scatter over root 3."""
    ratios = made_up(1.1, 0.3, 3)
    for level, t in ((0.90, 2.920), (0.95, 4.303)):
        found = hydro2d.bias_and_scatter(ratios, level=level)
        assert math.log(found.high / found.bias) == pytest.approx(t * 0.3 / math.sqrt(3.0), rel=2e-4)
        assert math.log(found.bias / found.low) == pytest.approx(t * 0.3 / math.sqrt(3.0), rel=2e-4)


def test_intervals_cover_the_bias_and_another_shot_as_often_as_they_say():
    random = np.random.default_rng(2)
    covered, within = 0, 0
    for _ in range(1000):
        *ratios, another = np.exp(math.log(0.9) + 0.2 * random.normal(size=5))
        found = hydro2d.bias_and_scatter(ratios)
        covered += found.low <= 0.9 <= found.high
        within += 1.0 / found.factor <= another / found.bias <= found.factor
    for number in (covered, within):
        share = hydro2d.wilson(number, 1000, 0.999)
        assert share.low < 0.9 < share.high


def test_the_scatter_of_the_model_alone():
    """5 % of the measurements and 12 % of the model make 13 % together."""
    ratios = made_up(1.0, 0.13, 8)
    assert hydro2d.bias_and_scatter(ratios, 0.05).model == pytest.approx(0.12)
    assert hydro2d.bias_and_scatter(ratios, 0.0).model == pytest.approx(0.13)
    assert hydro2d.bias_and_scatter(ratios, 0.14).model is None


def test_one_ratio_has_no_scatter():
    assert hydro2d.bias_and_scatter([1.07], 0.05) == (pytest.approx(1.07), *[None] * 5, 1.07, 1.07, 1)


@pytest.mark.parametrize("ratios", [[], [1.0, 0.0], [1.0, -2.0], [math.nan], [math.inf, 1.0]])
def test_other_ratios_are_refused(ratios):
    with pytest.raises(ValueError, match="positive numbers are needed"):
        hydro2d.bias_and_scatter(ratios)


def test_an_impossible_error_is_refused():
    with pytest.raises(ValueError, match="must be non-negative"):
        hydro2d.bias_and_scatter([1.0, 1.1], -0.1)
