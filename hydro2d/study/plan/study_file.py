"""A study file as it was read, with the mistakes that are found in it and their places."""

from __future__ import annotations

from pathlib import Path

from hydro2d.files import toml
from hydro2d.files.key_lines import Sources
from hydro2d.study.plan.definition import Axis, Definition, StudyError
from hydro2d.study.plan.scaling import AS_IT_IS, Size


class StudyFile:
    """A study file with its mistakes.

    Attributes
    ----------
    path, definition, text : the file, what it says, and its text
    data, sources : its tables as they are written, and the lines of their keys
    size, ensemble : members and cells that replace those of the file; the ensemble with them, if there is one
    wrong : the mistakes, a line or more each
    """

    def __init__(self, path: Path, definition: Definition, text: str, data: dict, sources: Sources, size: Size = AS_IT_IS):
        self.path, self.definition, self.text, self.data, self.sources = path, definition, text, data, sources
        self.size, self.ensemble = size, size.ensemble(definition)
        self.wrong: list[str] = []

    @property
    def folder(self) -> Path:
        return self.path.parent

    @property
    def changes(self) -> tuple[str, ...]:
        """The changes that should not matter, of an ensemble or of the rows of a sample."""
        changing = self.ensemble or self.definition.sample
        return (changing and changing.by) or ()

    @property
    def changer(self) -> str:
        """The section with these changes, as messages name it."""
        return "the ensemble" if self.ensemble else "sample.by"

    def where(self, key: tuple) -> str:
        """File and line of a key."""
        return self.sources.where(key, self.data)

    def say(self, key: tuple, message: str) -> None:
        """Adds a mistake at a key."""
        self.wrong.append(f"{self.where(key)}: {message}")

    def refuse(self) -> None:
        """Raises StudyError with all mistakes, if there are any."""
        if self.wrong:
            raise StudyError("\n".join(dict.fromkeys(self.wrong)))


def keys_of(axis: Axis) -> set[str]:
    """The deck keys that an axis sets."""
    return {axis.key} if axis.key else {key for settings in axis.variants.values() for key in settings}


def share(one: tuple[str, ...], other: tuple[str, ...]) -> bool:
    """Whether two keys are the same, or one is a part of the other."""
    return one[: len(other)] == other[: len(one)]


def place_of(table: tuple, key: str, given: dict) -> tuple:
    """Place of a deck key in the study file, where it is quoted or a table of tables."""
    return (*table, key) if key in given else (*table, *toml.key_parts(key))
