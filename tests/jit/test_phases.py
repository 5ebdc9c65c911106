"""Phases as lists: the function made from one does what the list says, part by part, barrier by barrier."""

import numpy as np
import pytest

from hydro2d import jit
from hydro2d.jit import WAIT, Phase, alone, given, unless, when
from hydro2d.jit.phases import When, chosen
from hydro2d.kernels import audit_sums, column_ranges, lagrangian_step, momentum, remap_step, thermodynamics

PHASES = {name: value for module in (lagrangian_step, remap_step) for name, value in vars(module).items()
          if isinstance(value, Phase)}


def text(*steps) -> list[str]:
    """The lines of the function made from some steps."""
    phase = Phase("made", "Made for a test.", *steps)
    kernels = list(dict.fromkeys(run.kernel for run in phase.runs()))
    lines = phase._text(kernels).split("\n")
    return lines[lines.index("    w = as_handle(address)") + 1:-1]


def test_a_list_becomes_a_function():
    assert text(column_ranges.widen_ranges, WAIT, when("travels", alone(thermodynamics.least_step), WAIT),
                unless("dj", given(momentum.deposit, ranges="heated_columns", deficit="heat"))) == [
        "    _0(part, w.body_ranges, w.group_ranges, w.parts)",
        "    wait(w.gate, w.parts)",
        "    if w.travels:",
        "        if part == 0:",
        "            _1(w.bad, w.least_row, w.parts, w.row_step)",
        "        wait(w.gate, w.parts)",
        "    if not w.dj:",
        "        _2(part, w.heated_columns, w.heat, w.cell_mass, w.deposited, w.group, w.metrics, w.parts, w.q, w.vof)",
    ]


def test_arguments_of_a_phase():
    phase = Phase("made", "Made for a test.", when("travels", alone(thermodynamics.least_step)))
    assert phase.takes == {"parts", "gate", "travels", "row_step", "bad", "least_row"}


@pytest.mark.parametrize(("steps", "message"), [
    ((thermodynamics.least_step,), "least_step takes no part: only one part can run it"),
    ((alone(column_ranges.widen_ranges),), "widen_ranges takes a part: it is not for one alone"),
    ((momentum.deposit,), "deposit takes ranges, which is no name"),
    ((given(momentum.deposit, ranges="heated_columns", deficit="nonsense"),), "deposit takes nonsense, which is no name"),
    ((given(momentum.deposit, range="heated_columns"),), "deposit has no parameter range"),
    ((given(momentum.deposit, vof="q"),), "deposit has no parameter vof"),
    ((when("nonsense", WAIT),), "nonsense is no number"),
    ((when("u", WAIT),), "u is no number"),
    ((unless("parts", WAIT),), "parts is no number"),
    (("barrier",), "'barrier' is no step"),
    ((lambda part: None,), "is no kernel"),
    ((audit_sums,), "is no kernel"),
], ids=lambda value: None if isinstance(value, tuple) else value)
def test_lists_that_make_no_sense_are_refused(steps, message):
    with pytest.raises(ValueError, match=message):
        Phase("made", "Made for a test.", *steps)


@pytest.mark.parametrize("name", PHASES)
def test_phases_of_the_step_do_what_their_lists_say(name):
    """Every kernel of the list is in the text, in order, and so is every barrier."""
    phase = PHASES[name]
    kernels = list(dict.fromkeys(run.kernel for run in phase.runs()))
    lines = phase._text(kernels).split("\n")
    called = [line.strip().split("(")[0] for line in lines if line.strip().startswith(("_", "wait"))]

    def flat(steps):
        for step in steps:
            yield from flat(step.steps) if isinstance(step, When) else [step]

    listed = ["wait" if step == WAIT else f"_{kernels.index(step.kernel)}" for step in flat(phase.steps)]
    assert called == listed
    assert phase.__name__ == name
    assert phase.__doc__


def test_phases_run_as_python_what_the_numbers_choose():
    seen = []

    phase = Phase("made", "Made for a test.", column_ranges.widen_ranges, WAIT,
                  when("second", alone(thermodynamics.least_step)), unless("second", column_ranges.find_active_ranges))
    handle = jit.Handle()
    for second in (True, False):
        handle.update(second=second)
        seen.append([step if step == WAIT else step.kernel.__name__ for step in chosen(phase.steps, handle)])
    assert seen == [["widen_ranges", WAIT, "least_step"], ["widen_ranges", WAIT, "find_active_ranges"]]


def test_a_compiled_phase_waits_and_works_in_parts():
    """`find_moving` on two parts: the second kernel, which one part runs, sees what all parts have written."""
    handle = jit.Handle()
    u, v = np.zeros((1, 13, 9)), np.zeros((1, 13, 9))
    u[0, 4, 3], v[0, 9, 6] = 1.0, 2.0
    moving = np.zeros(4, dtype=int)
    handle.update(parts=np.array([2, 6, 10]), i0=2, i1=6, u=u, v=v, row_moving=np.zeros((13, 2), dtype=int), moving=moving,
                gate=np.zeros(jit.GATE, dtype=int), grows=True)
    if jit.parts_at_once() >= 2:
        remap_step.find_moving(handle)
        assert moving.tolist() == [4, 10, 3, 7]
    handle.update(parts=np.array([2, 10]))
    moving[:] = 0
    remap_step.find_moving(handle)
    assert moving.tolist() == [4, 10, 3, 7]
