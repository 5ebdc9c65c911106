"""Volumes of inserted bodies, and the state at time zero."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hydro2d.deck import deck
from hydro2d.deck.shapes.outlines import rectangle
from hydro2d.deck.shapes.polygon import polygon_outline
from hydro2d.deck.shapes.rod import rod_outline
from hydro2d.deck.shapes.sphere import sphere_outline
from hydro2d.materials import library, starts
from hydro2d.mesh.grid import Grid
from hydro2d.noses.registry import shaped
from hydro2d.running.check import check
from hydro2d.solver import insertion
from hydro2d.solver.simulation import Simulation
from tests.decks import mesh, plate, rod, stop

R_EDGES = np.concatenate([np.linspace(0, 0.012, 37), 0.012 + np.cumsum(0.0004 * 1.1 ** np.arange(12))])
Z_EDGES = np.linspace(-0.021, 0.0307, 97)
FLAT_EDGES = np.linspace(-0.0201, 0.0213, 83)


def volume(outlines, r=R_EDGES, z=Z_EDGES, cylindrical=True):
    """Volumes (full circumference, or per depth) of the outlines."""
    grid = Grid(r, z, "cylindrical" if cylindrical else "planar")
    vof = insertion.fractions(outlines, r, z, cylindrical)
    assert vof.min() >= 0.0
    assert vof.sum(axis=0).max() <= 1.0
    around = 2 * math.pi if cylindrical else 1.0
    return around * (vof * grid.interior(grid.volume)).sum(axis=(1, 2))


def rod_shape(nose, nose_length, direction=1, radius=0.0041, length=0.02, tip=0.0061):
    given = {"nose_length": nose_length} if nose in ("ogival", "conical") else {}
    given |= {"edge_radius": nose_length} if nose == "flat-rounded" else {}
    return rod_outline(shaped(nose, radius, given), length, tip, direction)


def ogive_volume(radius, length):
    """Volume of a tangent ogive nose: pi times the integral of (sqrt(rho^2 - x^2) + R - rho)^2 from 0 to its length."""
    rho = (length**2 + radius**2) / (2 * radius)
    a = radius - rho
    arc = 0.5 * (length * math.sqrt(rho**2 - length**2) + rho**2 * math.asin(length / rho))
    return math.pi * ((rho**2 + a**2) * length - length**3 / 3 + 2 * a * arc)


R, L = 0.0041, 0.02
SHANK = math.pi * R**2


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize(
    ("nose", "nose_length", "expected"),
    [
        ("flat", 0.0, SHANK * L),
        ("hemispherical", R, SHANK * (L - R) + 2 / 3 * math.pi * R**3),
        ("ogival", 3 * R, SHANK * (L - 3 * R) + ogive_volume(R, 3 * R)),
        ("conical", 2 * R, SHANK * (L - 2 * R) + SHANK * 2 * R / 3),
        # Pappus: a quarter disc of radius R/4 has its centroid at 4/(3 pi) of it from the corner
        ("flat-rounded", R / 4, SHANK * (L - R / 4) + math.pi * (0.75 * R) ** 2 * R / 4
         + 2 * math.pi * (0.75 * R + R / (3 * math.pi)) * math.pi * (R / 4) ** 2 / 4),
    ],
)
def test_rods(nose, nose_length, expected, direction):
    outline = rod_shape(nose, nose_length, direction, tip=0.0061 * direction)
    assert volume([outline])[0] == pytest.approx(expected, rel=1e-13)


def test_an_ogive_of_the_length_of_its_radius_is_a_hemisphere():
    assert rod_shape("ogival", R) == rod_shape("hemispherical", R)


@pytest.mark.parametrize(
    ("outline", "expected"),
    [
        (sphere_outline(0.0, 0.001, 0.0083), 4 / 3 * math.pi * 0.0083**3),
        (sphere_outline(0.0, 0.001, 0.0083, 0.0051), 4 / 3 * math.pi * (0.0083**3 - 0.0051**3)),
        (sphere_outline(0.0091, 0.001, 0.003), 2 * math.pi**2 * 0.0091 * 0.003**2),
        (sphere_outline(0.0091, 0.001, 0.003, 0.002), 2 * math.pi**2 * 0.0091 * (0.003**2 - 0.002**2)),
        (rectangle((0.0013, 0.0057), (-0.0023, 0.0101)), math.pi * (0.0057**2 - 0.0013**2) * 0.0124),
        (polygon_outline([(0.0, 0.0), (0.009, 0.0), (0.0, 0.012)]), math.pi * 0.009**2 * 0.012 / 3),
        (
            polygon_outline([(0.002, -0.004), (0.01, 0.001), (0.006, 0.002), (0.008, 0.009), (0.003, 0.004)]),
            None,
        ),
    ],
)
def test_other_shapes(outline, expected):
    if expected is None:  # by Green's theorem: V = 2 pi times the moment of area
        p = [(0.002, -0.004), (0.01, 0.001), (0.006, 0.002), (0.008, 0.009), (0.003, 0.004)]
        moment = sum(
            (r1 + r2) * (r1 * z2 - r2 * z1) / 6 for (r1, z1), (r2, z2) in zip(p, p[1:] + p[:1], strict=True)
        )
        expected = 2 * math.pi * abs(moment)
    assert volume([outline])[0] == pytest.approx(expected, rel=1e-13)


def test_planar_shapes():
    circle = sphere_outline(0.0011, 0.0007, 0.0093)
    assert volume([circle], r=FLAT_EDGES, cylindrical=False)[0] == pytest.approx(math.pi * 0.0093**2, rel=1e-13)
    flat_rod = rod_shape("hemispherical", R)
    area = 2 * R * (L - R) + math.pi * R**2 / 2
    assert volume([flat_rod], r=FLAT_EDGES, cylindrical=False)[0] == pytest.approx(area, rel=1e-13)


def test_the_rod_of_the_study():
    """62.94 g at 18160 kg/m^3 with a hemisphere, 63.02 g with an ogive of 2.5 calibers on 101.346 mm."""
    d = deck.load("problems/cth_nose_shape/hemi_5083_1086.toml")
    r, z = deck.edges(d)
    hemi = rod_shape("hemispherical", 0.0033784, radius=0.0033784, length=0.09779, tip=0.0)
    ogive = rod_shape("ogival", 3 * 0.0033784, radius=0.0033784, length=0.101346, tip=0.0)
    assert 18160 * volume([hemi], r, z)[0] == pytest.approx(0.06294, abs=5e-6)
    assert 18160 * volume([ogive], r, z)[0] == pytest.approx(0.06302, abs=5e-6)


def test_full_and_empty_cells_are_exact():
    vof = insertion.fractions([rod_shape("hemispherical", R)], R_EDGES, Z_EDGES, True)[0]
    inside = (R_EDGES[1:] < R)[None, :] & ((Z_EDGES[:-1] > 0.0061 - L) & (Z_EDGES[1:] < 0.0061 - R))[:, None]
    assert inside.any()
    assert np.all(vof[inside] == 1.0)
    assert np.all(vof[:, R_EDGES[:-1] > R] == 0.0)
    assert np.all(vof[Z_EDGES[:-1] > 0.0061] == 0.0)


def test_faces_on_the_mesh_cut_no_cells():
    """A body whose surface lies on faces, up to the round-off of the decimals in the deck, makes no mixed cell."""
    r, z = 0.0005 * np.arange(21), -0.02 + 0.0005 * np.arange(81)
    vof = insertion.fractions([rectangle((0.0015, 0.0045), (-0.0125, 0.0105))], r, z, True)
    assert set(np.unique(vof)) == {0.0, 1.0}


def test_earlier_bodies_have_the_place():
    ball, plate = sphere_outline(0.0, 0.002, 0.0072), rectangle((0.0, math.inf), (0.0, 0.015))
    alone, below = volume([ball, plate]), volume([plate, ball])
    edge = R_EDGES[-1]
    full = 4 / 3 * math.pi * 0.0072**3
    cap = math.pi * (0.0072 - 0.002) ** 2 * (3 * 0.0072 - (0.0072 - 0.002)) / 3  # the ball below z = 0
    slab = math.pi * edge**2 * 0.015
    assert alone == pytest.approx([full, slab - (full - cap)], rel=1e-13)
    assert below == pytest.approx([slab, cap], rel=1e-12)


def test_curves_that_cross_inside_cells_are_shared_exactly():
    """Two overlapping balls: the lens belongs to the first."""
    a, b, d = 0.006, 0.005, 0.004
    first, second = sphere_outline(0.0, 0.0, a), sphere_outline(0.0, d, b)
    lens = math.pi * (a + b - d) ** 2 * (d**2 + 2 * d * (a + b) - 3 * (a - b) ** 2) / (12 * d)
    volumes = volume([first, second])
    assert volumes == pytest.approx([4 / 3 * math.pi * a**3, 4 / 3 * math.pi * b**3 - lens], rel=1e-12)


def test_bodies_are_cut_by_the_mesh():
    ball = sphere_outline(0.0, Z_EDGES[-1], 0.006)
    assert volume([ball])[0] == pytest.approx(2 / 3 * math.pi * 0.006**3, rel=1e-13)


@settings(max_examples=25)
@given(
    st.floats(0.001, 0.011), st.floats(-0.008, 0.015), st.integers(1, 40), st.integers(1, 40), st.floats(0.001, 0.02)
)
def test_the_volume_of_a_ball_does_not_depend_on_the_mesh(radius, centre, nr, nz, height):
    r, z = np.linspace(0, 0.012, nr + 1), np.linspace(-0.02, 0.01 + height, nz + 1)
    top = max(min(z[-1] - centre, radius), -radius)
    expected = math.pi * (radius**2 * (top + radius) - (top**3 + radius**3) / 3)
    computed = volume([sphere_outline(0.0, centre, radius)], r, z)[0]
    assert computed == pytest.approx(expected, rel=1e-11, abs=1e-11 * radius**3)


@pytest.mark.parametrize("cylindrical", [True, False])
def test_cells_contain_the_sum_of_their_parts(cylindrical):
    """Shares of cells equal those of cells cut in three by three, whose edges the curves cross elsewhere."""
    outlines = [rod_shape("ogival", 2.2 * R, tip=0.004), rod_shape("conical", R, -1, tip=-0.012),
                sphere_outline(3e-3, 2e-3, 6.1e-3)]
    r, z = np.linspace(0, 0.012, 8), np.linspace(-0.02, 0.02, 12)
    fine_r, fine_z = np.linspace(0, 0.012, 22), np.linspace(-0.02, 0.02, 34)
    coarse, fine = (insertion.fractions(outlines, *edges, cylindrical) for edges in ((r, z), (fine_r, fine_z)))
    area = np.diff(fine_r**2 if cylindrical else fine_r)
    parts = (fine * area).reshape(3, 11, 3, 7, 3).sum(axis=(2, 4)) / (3 * area.reshape(7, 3).sum(axis=1))
    assert np.abs(coarse - parts).max() < 1e-13
    assert (coarse > 0).all(axis=0).any()


def test_fractions_agree_with_sampling():
    """Share of each cell by a fine midpoint rule in (r^2/2, z)."""
    r, z = np.linspace(0, 0.01, 6), np.linspace(-0.006, 0.008, 6)
    outlines = [rod_shape("ogival", 2.2 * R, tip=0.004), polygon_outline([(0.0, -0.001), (0.0093, 0.002), (0.001, 0.0071)])]
    exact = insertion.fractions(outlines, r, z, True)
    n = 400
    part = (np.arange(n) + 0.5) / n
    for j in range(5):
        for i in range(5):
            rr = np.sqrt(r[i] ** 2 + part * (r[i + 1] ** 2 - r[i] ** 2))
            zz = z[j] + part * (z[j + 1] - z[j])
            occupied = np.zeros((n, n), dtype=bool)
            for m, outline in enumerate(outlines):
                inside = np.zeros((n, n), dtype=bool)
                for slab in outline.slabs:
                    rows = (zz >= slab.low) & (zz <= slab.high)
                    low = np.array([slab.inner.r(x) for x in zz])
                    high = np.array([slab.outer.r(x) for x in zz])
                    inside |= rows[:, None] & (rr[None, :] >= low[:, None]) & (rr[None, :] <= high[:, None])
                assert exact[m, j, i] == pytest.approx((inside & ~occupied).mean(), abs=5e-3)
                occupied |= inside


# -------------------------------------------------------------------------------------------------------- centroids


@pytest.mark.parametrize("cylindrical", [True, False])
def test_the_centroid_of_a_box_in_each_cell_is_the_middle_of_its_part_there(cylindrical):
    """Along r^2/2 (planar: r) and z, off the middle of the cell, in cells; a moment is that times the share."""
    r, z = np.array([0.001, 0.002, 0.004, 0.005]), np.array([-0.002, 0.0, 0.001, 0.004])
    ends_r, ends_z = (0.0013, 0.0043), (-0.0005, 0.0015)
    shares, moments = insertion.shares_and_moments([rectangle(ends_r, ends_z)], r, z, cylindrical)

    def cut(edges, ends):
        """Share of each interval, and the middle of that part."""
        low, high = np.clip(edges[:-1], *ends), np.clip(edges[1:], *ends)
        size = np.diff(edges)
        return (high - low) / size, np.where(high > low, 0.5 * (low + high - edges[:-1] - edges[1:]) / size, 0.0)

    columns, along = cut(0.5 * r**2, [0.5 * end**2 for end in ends_r]) if cylindrical else cut(r, ends_r)
    rows, up = cut(z, ends_z)
    share = rows[:, None] * columns
    np.testing.assert_allclose(shares[0], share, atol=1e-14)
    np.testing.assert_allclose(moments[0, 0], share * along, atol=1e-14)
    np.testing.assert_allclose(moments[1, 0], share * up[:, None], atol=1e-14)
    assert moments[0, 0, 1, 1] == moments[1, 0, 1, 1] == 0.0  # a full cell
    assert np.count_nonzero(np.abs(moments) > 1e-6) == 12


@pytest.mark.parametrize("cylindrical", [True, False])
def test_moments_agree_with_sampling(cylindrical):
    """For a ball, and for a plate that it partly covers, by a fine midpoint rule in (r^2/2, z)."""
    r, z = np.linspace(0.0, 0.01, 6), np.linspace(-0.006, 0.008, 6)
    outlines = [sphere_outline(0.0, 0.001, 0.0063), rectangle((0.0, math.inf), (-0.0031, 0.0043))]
    shares, moments = insertion.shares_and_moments(outlines, r, z, cylindrical)
    part = (np.arange(600) + 0.5) / 600
    for j in range(5):
        for i in range(5):
            a, b = (r[i] ** 2, r[i + 1] ** 2) if cylindrical else (r[i], r[i + 1])
            x = np.sqrt(a + part * (b - a)) if cylindrical else a + part * (b - a)
            y = z[j] + part * (z[j + 1] - z[j])
            ball = x[None, :] ** 2 + (y[:, None] - 0.001) ** 2 < 0.0063**2
            plate = ~ball & ((y > -0.0031) & (y < 0.0043))[:, None]
            for m, inside in enumerate((ball, plate)):
                assert shares[m, j, i] == pytest.approx(inside.mean(), abs=2e-3)
                assert moments[0, m, j, i] == pytest.approx((inside * (part - 0.5)[None, :]).mean(), abs=1e-3)
                assert moments[1, m, j, i] == pytest.approx((inside * (part - 0.5)[:, None]).mean(), abs=1e-3)
    assert (np.abs(moments) > 0.01).any(axis=(2, 3)).all()


@pytest.mark.parametrize("cylindrical", [True, False])
def test_moments_of_cells_are_those_of_their_parts(cylindrical):
    """For cells cut in two by two: to round-off, like the volumes."""
    outlines = [rod_shape("ogival", 2.2 * R, tip=0.004), rod_shape("conical", R, -1, tip=-0.012),
                sphere_outline(3e-3, 2e-3, 6.1e-3)]
    s = np.linspace(0.0, 1.0, 13)  # parts of equal volume
    fine_r, fine_z = 0.012 * (np.sqrt(s) if cylindrical else s), np.linspace(-0.02, 0.02, 23)
    _, moments = insertion.shares_and_moments(outlines, fine_r[::2], fine_z[::2], cylindrical)
    shares, fine = insertion.shares_and_moments(outlines, fine_r, fine_z, cylindrical)

    def together(values):
        return values.reshape(3, 11, 2, 6, 2).sum(axis=(2, 4)) / 4

    sides = np.array([-0.25, 0.25])
    along = together(0.5 * fine[0] + shares * np.tile(sides, 6))
    up = together(0.5 * fine[1] + shares * np.tile(sides, 11)[:, None])
    np.testing.assert_allclose(moments, [along, up], atol=1e-13)
    assert (np.abs(moments) > 0.01).any(axis=(2, 3)).all()


TEXT = (
    mesh(("16 mm", 32), ("-20 mm", "40 mm", 120))
    + rod("4 mm", "16 mm", tip=0.0, velocity="1086 m/s")
    + plate("30 mm")
    + stop("10 us")
)


def start(text, overrides=()):
    d = deck.loads(text, overrides)
    grid, table = Grid(*deck.edges(d), d.mesh.geometry), library.resolve(d)
    return d, grid, table, insertion.initial_state(d, grid, table)


def test_material_at_rest_has_exactly_no_pressure():
    _, grid, table, state = start(TEXT)
    assert state["vof"].shape == state["rho"].shape == state["e"].shape == (2, 120, 32)
    assert state["u_cell"].shape == state["v_cell"].shape == (1, 120, 32)
    for m in range(2):
        assert set(np.unique(state["rho"][m])) == {table.rho0[m]}
        assert set(np.unique(state["e"][m])) == {0.0}
        assert table.evaluate(m, table.rho0[m], 0.0)[0] == 0.0


def test_velocity_is_momentum_over_mass():
    _, grid, table, state = start(TEXT, ["body.rod.velocity=[3.0, 1000.0]", 'body.rod.tip="0.3 mm"'])
    vof, rho = state["vof"], state["rho"]
    mass = (vof * rho).sum(axis=0)
    u, v = state["u_cell"][0], state["v_cell"][0]
    assert v * mass == pytest.approx(vof[0] * rho[0] * 1000.0, rel=1e-12)
    assert u * mass == pytest.approx(vof[0] * rho[0] * 3.0, rel=1e-12)
    assert np.all(v[mass == 0.0] == 0.0)
    pure = (vof[0] == 1.0)
    assert np.all(v[pure] == 1000.0)
    assert ((vof[0] > 0) & (vof[1] > 0)).any()


def test_body_groups_keep_their_momentum_separate():
    d = deck.loads(TEXT, ["body.rod.velocity=[3.0, 1000.0]", 'body.rod.tip="0.3 mm"', "body.plate.velocity=-50"])
    grid, table = Grid(*deck.edges(d), d.mesh.geometry), library.resolve(d)
    state = insertion.initial_state(d, grid, table, np.array([1, 0]))
    rod, plate = state["vof"] > 0
    assert (rod & plate).any()
    for name, of_rest, of_rod in (("u_cell", 0.0, 3.0), ("v_cell", -50.0, 1000.0)):
        assert state[name].shape == (2, 120, 32)
        np.testing.assert_allclose(state[name][0], np.where(plate, of_rest, 0.0), rtol=1e-15)
        np.testing.assert_allclose(state[name][1], np.where(rod, of_rod, 0.0), rtol=1e-15)


def test_insert_is_the_fraction_of_the_initial_state():
    d, grid, table, state = start(TEXT)
    assert np.array_equal(insertion.insert(d, grid, table), state["vof"])


@pytest.mark.parametrize(
    ("key", "value", "which"),
    [("pressure", 2e9, 0), ("pressure", -1e8, 0)],
)
@pytest.mark.parametrize("body", ["rod", "plate"])
def test_pressure_becomes_an_energy(key, value, which, body):
    d, grid, table, state = start(TEXT, [f"body.{body}.{key}={value}"])
    m = table.names.index(body)
    e = state["e"][m].flat[0]
    assert table.evaluate(m, table.rho0[m], e)[which] == pytest.approx(value, rel=1e-9)


@pytest.mark.parametrize("body", ["rod", "plate"])
def test_density_and_temperature_become_an_energy(body):
    density = start(TEXT)[2].rho0[start(TEXT)[2].names.index(body)]
    _, _, table, state = start(TEXT, [f"body.{body}.temperature=500", f"body.{body}.density={density}"])
    m = table.names.index(body)
    assert table.evaluate(m, density, state["e"][m].flat[0])[3] == pytest.approx(500.0, rel=1e-9)


@pytest.mark.parametrize("body", ["rod", "plate"])
def test_a_body_of_a_temperature_alone_bears_no_pressure(body):
    _, _, table, state = start(TEXT, [f"body.{body}.temperature=500"])
    m = table.names.index(body)
    cells = np.nonzero(state["vof"][m] > 0.0)
    rho, e = state["rho"][m][cells][0], state["e"][m][cells][0]
    pressure, _, _, temperature = table.evaluate(m, rho, e)[:4]
    assert temperature == pytest.approx(500.0, rel=1e-9)
    assert abs(pressure) < 1e-9 * table.rho0[m] * 5000.0**2
    assert rho < table.rho0[m]


def test_gas_states():
    _, _, table, state = start(deck_text_of("verification/sod_z.toml"))
    assert table.names == ("gas",)
    left, right = state["rho"][0, 0, 0], state["rho"][0, -1, 0]
    assert (left, right) == (1.0, 0.125)
    assert state["e"][0, 0, 0] == pytest.approx(2.5, rel=1e-12)
    assert state["e"][0, -1, 0] == pytest.approx(2.0, rel=1e-12)
    assert np.all(state["vof"] == 1.0)


def deck_text_of(name):
    return (library.problems_folder() / name).read_text(encoding="utf-8")


def test_a_temperature_without_an_energy_is_an_error():
    text = deck_text_of("verification/noh_spherical.toml").replace("energy = 0.0", "pressure = -1.0")
    d = deck.loads(text)
    table = library.resolve(d)
    assert starts.body_state(d.body[0], table, 0)[1] < 0  # a gas under tension
    cold = SimpleNamespace(name="x", density=1e-3, energy=None, pressure=None, temperature=-5.0)
    with pytest.raises(deck.DeckError, match='body "x": no energy gives a temperature of -5'):
        starts.body_state(cold, table, 0)


def test_centroids_of_the_initial_state_are_moments_over_shares_in_cells_that_a_body_shares():
    d, grid, _, state = start(TEXT, ['body.rod.tip="0.3 mm"'])
    place, vof = state["centroid"], state["vof"]
    shares, moments = insertion.shares_and_moments([body.outline(0.0) for body in d.body], *deck.edges(d), True)
    assert place.shape == (2, 2, 120, 32)
    mixed = (vof > 0.0) & (vof < 1.0)
    np.testing.assert_allclose((place * shares)[:, mixed], moments[:, mixed], atol=1e-15)
    assert not place[:, ~mixed].any()
    assert (np.abs(place[:, mixed]) <= 0.5 * (1.0 - vof[mixed]) + 1e-12).all()
    assert (np.abs(place[0, 0][mixed[0]]) > 0.01).any()
    s, g = Simulation(d).state, grid
    np.testing.assert_array_equal(g.interior(s.centroid), place)


def test_joined_bodies_have_one_centroid_where_they_meet():
    """The plate continues as the rod: in cells that both fill in part that of both together, and none where they fill them."""
    text = TEXT.replace('material = "Al5083"\nshape', 'material = "W_alloy"\njoin = "rod"\ndensity = 17500\nshape')
    d, _, _, state = start(text, ['body.rod.tip="0.75 mm"', 'body.plate.z_front="0.1 mm"'])
    shares, moments = insertion.shares_and_moments([body.outline(0.0) for body in d.body], *deck.edges(d), True)
    total, place = shares.sum(axis=0), state["centroid"][:, 0]
    meet = (shares > 0.0).all(axis=0)
    cut = meet & (total < 1.0 - 1e-9)
    assert cut.any()
    np.testing.assert_allclose(place[:, cut], moments.sum(axis=1)[:, cut] / total[cut], atol=1e-14)
    full = state["vof"][0] == 1.0
    assert (meet & full).any()
    assert not place[:, full].any()


def test_joined_bodies_are_one():
    text = TEXT.replace('material = "Al5083"\nshape', 'material = "W_alloy"\njoin = "rod"\ndensity = 17500\nshape')
    d, grid, table, state = start(text, ['body.rod.tip="0.25 mm"'])
    assert table.names == ("rod",)
    vof = insertion.fractions([body.outline(0.0) for body in d.body], *deck.edges(d), True)
    assert np.array_equal(state["vof"][0], np.minimum(vof.sum(axis=0), 1.0))
    both = (vof[0] > 0) & (vof[1] > 0)
    assert both.any()
    expected = (18160 * vof[0] + 17500 * vof[1])[both] / vof.sum(axis=0)[both]
    assert state["rho"][0][both] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("flow", "r", "z", "expected"),
    [
        ({"pattern": "spherical", "speed": -1.0}, 3.0, 4.0, (-0.6, -0.8)),
        ({"pattern": "spherical", "speed": -1.0, "centre": 4.0}, 3.0, 4.0, (-1.0, 0.0)),
        ({"pattern": "spherical", "speed": -2.0, "radius": 10.0, "exponent": 2}, 3.0, 4.0, (-4.8, -6.4)),
        ({"pattern": "cylindrical", "speed": 2.0, "radius": 1.5, "exponent": 1}, 3.0, 4.0, (1.0, 0.0)),
        ({"pattern": "spherical", "speed": -1.0}, 0.0, 0.0, (0.0, 0.0)),
    ],
)
def test_flows(flow, r, z, expected):
    fields = {"centre": 0.0, "radius": 1.0, "exponent": 0.0, **flow}
    body = SimpleNamespace(velocity=(0.0, 0.0), flow=SimpleNamespace(**fields))
    assert np.allclose(starts.body_velocity(body, r, z), expected, rtol=1e-14, atol=0)


@pytest.mark.parametrize(("name", "old", "new", "said"), [
    ("verification/noh_spherical.toml", "energy = 0.0", "pressure = -1.0", 'body "gas": cannot begin with a density of 1 kg/m'),
    ("validation/copper_bar.toml", 'name = "bar"', 'name = "bar"\ndensity = "950 kg/m^3"',
     'body "bar": cannot begin with a den'),
])
def test_a_start_without_a_speed_of_sound_is_an_error(name, old, new, said):
    d = deck.loads(deck_text_of(name).replace(old, new), name="torn")
    with pytest.raises(deck.DeckError, match=said):
        check(d)
    with pytest.raises(deck.DeckError, match=said):
        Simulation(d)
