"""Interrupts that stop a run after its cycle: a signal, a closed pipe, or a request by a program."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

#: exit status of a process ended by a signal, as in shells; the same where a system has no such signal
STATUS = {"SIGHUP": 129, "SIGINT": 130, "SIGPIPE": 141, "SIGTERM": 143}
#: the signals that end a run after its cycle, and the one of a timer; Windows lacks SIGHUP and timers
CAUGHT = tuple(getattr(signal, name) for name in ("SIGHUP", "SIGINT", "SIGTERM") if hasattr(signal, name))
ALARM: int | None = getattr(signal, "SIGALRM", None)
#: seconds after which a signal that arrived during an import is handled again
AGAIN = 0.01


@dataclass
class Interrupt:
    """Set by a signal, or by a program that wants its run to stop. The run then ends after the current cycle."""

    reason: str = ""
    hears_signals: bool = False

    def __call__(self, reason: str) -> None:
        self.reason = self.reason or reason


def status(reason: str) -> int:
    """The exit status for the reason of an interrupt; that of SIGTERM if a program requested it."""
    return next((number for name, number in STATUS.items() if name in reason), STATUS["SIGTERM"])


@contextmanager
def signals(interrupt: Interrupt) -> Iterator[None]:
    """SIGINT, SIGTERM and SIGHUP set the interrupt; a second signal has its usual effect. Only the main thread gets signals.

    A signal that was ignored before, such as SIGHUP under nohup, stays ignored. A nested block for the same interrupt
    changes nothing.
    """
    if interrupt.hears_signals or threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {}

    def handle(number, _frame):
        interrupt(signal.Signals(number).name)
        for each, handler in before.items():
            signal.signal(each, handler)

    for number in CAUGHT:
        if signal.getsignal(number) is not signal.SIG_IGN:
            before[number] = signal.signal(number, handle)
    interrupt.hears_signals = True
    try:
        yield
    finally:
        interrupt.hears_signals = False
        for number, handler in before.items():
            signal.signal(number, handler)


#: names of the signals that `raise_between_imports` has received
_came: list[str] = []


def ended_by() -> str:
    """The name of the signal that ended a command. It is kept because other code may replace the exception that it raised."""
    return _came[0] if _came else "SIGINT"


def raise_between_imports() -> None:
    """From now on, SIGINT, SIGTERM and SIGHUP raise KeyboardInterrupt; during an import, shortly after it. A second one that
    comes in an import, when nothing is being written, ends the process at once.

    An exception in the middle of an import turns into another one or, in C libraries, ends in a crash. Where Python cannot
    propagate the exception, such as in a finaliser or in a callback from C, it is raised again shortly after. A signal that was
    ignored before, such as SIGHUP under nohup, stays ignored. To be called in the main thread of a command. Where there is no
    timer, nothing waits for the end of an import.
    """

    def handle(number, frame):
        if number != ALARM:
            _came.append(signal.Signals(number).name)
        while frame is not None and not frame.f_code.co_filename.startswith("<frozen importlib"):
            frame = frame.f_back
        if frame is None or ALARM is None:
            raise KeyboardInterrupt
        if number != ALARM and len(_came) > 1:
            os._exit(STATUS[ended_by()])
        signal.setitimer(signal.ITIMER_REAL, AGAIN)

    previous_hook = sys.unraisablehook

    def lost(unraisable):
        if unraisable.exc_type is KeyboardInterrupt and _came and ALARM is not None:
            signal.setitimer(signal.ITIMER_REAL, AGAIN)
        else:
            previous_hook(unraisable)

    sys.unraisablehook = lost
    if ALARM is not None:
        signal.signal(ALARM, handle)
    for number in CAUGHT:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, handle)


def open_closed_streams() -> None:
    """Opens each standard stream that the process was started without: reads give nothing, writes are discarded.

    To be called before anything else is opened, since that would get the number of a missing stream.
    """
    for number, (name, mode) in enumerate((("stdin", "r"), ("stdout", "w"), ("stderr", "w"))):
        if getattr(sys, name) is None:
            nowhere = os.open(os.devnull, os.O_RDWR)
            if nowhere != number:
                os.dup2(nowhere, number)
                os.close(nowhere)
            setattr(sys, name, open(number, mode, encoding="utf-8", closefd=False))


def lose_output() -> None:
    """Discards all further output, because the reader of the standard output has gone."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)
