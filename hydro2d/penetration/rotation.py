"""Attitudes as unit quaternions (w, x, y, z), and the free rotation of a body of revolution in closed form.

A quaternion turns components in the body's frame into components in the fixed frame; products act from the left.
explanation/penetration/rigid-body, equations 3 and 9
"""

from __future__ import annotations

import math

import numpy as np

IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The rotation ``b`` followed by ``a``."""
    w, x, y, z = a
    s, i, j, k = b
    return np.array(
        [
            w * s - x * i - y * j - z * k,
            w * i + x * s + y * k - z * j,
            w * j - x * k + y * s + z * i,
            w * k + x * j - y * i + z * s,
        ]
    )


def turn(vector: np.ndarray) -> np.ndarray:
    """The rotation about ``vector`` by its length, rad."""
    angle = math.sqrt(vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2)
    factor = 0.5 if angle == 0.0 else math.sin(0.5 * angle) / angle
    return np.array([math.cos(0.5 * angle), *(factor * np.asarray(vector))])


def matrix(q: np.ndarray) -> np.ndarray:
    """The rotation matrix [3, 3] of a unit quaternion; its columns are the body's axes in the fixed frame."""
    w, x, y, z = q
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def pointing(pitch: float, yaw: float) -> np.ndarray:
    """The attitude whose axis is (sin pitch cos yaw, sin yaw, cos pitch cos yaw); angles in rad."""
    return product(turn(np.array([0.0, pitch, 0.0])), turn(np.array([-yaw, 0.0, 0.0])))


def coast(q: np.ndarray, momentum: np.ndarray, axial: float, transverse: float, time: float) -> np.ndarray:
    """The attitude after ``time`` s free of torque, of a body with the moments of inertia ``axial`` and ``transverse``.

    Exact: for two equal moments Euler's equations are solved by a turn about the fixed angular ``momentum``
    (kg m^2/s, fixed frame) at the rate L/I_t and a turn about the body's own axis at the rate
    (1/I_a - 1/I_t) L_axis. The result is scaled to unit length.
    """
    along = matrix(q)[:, 2] @ momentum
    own = np.array([0.0, 0.0, time * (1.0 / axial - 1.0 / transverse) * along])
    q = product(product(turn((time / transverse) * momentum), q), turn(own))
    return q / math.sqrt(q @ q)
