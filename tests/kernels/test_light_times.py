"""Light times: Kenamond's problems, a detonation point, several of them, and an inert obstacle in the way; and a slab.

The exact answers are shortest paths: straight where the point is seen, else along tangents and the surface of the obstacle.
"""

import numpy as np
import pytest

from hydro2d.kernels.light_times import bend_around, light_points
from tests.kernels.cells import handle

POINT = (0.0, -6.0)
SPEED = 8.0


def arrival(points, n, inert=None):
    """(r [1, i], z [j, 1], times, share of explosive) on 0 < r < 8, -8 < z < 8 of n by 2 n cells.

    inert(r, z) : where the obstacle is
    """
    r_edges, z_edges = np.linspace(0.0, 8.0, n + 1), np.linspace(-8.0, 8.0, 2 * n + 1)
    share = np.ones((2 * n, n))
    if inert is not None:
        fine, size = 16, 0.5 * 8.0 / (16 * n)
        r, z = np.linspace(size, 8.0 - size, fine * n), np.linspace(size - 8.0, 8.0 - size, 2 * fine * n)
        share = 1.0 - inert(r[None, :], z[:, None]).reshape(2 * n, fine, n, fine).mean(axis=(1, 3))
    rc, zc = 0.5 * (r_edges[1:] + r_edges[:-1]), 0.5 * (z_edges[1:] + z_edges[:-1])
    light, front = np.full(share.shape, np.inf), np.zeros((3, *share.shape))
    names = handle(points=np.array(points, dtype=float), speed=SPEED, r=r_edges, z=z_edges, rc=rc, zc=zc, share=share,
                   light=light, front=front)
    light_points(names)
    while bend_around(names):
        pass
    return rc[None, :], zc[:, None], light, share


def around_a_disc(r, z, radius):
    """Shortest path from POINT to (r, z) around a disc at the origin: two tangents and an arc, or straight."""
    a, b = np.hypot(*POINT), np.hypot(r, z)
    angle = np.arccos(np.clip((r * POINT[0] + z * POINT[1]) / (a * b), -1.0, 1.0))
    arc = angle - np.arccos(radius / a) - np.arccos(np.minimum(radius / b, 1.0))
    tangents = np.sqrt(a * a - radius**2) + np.sqrt(np.maximum(b * b - radius**2, 0.0))
    return np.where(arc > 0.0, tangents + radius * arc, np.hypot(r - POINT[0], z - POINT[1]))


def around_a_slab(r, z):
    """Shortest path from POINT around the slab r < 4, 0 < z < 1: by its corners (4, 0) and (4, 1)."""

    def clear(r0, z0, levels):
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.all([(z <= level) | (r0 + (level - z0) / (z - z0) * (r - r0) >= 4.0) for level in levels], axis=0)

    straight = np.where(clear(*POINT, (0.0, 1.0)), np.hypot(r - POINT[0], z - POINT[1]), np.inf)
    first = np.hypot(4.0, 6.0)
    by_one = first + np.where((z >= 0.0) & (r >= 4.0), np.hypot(r - 4.0, z), np.inf)
    by_two = first + 1.0 + np.where(z >= 1.0, np.hypot(r - 4.0, z - 1.0), np.inf)
    return np.minimum(np.minimum(straight, by_one), by_two)


def test_one_point_is_exact():
    r, z, light, _ = arrival([(*POINT, 0.25)], 40)
    np.testing.assert_allclose(light, 0.25 + np.hypot(r - POINT[0], z - POINT[1]) / SPEED, rtol=1e-14)


def test_several_points_and_times_are_exact():
    points = (0.0, -6.0, 0.0), (3.0, 2.0, 0.4), (8.0, 8.0, 0.1), (5.0, 2.0, 99.0)
    r, z, light, _ = arrival(points, 40)
    expected = np.min([time + np.hypot(r - r0, z - z0) / SPEED for r0, z0, time in points], axis=0)
    np.testing.assert_allclose(light, expected, rtol=1e-14)


@pytest.mark.parametrize(("inert", "exact", "largest"), [
    (lambda r, z: r**2 + z**2 < 9.0, lambda r, z: around_a_disc(r, z, 3.0), 0.16),
    (lambda r, z: (r < 4.0) & (z > 0.0) & (z < 1.0), around_a_slab, 0.08),
], ids=["disc", "slab"])
def test_around_an_obstacle_of_first_order(inert, exact, largest):
    """Never early; to round-off where the point is seen; behind the obstacle late by less than a cell and a half."""
    means = []
    for n in (40, 80, 160):
        r, z, light, share = arrival([(*POINT, 0.0)], n, inert)
        whole, expected = share == 1.0, exact(r, z)
        assert np.isfinite(light[whole]).all()
        error = light[whole] * SPEED - expected[whole]
        assert error.min() > -1e-12
        assert error.max() < largest * 80 / n
        direct = (np.abs(expected - np.hypot(r - POINT[0], z - POINT[1])) < 1e-9)[whole]
        assert np.quantile(error[direct], 0.95) < 1e-12
        means.append(error.mean())
    assert means[2] < 6e-3
    assert np.log2(means[0] / means[2]) / 2.0 > 0.95


def test_corners_that_touch_let_nothing_through():
    """Two quarters of explosive that touch at one corner."""
    _, _, light, share = arrival([(*POINT, 0.0)], 20, lambda r, z: (r < 4.0) == (z > 0.0))
    assert np.isfinite(light[:20, :10]).sum() == 200
    assert np.isinf(light[20:, 10:]).all()
