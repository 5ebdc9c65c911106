"""The kinds of sources. A new one is a file in this folder and its class in ``KINDS``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from hydro2d.base.keys import one_of
from hydro2d.sources.acceleration import Acceleration
from hydro2d.sources.base import Source
from hydro2d.sources.detonation import Detonation
from hydro2d.sources.heating import Heating

KINDS: dict[str, type[Source]] = {kind.word: kind for kind in (Heating, Acceleration, Detonation)}

AnySource: Any = Source if TYPE_CHECKING else one_of(KINDS, "kind")
