"""The combinations of the axes of a study without those that it excludes."""

from __future__ import annotations

import itertools

from hydro2d.base.errors import unknown
from hydro2d.files import toml
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.plan.planned import Option, label
from hydro2d.study.plan.study_file import StudyFile


def combinations(study: StudyFile, axes: list[list[Option]]) -> list[tuple[Option, ...]]:
    """All combinations of the options of the axes without those that the study excludes. Raises StudyError."""
    names = [axis.name for axis in study.definition.axis]
    options = dict(zip(names, axes, strict=True))
    rules = [_rule(study, number, entry, options) for number, entry in enumerate(study.definition.exclude)]
    study.refuse()
    kept = []
    for combination in itertools.product(*axes):
        labels = {name: choice.label for name, choice in zip(names, combination, strict=True)}
        if not any(all(labels[name] in some for name, some in rule.items()) for rule in rules):
            kept.append(combination)
    if not kept:
        raise StudyError(f"{study.path}: the exclusions leave no case")
    return kept


def _rule(study: StudyFile, number: int, entry: dict, axes: dict[str, list[Option]]) -> dict[str, list[str]]:
    """The values of an exclusion by axis. Each must exist, so that the exclusion matches something."""
    if not entry:
        study.say(("exclude", number), f"exclude[{number}]: is empty, which would exclude every case")
    rule = {}
    for name, value in entry.items():
        if name not in axes:
            study.say(("exclude", number), f"exclude[{number}]: {unknown('axis', name, axes)}")
            continue
        labels = [choice.label for choice in axes[name]]
        several = isinstance(value, list) and toml.inline(value) not in labels
        rule[name] = [label(each) for each in (value if several else [value])]
        for missing in set(rule[name]) - set(labels):
            what = f"exclude[{number}].{name}: matches nothing; {unknown('value', missing, labels)}"
            study.say(("exclude", number), what)
    return rule
