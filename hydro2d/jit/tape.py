"""A list of phases that Python goes through once, and compiled code from then on: so that many steps are one call.

A `Conductor` runs phases on a handle in the order in which a Python function asks for them. What stands between two phases is
a phase as well, of functions marked `control`, except for what only Python can do. `Conductor.record` runs the function
without computing anything and notes what it asks for on a `Tape`. `Tape.play` then goes through it in compiled code, with a
thread for each part of the mesh, again and again, until something needs Python. The function must ask for the same every time.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numba
import numpy as np

from hydro2d.jit import barrier, recording
from hydro2d.jit.calls import GATE, _compile, point
from hydro2d.jit.handle import WORDS, Handle, call_at, row_of
from hydro2d.jit.phases import Phase

#: kinds of the entries of a tape: phases of all parts, phases that one part runs alone, and what that part does itself
CALL, CALL_ALONE, SET, EXCHANGE, LOOK, LEAVE = range(6)
#: the number in the handle that tells whether Python is needed
ASKS = "asks"


@point
def _after(at, entries):
    """The place after another; after the last one comes the first."""
    return at + 1 if at + 1 < entries.shape[0] else 0


@point
def _does_alone(at, entries, values, words, asks, address):
    """What one part does at an entry. Returns whether Python is needed there."""
    kind, here, there = entries[at, 0], entries[at, 1], entries[at, 2]
    if kind == CALL_ALONE:
        call_at(here, numba.int64(0), address)
    elif kind == SET:
        for word in range(values.shape[1]):
            words[here, word] = values[there, word]
    elif kind == EXCHANGE:
        for word in range(values.shape[1]):
            kept = words[here, word]
            words[here, word] = words[there, word]
            words[there, word] = kept
    return kind == LEAVE or (kind == LOOK and words[asks, 0] != 0)


@point
def _through(part, number, entries, first, values, words, asks, left, gate, address):
    """Goes through the entries of a tape, from one on, and after the last from the first, until Python is needed.

    Parts meet after each entry of all, and after the entries in between, which the first part goes through alone.
    """
    at, leaves = first, False
    while not leaves:
        alone = entries[at, 0] != CALL
        if not alone:
            call_at(entries[at, 1], part, address)
            at = _after(at, entries)
        while alone and entries[at, 0] != CALL:
            if part == 0 and _does_alone(at, entries, values, words, asks, address):
                left[0] = at
                break
            at = _after(at, entries)
        if number > 1:
            barrier.meet(gate, number, 0)
        leaves = alone and left[0] >= 0  # after the others' turn nothing has been said anew


@functools.partial(_compile, parallel=True)
def _play(number, entries, first, values, words, asks, left, gate, address):
    for part in numba.prange(number):
        _through(numba.int64(part), number, entries, first, values, words, asks, left, gate, address)


class Tape:
    """What a function has asked a conductor for.

    Attributes
    ----------
    starts : places at which the function began, one for every time it was recorded
    """

    def __init__(self):
        self.starts: list[int] = []
        self._noted: list[tuple[int, int, int]] = []
        self._noted_values: list[np.ndarray] = []
        self._functions: dict[int, Callable[[], object] | None] = {}
        self._left, self._gate = np.full(1, -1, dtype=np.int64), np.zeros(GATE, dtype=np.int64)

    def __len__(self) -> int:
        return len(self._noted)

    def note(self, kind: int, one: int = 0, other: int = 0) -> None:
        """Adds an entry."""
        self._noted.append((kind, one, other))

    def note_value(self, name: str, words: np.ndarray) -> None:
        """Adds an entry that gives a name a value, the words int64[WORDS] of a handle's row."""
        self.note(SET, row_of(name), len(self._noted_values))
        self._noted_values.append(words.copy())

    def note_function(self, kind: int, function: Callable[[], object] | None) -> None:
        """Adds an entry at which Python is needed, always or if asked: for the function, or None to end."""
        self._functions[len(self._noted)] = function
        self.note(kind)

    @functools.cached_property
    def _entries(self) -> np.ndarray:
        return np.array(self._noted, dtype=np.int64)

    @functools.cached_property
    def _values(self) -> np.ndarray:
        return np.array(self._noted_values, dtype=np.int64).reshape(-1, WORDS)

    def play(self, handle: Handle, first: int) -> None:
        """Goes through the tape from a place on, round and round, until an entry without a function is asked for."""
        while True:
            self._left[0] = -1
            _play(len(handle.parts) - 1, self._entries, first, self._values, handle.words, row_of(ASKS), self._left, self._gate,
                  handle.address)
            at = int(self._left[0])
            handle.update(**{ASKS: 0})
            function = self._functions[at]
            if function is None:
                return
            function()
            first = (at + 1) % len(self)


class Conductor:
    """Runs phases on a handle, or notes them on a tape.

    handle : Handle
    """

    def __init__(self) -> None:
        self.handle = Handle()
        self._tape: Tape | None = None

    def run(self, phase: Phase, **values) -> None:
        """Runs a phase; the values of names that are given stay set."""
        self.set(**values)
        if self._tape is not None:
            self._tape.note(CALL_ALONE if phase.is_alone else CALL, phase.address)
        else:
            phase(self.handle)

    def set(self, **values) -> None:
        """Sets the values of names, the same ones every time."""
        if self._tape is None:
            self.handle.update(**values)
            return
        aside = Handle()
        aside.update(**values)
        for name in values:
            self._tape.note_value(name, aside.words[row_of(name)])

    def exchange(self, *pairs: tuple[str, str]) -> None:
        """Exchanges the values of names with those of their partners."""
        for one, other in pairs:
            if self._tape is None:
                self.handle.exchange(one, other)
            else:
                self._tape.note(EXCHANGE, row_of(one), row_of(other))

    def ask(self, phase: Phase, function: Callable[[], object] | None) -> None:
        """Runs a phase, then a function of Python if the phase has set `asks`. None: playing ends here, once asked."""
        self.run(phase)
        if self._tape is not None:
            self._tape.note_function(LOOK, function)
        elif self.handle.asks:
            self.handle.update(asks=0)
            if function:
                function()

    def do(self, function: Callable[[], object]) -> None:
        """Runs a function of Python, every time."""
        if self._tape is not None:
            self._tape.note_function(LEAVE, function)
        elif not recording.is_recording():
            function()

    @contextmanager
    def record(self) -> Iterator[Tape]:
        """Within the block nothing is computed: what is asked for is noted on the tape."""
        self._tape = tape = Tape()
        try:
            yield tape
        finally:
            self._tape = None
