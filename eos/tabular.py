"""Tabular equation of state: pressure and energy interpolated in a table over density and temperature.

Between four points of the table, with w and t the fractions of the interval in density and in temperature,

    p = (1-w)(1-t) p_00 + w (1-t) p_10 + (1-w) t p_01 + w t p_11,    likewise e and, in t alone, T.

At a given density e is linear in t, so that t, p, T and the derivatives follow from (rho, e) in closed form. Energies are
counted from the state at rest, which is made a point of the table; dividing an interval in two does not change the bilinear
interpolation. Outside the table, and where c^2 is not positive, p and T are NaN, and a run that gets there ends.
"""

from __future__ import annotations

import numpy as np

from eos.layout import E0, RHO0, ROW
from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from hydro2d.jit import not_inlined, point

NAME = "tabular"
ID = 8
#: its row is made from parameters and a table, a `hydro2d.materials.sesame.Table`
FROM_TABLE = True
EQUATION = """\
p(rho, T), e(rho, T) bilinear between the points of the table; T from e(rho, T) - e(rho0, T0) = e
c^2 = dp/drho|e + (p/rho^2) dp/de|rho of the same interpolation"""
SOURCE = (
    "a table of the SESAME type 301: Lyon & Johnson, LA-UR-92-3407 (1992); bilinear as in the first of the interpolations of "
    "Kerley, LA-6903-MS (1977) [recalled]; the exact inverse in temperature and the closed cells are ours"
)
VALIDITY = (
    "the table's range, where c^2 is positive: a run that leaves it ends and says where; p and T are continuous, their slopes "
    "jump at the points of the table; as consistent thermodynamically as the table is fine"
)
PARAMETERS = (
    Parameter("reference_density", "kg/m^3", REQUIRED, "density at reference_temperature and no pressure in the table", "rho0",
              POSITIVE),
    Parameter("reference_temperature", "K", 298.0, "temperature at rest, from which energies are counted", "T0"),
)
#: largest error of the temperature in T ds = de - p drho/rho^2, as a share of its terms: a table is no better than its source,
#: and Tillotson's equations are the roughest source tabulated here
TEMPERATURE_WITHIN = 0.25

#: slots of the row: numbers of densities and temperatures; from DATA on come the densities, the temperatures, pressures and
#: energies with the temperature running first, and 1 for every open cell, else 0
DENSITIES, TEMPERATURES, DATA = 2, 3, 4
#: largest relative difference of reference_density from the density at zero pressure: the digits of a printed number
NEAR = 1e-5
#: points closer together than this relative distance are one
ONE = 1e-9

_NAN = float("nan")


@point
def interval(x, par, first, number):
    """Index k of the interval par[first + k] <= x < par[first + k + 1] of ``number`` rising numbers; x lies within them."""
    low, high = 0, number - 1
    while high - low > 1:
        middle = (low + high) // 2
        if par[first + middle] <= x:
            low = middle
        else:
            high = middle
    return low


@not_inlined
def evaluate(rho, e, par):
    """(p, dp/drho at constant e, dp/de at constant rho, T) at density ``rho`` and specific energy ``e``; SI.

    All are NaN outside the table and in closed cells. explanation/equation-of-state, (17) to (19)
    """
    nr, nt = int(par[DENSITIES]), int(par[TEMPERATURES])
    if not (par[DATA] <= rho and rho <= par[DATA + nr - 1]):
        return _NAN, _NAN, _NAN, _NAN
    i = interval(rho, par, DATA, nr)
    width = par[DATA + i + 1] - par[DATA + i]
    w = (rho - par[DATA + i]) / width
    v = 1.0 - w
    p_at = DATA + nr + nt + i * nt
    e_at = p_at + nr * nt
    if not (v * par[e_at] + w * par[e_at + nt] <= e and e <= v * par[e_at + nt - 1] + w * par[e_at + 2 * nt - 1]):
        return _NAN, _NAN, _NAN, _NAN
    j, high = 0, nt - 1
    while high - j > 1:
        middle = (j + high) // 2
        if v * par[e_at + middle] + w * par[e_at + nt + middle] <= e:
            j = middle
        else:
            high = middle
    if par[DATA + nr + nt + 2 * nr * nt + i * (nt - 1) + j] == 0.0:
        return _NAN, _NAN, _NAN, _NAN
    e00, e01, e10, e11 = par[e_at + j], par[e_at + j + 1], par[e_at + nt + j], par[e_at + nt + j + 1]
    p00, p01, p10, p11 = par[p_at + j], par[p_at + j + 1], par[p_at + nt + j], par[p_at + nt + j + 1]
    low = v * e00 + w * e10
    by_t = v * (e01 - e00) + w * (e11 - e10)
    t = (e - low) / by_t
    s = 1.0 - t
    p_low = v * p00 + w * p10
    p_high = v * p01 + w * p11
    dpde = (p_high - p_low) / by_t
    dpdrho = (s * (p10 - p00) + t * (p11 - p01) - dpde * (s * (e10 - e00) + t * (e11 - e01))) / width
    return s * p_low + t * p_high, dpdrho, dpde, s * par[DATA + nr + j] + t * par[DATA + nr + j + 1]


def row(values, table) -> np.ndarray:
    """Packs the parameters, by name, and a table (`hydro2d.materials.sesame.Table`); float64[k], at least ROW long.

    Raises ValueError for a missing, unknown or impossible value, and if the table does not contain the state at rest.
    """
    given = collect(NAME, PARAMETERS, values)
    rho0, T0 = given["reference_density"], given["reference_temperature"]
    rho, T, p, e = table.density, table.temperature, table.pressure, table.energy
    for word, value, points, unit in (("reference_density", rho0, rho, "kg/m^3"), ("reference_temperature", T0, T, "K")):
        if not points[0] <= value < points[-1]:
            raise ValueError(f"{NAME}: {word} = {value:g} {unit} is not within the table, {points[0]:g} to {points[-1]:g} "
                             f"{unit}")
    rho, (p, e) = with_point(rho, (p, e), rho0)
    T, (p, e) = with_point(T, (p.T, e.T), T0)
    p, e = p.T, e.T
    i, j = int(np.searchsorted(rho, rho0)), int(np.searchsorted(T, T0))
    slope = (p[i + 1, j] - p[i, j]) / (rho[i + 1] - rho[i])
    if not abs(p[i, j]) <= NEAR * rho0 * abs(slope):
        raise ValueError(f"{NAME}: at reference_density = {rho0:.8g} kg/m^3 and {T0:g} K the table has a pressure of "
                         f"{p[i, j]:.4g} Pa; {without_pressure(table, T0)}")
    p[i, j] = 0.0
    e = e - e[i, j]
    opened = open_cells(rho, T, p, e)
    if not opened[i, j]:
        raise ValueError(f"{NAME}: in the table c^2 is not positive at rest, {rho0:g} kg/m^3 and {T0:g} K")
    packed = np.concatenate([[rho0, 0.0, rho.size, T.size], rho, T, p.ravel(), e.ravel(), opened.ravel()])
    par = np.zeros(max(packed.size, ROW))
    par[: packed.size] = packed
    assert (RHO0, E0, DENSITIES, TEMPERATURES) == (0, 1, 2, 3)
    return par


def with_point(x: np.ndarray, values, at: float):
    """(points, values) with a point inserted at ``at``, its values interpolated between its neighbours.

    x : float64[n], rising;  values : arrays float64[n, k]. A point within round-off of ``at`` is moved there.
    """
    near = int(np.argmin(np.abs(x - at)))
    if abs(x[near] - at) <= ONE * abs(at):
        x = x.copy()
        x[near] = at
        return x, tuple(each.copy() for each in values)
    k = int(np.searchsorted(x, at))
    w = (at - x[k - 1]) / (x[k] - x[k - 1])
    return np.insert(x, k, at), tuple(np.insert(each, k, (1.0 - w) * each[k - 1] + w * each[k], axis=0) for each in values)


def densities_without_pressure(table, T: float) -> list[float]:
    """Densities at which the pressure rises through zero at a temperature in K within the table, kg/m^3."""
    j = min(max(int(np.searchsorted(table.temperature, T)), 1), table.temperature.size - 1)
    t = (T - table.temperature[j - 1]) / (table.temperature[j] - table.temperature[j - 1])
    p = (1.0 - t) * table.pressure[:, j - 1] + t * table.pressure[:, j]
    rises = np.flatnonzero((p[:-1] <= 0.0) & (p[1:] > 0.0))
    rho = table.density
    return [float(rho[k] - p[k] * (rho[k + 1] - rho[k]) / (p[k + 1] - p[k])) for k in rises]


def without_pressure(table, T: float) -> str:
    """Says at which densities the pressure is zero at a temperature in K."""
    densities = [rho for rho in densities_without_pressure(table, T) if rho > 0.0]
    at = " and ".join(f"{rho:.8g}" for rho in densities)
    return f"it is zero at {at} kg/m^3" if densities else "it is zero at no density there"


def open_cells(rho: np.ndarray, T: np.ndarray, p: np.ndarray, e: np.ndarray) -> np.ndarray:
    """Whether c^2 is positive throughout each cell of a table, bool[i - 1, j - 1]; at 0 K it may be zero. p, e : float64[i, j].

    In a cell G = rho^2 c^2 de/dt is linear in t, and along its sides t = 0 and t = 1 a cubic of w, whose least value is at an
    end or where its slope vanishes. explanation/equation-of-state, (20)
    """
    r, width = rho[:-1, None], np.diff(rho)[:, None]

    def parts(q):
        along_t = np.diff(q, axis=1)
        return q[:-1, :-1], np.diff(q, axis=0)[:, :-1], along_t[:-1], np.diff(along_t, axis=0)

    p0, pw, pt, pwt = parts(p)
    _, ew, et, ewt = parts(e)
    turn, turn_w, turn_t = pw * et - pt * ew, pw * ewt - pwt * ew, pwt * et - pt * ewt
    kept = np.ones(p0.shape, dtype=bool)
    cold = (T[:-1] == 0.0)[None, :]
    empty = (r == 0.0) & (p0 == 0.0) & (pt == 0.0)  # where rho = 0 and p = 0 for all T, G has the factor w^2
    for t in (0.0, 1.0):
        a, b = (turn + t * turn_t) / width, turn_w / width
        c, d = p0 + t * pt, pw + t * pwt
        cubic = (a * r * r + c * pt, b * r * r + 2.0 * a * r * width + c * pwt + d * pt,
                 a * width**2 + 2.0 * b * r * width + d * pwt, b * width**2)
        least = np.where(empty, _least(cubic[2], cubic[3], 0.0, 0.0), _least(*cubic))
        kept &= (least > 0.0) | ((least == 0.0) & cold & (t == 0.0))
    return kept


def _least(g0, g1, g2, g3) -> np.ndarray:
    """Least value of g0 + g1 w + g2 w^2 + g3 w^3 on 0 <= w <= 1."""
    def at(w):
        return g0 + w * (g1 + w * (g2 + w * g3))

    least = np.minimum(at(0.0), at(1.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(g2 * g2 - 3.0 * g1 * g3)
        far = -(g2 + np.copysign(root, g2))
        for w in (far / (3.0 * g3), g1 / far):
            inside = (w > 0.0) & (w < 1.0)
            least = np.where(inside, np.minimum(least, at(np.where(inside, w, 0.0))), least)
    return least


def span(par: np.ndarray) -> str:
    """Range of the table of a row, in words."""
    nr, nt = int(par[DENSITIES]), int(par[TEMPERATURES])
    rho, T = par[DATA:][:nr], par[DATA + nr:][:nt]
    cells = par[DATA + nr + nt + 2 * nr * nt:][: (nr - 1) * (nt - 1)].reshape(nr - 1, nt - 1)
    said = f"densities of {rho[0]:.6g} to {rho[-1]:.6g} kg/m^3 and temperatures of {T[0]:.6g} to {T[-1]:.6g} K"
    closed = np.argwhere(cells == 0.0)
    if len(closed):
        (i0, j0), (i1, j1) = closed.min(axis=0), closed.max(axis=0) + 1
        said += (f", except {len(closed)} of {cells.size} cells in which c^2 is not positive, between {rho[i0]:.6g} and "
                 f"{rho[i1]:.6g} kg/m^3, {T[j0]:.6g} and {T[j1]:.6g} K")
    return said


def energies(rho: float, par: np.ndarray) -> tuple[float, float] | None:
    """Least and greatest energy of the table at a density, J/kg; None outside it."""
    nr, nt = int(par[DENSITIES]), int(par[TEMPERATURES])
    if not par[DATA] <= rho <= par[DATA + nr - 1]:
        return None
    i = interval(rho, par, DATA, nr)
    w = (rho - par[DATA + i]) / (par[DATA + i + 1] - par[DATA + i])
    e = par[DATA + nr + nt + (nr + i) * nt:][: 2 * nt]
    return tuple(float((1.0 - w) * e[k] + w * e[nt + k]) for k in (0, nt - 1))
