"""When a step must end the run, or needs room: these ask Python, which has the words and the memory."""

from hydro2d.jit import control
from hydro2d.kernels.column_ranges import outer_rows
from hydro2d.mesh.grid import GHOSTS
from hydro2d.mesh.sums import HALF


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


@control
def is_time_to_look(w):
    """Asks for a look at the whole state every few cycles."""
    w.asks = 1 if w.cycle % w.looks_every == 0 else 0


@control
def watch_shot(w):
    """Asks for a look at the projectile every few cycles and while its core is at an edge, and at a crater that is leaving.

    Reads    rod_exits [k]; vof [m, j, i]; offset [1]; ejecta [t, 4]; crater_rows [t]; z
    """
    looks = w.cycle % w.looks_every == 0 or w.rod_leaves
    for k in range(w.rod_exits.shape[0]):
        looks = looks or w.vof[w.rod, w.rod_exits[k], GHOSTS] >= HALF
    for target in range(w.crater_rows.shape[0]):
        if w.offset[0] != 0.0:
            z = w.z[GHOSTS] if w.ejecta[target, 0] > 0.0 else w.z[GHOSTS + w.nz]
            depth = w.ejecta[target, 0] * (z - (w.ejecta[target, 1] + w.ejecta[target, 3] * w.reached))
            looks = looks or depth >= w.crater_rows[target]
    w.asks = 1 if looks else 0
