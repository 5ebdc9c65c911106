"""What studies and commands take of the analytic penetration models; they ask this package and not `hydro2d.penetration`."""

from hydro2d.penetration import lambert_jonas, recht_ipson
from hydro2d.penetration.catalogue import MODELS
from hydro2d.penetration.inputs import NOSE
from hydro2d.penetration.model import InputError, Motion

__all__ = ["MODELS", "NOSE", "InputError", "Motion", "lambert_jonas", "recht_ipson"]
