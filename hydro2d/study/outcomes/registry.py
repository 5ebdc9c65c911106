"""The outcomes that a search can have. A new one is a file in this folder and its class in ``KINDS``."""

from __future__ import annotations

from hydro2d.study.outcomes.base import Outcome
from hydro2d.study.outcomes.depth import Deeper, Shallower
from hydro2d.study.outcomes.erosion import Erosion
from hydro2d.study.outcomes.length import Length
from hydro2d.study.outcomes.perforation import Perforation
from hydro2d.study.outcomes.regime import Regime

KINDS: tuple[type[Outcome], ...] = (Regime, Erosion, Length, Perforation, Deeper, Shallower)
BY_NAME = {kind.name: kind for kind in KINDS}
