"""When a step must end the run, or needs room: these ask Python, which has the words and the memory."""

from hydro2d.jit import control
from hydro2d.kernels.column_ranges import outer_rows


@control
def count_slots(w):
    """Asks for more slots if there are more contact nodes than slots.

    Reads    first_slot [j]; strength [x, 2]
    """
    _, last = outer_rows(w.parts)
    w.asks = 1 if w.first_slot[last + 1] > w.strength.shape[0] else 0


@control
def judge_cells(w):
    """Asks for help with cells or velocities that are not finite.

    Reads    least_row [3]
    """
    w.asks = 1 if w.least_row[1] >= 0 or w.least_row[2] >= 0 else 0


@control
def is_time_for_zones(w):
    """Whether the zones of a slip layer are found anew in this cycle."""
    w.finds_zones = w.cycle % w.refresh == 0
