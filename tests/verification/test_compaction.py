"""Two-wave compaction of porous aluminium against the jump conditions, with the pores closed in full and in part."""

import numpy as np
import pytest

from hydro2d.deck import deck as decks
from hydro2d.mesh.fields import INTERNAL
from tests.exact.compaction import Porous
from tests.verification.running import FOLDER, Line, advection, between, crossing, finish, speed

POROUS = Porous(rho0=2117.647, rho_s=2700.0, c_e=4110.0, p_e=0.08e9, p_s=0.70e9, c0=5350.0, s=1.34, gamma=2.0)


def test_the_exact_solution_is_that_of_jutzi_and_others():
    """Their Tillotson aluminium behind both waves: Us 891.5, 1006.1, 1982.9 m/s, p 0.2500, 0.4837, 1.960 GPa, and densities."""
    for piston, expected in ((100.0, (891.5, 0.2500e9, 2366.0)), (200.0, (1006.1, 0.4837e9, 2625.0)),
                             (458.0, (1982.9, 1.960e9, 2747.1))):
        assert POROUS.behind(piston).speed == pytest.approx(expected[0], rel=3e-3)
        assert (POROUS.behind(piston).p, POROUS.behind(piston).rho) == pytest.approx(expected[1:], rel=3e-3)


@pytest.mark.parametrize("velocity", [100.0, 200.0, 458.0])
def test_both_waves(velocity):
    """Pressure, density, velocity and speed of both waves within 1 %, the distention on the crush curve."""
    track = []

    def watch(simulation):
        if simulation.time > 0.4 * simulation.deck.stop.time:
            line = Line(simulation)
            pressure = line.pressure
            track.append((simulation.time, crossing(line.x, pressure, 0.5 * (first.p + second.p)),
                          crossing(line.x, pressure, 0.5 * first.p)))

    first, second = POROUS.precursor(), POROUS.behind(velocity)
    simulation = finish(decks.load(f"{FOLDER}/porous_compaction.toml",
                                   [f"body.block.velocity=-{velocity}", advection("both")]), watch)
    line, time = Line(simulation), simulation.time
    distention = simulation.grid.interior(simulation.state.q[INTERNAL, 0])[:, 2]
    times, shock, precursor = np.array(track).T
    for state, ends, found in ((second, (0.0, second.speed - velocity), shock),
                               (first, (second.speed - velocity, first.speed - velocity), precursor)):
        cells, vertices = (between(x, ends[0] * time, ends[1] * time) for x in (line.x, line.xv))
        assert line.pressure[cells].mean() == pytest.approx(state.p, rel=1e-2)
        assert line.body("rho", 0)[cells].mean() == pytest.approx(state.rho, rel=1e-3)
        assert line.velocity[vertices].mean() + velocity == pytest.approx(state.u, rel=1e-2)
        assert speed(times, found) + velocity == pytest.approx(state.speed, rel=1e-2)
        if state is second:
            assert distention[cells].mean() == pytest.approx(state.alpha, abs=2e-3)
            heat = 1e-2 if velocity == 458.0 else 3e-2  # a slow wave heats what it crushes first, see the page
            assert line.body("e", 0)[cells].mean() == pytest.approx(state.e, rel=heat)
    assert abs(simulation.conservation()["total_energy"]) < 1e-12
