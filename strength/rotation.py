"""Rotation of symmetric tensors in the meridian plane by the spin of the material."""

from hydro2d.jit import point


@point
def turned(rr, zz, rz, spin):
    """(rr, zz, rz) of a symmetric tensor turned by ``spin`` = W dt, radians (explanation/strength, equation 1).

    The rotation (1 - a^2)/(1 + a^2), 2 a/(1 + a^2), a = spin/2 keeps the invariants; its angle 2 atan(a) is the spin to
    second order.
    """
    a = 0.5 * spin
    norm = 1.0 / (1.0 + a * a)
    c, s = (1.0 - a * a) * norm, 2.0 * a * norm
    return (c * c * rr + 2.0 * c * s * rz + s * s * zz, s * s * rr - 2.0 * c * s * rz + c * c * zz,
            c * s * (zz - rr) + (c * c - s * s) * rz)
