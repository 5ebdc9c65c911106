"""The base of all outcomes of a search."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

from hydro2d.analytic import model_transition
from hydro2d.measure.regime import ERODED_MASS

#: names of the brackets that a search of a rod's fate has in addition, from the depths of its runs, and their rules
FALL, LIMIT = "depth falls", "hydrodynamic limit"
BY_DEPTH = {
    FALL: "between the deepest run and the next faster one, however far apart; it prompts no further runs",
    LIMIT: f"as for experiments: {model_transition.RULE}; also from the same runs, without those slower than every deeper one",
}


class Verdict(NamedTuple):
    """How a run ended, in a word of the outcome's order; None, with the reason, if that is not known."""

    word: str | None
    reason: str = ""


class Outcome:
    """A question that a search asks of every run.

    ``order`` has the answers from slow shots to fast ones, ``transitions`` the names of the changes by the answer that they
    lead to, ``terms`` the rules by term, for readers. Those with ``of_rod`` are known of experiments and analytic models, too.
    """

    #: its word under `of` in a study file, and the words after "what changes:" on the reference page
    name: ClassVar[str]
    meaning: ClassVar[str]
    order: ClassVar[tuple[str, ...]]
    transitions: ClassVar[Mapping[str, str]]
    terms: ClassVar[Mapping[str, str]]
    of_rod: ClassVar[bool] = False
    #: whether it compares with `depth` of the study file, and whether it is the ballistic limit of a standard
    has_depth: ClassVar[bool] = False
    is_ballistic: ClassVar[bool] = False

    @classmethod
    def judge(cls, record: Any, depth: float | None) -> Verdict:
        """The answer for a run that is done; record : study.records.record.Record;  depth : of the study file, m."""
        raise NotImplementedError


def lost(record: Any) -> Verdict | None:
    """The verdict on a projectile that was not followed to its end; None for any other.

    In runs of versions without the regime "left the mesh", such a projectile is recognised by its loss of mass.
    """
    first, mass = record.first.get("rod_mass_kg"), record.value("rod_mass_kg")
    if record.perforated and (record.left or (first and mass < (1.0 - ERODED_MASS) * first)):
        return Verdict(None, "the projectile went through the target and left the mesh; stop.perforation = true ends a run "
                             "before that")
    return Verdict(None, "the projectile left the mesh before it came to rest") if record.left else None
