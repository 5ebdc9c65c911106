"""Names from the analytic penetration models for studies and commands, which import no module of `hydro2d.penetration`."""

from hydro2d.penetration import lambert_jonas, recht_ipson
from hydro2d.penetration.catalogue import MODELS
from hydro2d.penetration.inputs import NOSE
from hydro2d.penetration.model import InputError, Motion

__all__ = ["MODELS", "NOSE", "InputError", "Motion", "lambert_jonas", "recht_ipson"]
