"""hydro2d: a small, CTH-like, two-dimensional axisymmetric Eulerian hydrocode for rod-into-plate impact."""

__version__ = "0.1.0"
