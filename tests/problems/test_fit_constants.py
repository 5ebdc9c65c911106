"""The fit of two constants to copper bars, as the page has it: its numbers, and made-up lengths whose constants are known."""

import contextlib
import csv
import io
import re

import matplotlib.figure
import numpy as np
import pytest

from tests.rules import source

PAGE = source.ROOT / "docs" / "how-to" / "fit-constants.md"
BARS = source.PROBLEMS / "validation" / "copper_bars.csv"


@pytest.fixture(scope="module")
def fit():
    """The names of the program of the page, and what it prints."""
    text, printed = PAGE.read_text(encoding="utf-8"), io.StringIO()
    (program,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    (shown,) = re.findall(r"```text\n(.*?)```", text, re.DOTALL)
    names: dict = {}
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(printed):
        patch.chdir(source.ROOT)
        patch.setattr(matplotlib.figure.Figure, "savefig", lambda *_, **__: None)
        exec(compile(program, str(PAGE), "exec"), names)
    return names | {"printed": printed.getvalue(), "shown": shown}


def test_the_page_shows_what_its_program_prints(fit):
    def numbers(text):
        return [float(number) for number in re.findall(r"-?\d+\.?\d*", text)]

    assert re.sub(r"[\d.\s]+", " ", fit["printed"]) == re.sub(r"[\d.\s]+", " ", fit["shown"])
    assert numbers(fit["printed"]) == pytest.approx(numbers(fit["shown"]), rel=2e-3)


def test_the_lengths_are_those_of_the_table(fit):
    lines = [line for line in BARS.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    measured = {row["bar"]: float(row["final_length_mm"]) for row in csv.DictReader(lines)}
    assert fit["MEASURED"] | fit["OTHERS"] == measured


def test_intervals_contain_the_constants_of_made_up_lengths(fit):
    """Forty bars of known constants, drawn from the whole sample, with errors of 1 %: 36 of 40 in the mean."""
    generator, names = np.random.default_rng(4), ("yields", "hardenings", "stress")
    stress = fit["yields"] + fit["hardenings"] * 0.3**0.31
    inside = dict.fromkeys(names, 0)
    for _ in range(40):
        true = generator.integers(len(stress))
        measured = {bar: fit["computed"][bar][true] * (1.0 + 0.01 * generator.standard_normal()) for bar in fit["MEASURED"]}
        weights = fit["posterior"](measured).sum(axis=1)
        for name, values in zip(names, (fit["yields"], fit["hardenings"], stress), strict=True):
            low, _, high = fit["interval"](values, weights)
            inside[name] += low <= values[true] <= high
    assert all(32 <= number <= 39 for number in inside.values()), inside
