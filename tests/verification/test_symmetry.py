"""Mirrored problems have mirrored answers, and the order of the bodies in a deck has no effect on the physics."""

import numpy as np
import pytest

from hydro2d.deck import deck
from hydro2d.solver.simulation import Simulation
from tests.decks import box, mesh, rod, stop, table
from tests.verification.running import to_the_end


def bodies(sign: int) -> dict[str, str]:
    """A rod on a plate with a cover, flying to +z, or to -z with sign -1."""
    def between(low: float, high: float) -> list[str]:
        return [f"{low} mm", f"{high} mm"] if sign > 0 else [f"{-high} mm", f"{-low} mm"]

    return {
        "rod": rod("2.7 mm", "6 mm", tip=f"{0.2 * sign} mm", direction=sign, velocity=f"{1200 * sign} m/s"),
        "plate": box("plate", "Al7039", z=between(0.3, 5)),
        "cover": box("cover", "Al5083", z=between(5, 6.3)),
    }


def impact(order=("rod", "plate", "cover"), sign=1, geometry="cylindrical", options=(), **numerics) -> Simulation:
    """The bodies, in an order, before the first cycle; z is mirrored with sign -1."""
    text = (
        mesh([{"to": "6 mm", "cells": 12}, {"cells": 4, "ratio": 1.1}], [{"cells": 32, "size": 0.00048828125}],
             geometry=geometry, z_start=-0.0078125)
        + "".join(bodies(sign)[name] for name in order)
        + table("failure", damage="material")
        + table("numerics", advection="ke", **numerics)
        + stop("1 s", cycles=40)
    )
    return Simulation(deck.loads(text, options))


SLIP = 'sliding.method="slip-layer"', 'sliding.hard=["rod"]', "sliding.yield_factor=1.5"
CASES = {
    "ke": (),
    "both": ('numerics.advection="both"',),
    "steepness": ("numerics.steepness=1.0",),
    "material": ('numerics.mixed_strength="material"',),
    "solid": ('numerics.mixed_strength="solid"', 'numerics.mixed_cell="uniform"'),
    "slip-layer": SLIP,
    "friction": (*SLIP, 'sliding.shear="shear"', "sliding.friction=0.1"),
}
BODY_FIELDS = ("vof", "rho", "e", "srr", "szz", "srz", "ep", "dmg")


def inside(simulation: Simulation, name: str) -> np.ndarray:
    grid, array = simulation.grid, getattr(simulation.state, name)
    return grid.interior_vertices(array[0]) if name in ("u", "v") else grid.interior(array)


def take_mirror_image(down: Simulation, up: Simulation) -> None:
    """Gives a simulation the mirrored bits of the other, which insertion rounds differently."""
    for name in (*BODY_FIELDS, "centroid_r", "centroid_z"):
        inside(down, name)[...] = (-1.0 if name in ("srz", "centroid_z") else 1.0) * inside(up, name)[..., ::-1, :]
    for name, sign in (("u", 1.0), ("v", -1.0)):
        here, there = (one.grid.interior_vertices(getattr(one.state, name)) for one in (down, up))
        here[...] = sign * there[..., ::-1, :]
    down.engine.audit = None
    down.engine.prepare()


@pytest.mark.parametrize("geometry", ["cylindrical", "planar"])
@pytest.mark.parametrize("options", CASES.values(), ids=CASES)
def test_mirrored_in_z(geometry, options):
    """From mirrored bits, on a mesh whose edges are mirrored bits, the mirrored problem has mirrored bits."""
    up, down = (impact(sign=sign, geometry=geometry, options=options) for sign in (1, -1))
    for name in (*BODY_FIELDS, "u", "v"):
        sign = -1.0 if name in ("srz", "v") else 1.0
        mirrored = sign * inside(up, name)[..., ::-1, :]
        np.testing.assert_allclose(inside(down, name), mirrored, rtol=1e-13, atol=1e-12, err_msg=name)
    take_mirror_image(down, up)
    to_the_end(up), to_the_end(down)
    assert inside(up, "ep").max() > 0.2
    assert up.time == down.time
    for name in (*BODY_FIELDS, "u", "v"):
        sign = -1.0 if name in ("srz", "v") else 1.0
        mine, other = inside(down, name), sign * inside(up, name)[..., ::-1, :]
        if "sliding.friction=0.1" in options:  # the distance to a mirrored surface is rounded differently
            np.testing.assert_allclose(mine, other, rtol=1e-12, atol=1e-12 * np.abs(other).max(), err_msg=name)
        else:
            np.testing.assert_array_equal(mine, other, err_msg=name)


PULSE = '[["0 us", 0], ["0.3 us", "1 GPa"], ["1 us", "-100 MPa"]]'
#: edges at the rim and behind the cover: the word of each, and other keys by what follows the name of the edge
EDGES = {
    "held": ("held", "held", {}),
    "held and moved along z": ("held", "outflow", {"r_max_axial": "{sign}20 m/s"}),
    "held and moved along r": ("outflow", "held", {"{far}_radial": "20 m/s"}),
    "pressure behind": ("transmit", "pressure", {"{far}_pressure": PULSE}),
    "pressure around": ("pressure", "transmit", {"r_max_pressure": "500 MPa"}),
    "held at a pressure": ("held", "pressure", {"{far}_pressure": "-50 MPa"}),
}


def at_edges(case: str, sign: int) -> list[str]:
    """Options for edges, with a cover that goes on beyond the mesh."""
    (rim, behind, keys), far = EDGES[case], "z_max" if sign > 0 else "z_min"
    named = {key.format(far=far): value if value == PULSE else value.format(sign="" if sign > 0 else "-")
             for key, value in keys.items()}
    ends = '["5 mm", "1 m"]' if sign > 0 else '["-1 m", "-5 mm"]'
    return [f'boundaries.r_max="{rim}"', f'boundaries.{far}="{behind}"', f"body.cover.z={ends}",
            *(f"boundaries.{key}={value}" for key, value in named.items())]


@pytest.mark.parametrize("geometry", ["cylindrical", "planar"])
@pytest.mark.parametrize("case", EDGES)
def test_mirrored_edges(case, geometry):
    """Held edges, edges with a pressure and edges that transmit: from mirrored bits, mirrored bits, and the audit closes."""
    up, down = (impact(sign=sign, geometry=geometry, options=at_edges(case, sign)) for sign in (1, -1))
    take_mirror_image(down, up)
    to_the_end(up), to_the_end(down)
    for name in (*BODY_FIELDS, "u", "v"):
        sign = -1.0 if name in ("srz", "v") else 1.0
        np.testing.assert_array_equal(inside(down, name), sign * inside(up, name)[..., ::-1, :], err_msg=name)
    balance = up.conservation()
    assert max(map(abs, (*balance["mass"].values(), balance["axial_momentum"], balance["total_energy"]))) < 1e-12


CONTACT = ('sliding.method="contact"', 'sliding.hard=["rod"]', 'sliding.yield_factor="off"', "stop.cycles=320")


@pytest.mark.xfail(reason="1.9e-7 m/s in 320 cycles, at a crumb of 1e-5 of a cell, where 1e-7 are wanted")
def test_contact_of_mirror_images():
    """Round-off of 1e-15 grows to less than 1e-7 m/s in 320 cycles, since nothing is decided by it."""
    up, down = (impact(sign=sign, options=CONTACT) for sign in (1, -1))
    take_mirror_image(down, up)
    to_the_end(up), to_the_end(down)
    mass = up.grid.interior_vertices(up.state.mass)
    apart = max(np.abs(np.where(mass > 1e-6 * mass.max(), x - sign * y[:, ::-1], 0.0)).max()
                for sign, x, y in ((1.0, *(up.grid.interior_vertices(one.state.u) for one in (up, down))),
                                   (-1.0, *(up.grid.interior_vertices(one.state.v) for one in (up, down)))))
    assert 0.0 < apart < 1e-7


def compared(first: Simulation, second: Simulation, order: list[int]) -> dict[str, float]:
    """Largest difference of the fields visible from outside, relative to their largest value."""
    assert [second.table.names[m] for m in order] == list(first.table.names)
    result = {}
    for name in ("vof", "rho", "e", "srr", "srz", "ep"):
        a, b = inside(first, name), inside(second, name)[order]
        weight = inside(first, "vof") + inside(second, "vof")[order]  # next to no material may have any value
        result[name] = float(np.sum(weight * np.abs(a - b)) / np.sum(weight * np.abs(a)))
    for name in ("u", "v"):
        a, b = inside(first, name), inside(second, name)
        result[name] = float(np.sum(np.abs(a - b)) / np.sum(np.abs(a)))
    return result


@pytest.mark.parametrize("options", CASES.values(), ids=CASES)
def test_order_of_the_bodies_in_the_deck(options):
    """With a stated nesting of interfaces, the order in which a deck lists its bodies changes nothing."""
    order = ["rod", "plate", "cover"]
    first = to_the_end(impact(options=options, interface_order=order))
    second = to_the_end(impact(("cover", "rod", "plate"), options=options, interface_order=order))
    assert max(compared(first, second, [1, 2, 0]).values()) < 1e-12


def test_nesting_changes_little():
    """The order of the interfaces is a choice of the method; it matters where three materials meet."""
    first = to_the_end(impact())
    second = to_the_end(impact(("cover", "plate", "rod")))
    difference = compared(first, second, [2, 1, 0])
    assert difference["vof"] < 0.01
    assert difference["v"] < 0.03
    assert second.mean_velocity(2) == pytest.approx(first.mean_velocity(0), rel=5e-3)
