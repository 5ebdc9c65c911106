"""Runs mutants in a watched process, and reports how each ended.

``python -m tests.trials.campaign 0 1000 FILE`` adds a line of JSON for each mutant from 0 up to 1000 to FILE, then prints the
counts. Mutants that already have a line are not run again.
"""

from __future__ import annotations

import collections
import contextlib
import json
import multiprocessing
import os
import sys
import traceback
import warnings
from pathlib import Path

#: seconds after which a mutant counts as hanging, and cells beyond which it is not run
LIMIT, MOST_CELLS = 60.0, 20_000
#: permitted outcomes of a mutant; any other is a failure
SOUND = ("refused", "large", "unphysical", "untrusted", "trusted")
EVERY = 10


def judged(text: str) -> dict:
    """How a deck ends: {"ended": one of SOUND, or "beyond", "crash", "disagrees"} and the message."""
    from hydro2d.base.errors import DeckError, UnphysicalState
    from hydro2d.deck import deck as decks
    from hydro2d.running.check import check
    from hydro2d.solver.simulation import Simulation
    from tests.trials.screen import Screen

    warnings.filterwarnings("error", category=RuntimeWarning, module="hydro2d")
    beyond: dict[str, dict] = {}
    try:
        try:
            deck = decks.loads(text, name="mutant")
            cells = [len(edges) - 1 for edges in decks.edges(deck)]
            if cells[0] * cells[1] > MOST_CELLS:
                return {"ended": "large"}
            texts = check(deck)
            texts.lines(1)
        except DeckError as error:
            return {"ended": "refused" if str(error).strip() else "crash", "message": str(error)}
        try:
            simulation = Simulation(deck)
            screen = Screen(simulation)
        except DeckError as error:
            return {"ended": "disagrees", "message": str(error)}

        def look(sim) -> None:
            for name, worst in screen.beyond().items() if sim.cycle % EVERY == 0 else ():
                if worst["times"] > beyond.get(name, {"times": 0.0})["times"]:
                    beyond[name] = worst

        try:
            reason = simulation.run(callbacks=(look,))
        except UnphysicalState as error:
            return {"ended": "unphysical", "message": str(error), "beyond": beyond}
        _read(simulation)
        faults = simulation.faults() + simulation.doubts()
        ended = "untrusted" if faults else "beyond" if beyond else "trusted"
        return {"ended": ended, "message": "; ".join(faults) or reason, "beyond": beyond, "warnings": texts.warnings}
    except Exception:
        return {"ended": "crash", "message": traceback.format_exc(), "beyond": beyond}


def _read(simulation) -> None:
    """Requests everything in a summary and a dump."""
    from hydro2d.output import derived_quantities

    for each in (simulation.diagnostics, simulation.of_bodies, simulation.of_targets, simulation.holes, simulation.conservation,
                 simulation.stations.measure):
        each()
    derived_quantities.evaluated(simulation)


def _serve(pipe) -> None:
    """Judges texts until no more are sent, on one thread."""
    os.environ["NUMBA_NUM_THREADS"] = "1"
    with contextlib.suppress(EOFError):
        while True:
            pipe.send(judged(pipe.recv()))


class Watched:
    """A process of one thread that judges decks; one that hangs or dies is replaced."""

    def __init__(self) -> None:
        self.process = None

    def __call__(self, text: str) -> dict:
        """How a deck ends: as `judged`, or "hang" or "died"."""
        first = self.process is None
        if first:
            self._begin()
        try:
            self.pipe.send(text)
            if self.pipe.poll(LIMIT * (10 if first else 1)):  # the first may compile
                return self.pipe.recv()
            ended = {"ended": "hang", "message": f"no end within {LIMIT:g} s"}
        except (EOFError, OSError):
            self.process.join(5)
            ended = {"ended": "died", "message": f"exit status {self.process.exitcode}"}
        self.end()
        return ended

    def _begin(self) -> None:
        spawn = multiprocessing.get_context("spawn")
        self.pipe, other = spawn.Pipe()
        self.process = spawn.Process(target=_serve, args=(other,), daemon=True)
        self.process.start()
        other.close()

    def end(self) -> None:
        """Ends the process."""
        if self.process is not None:
            self.process.kill()
            self.process.join()
            self.process = None


def run(numbers, note=lambda line: None) -> collections.Counter:
    """Judges mutants by their numbers; returns how many ended how. ``note`` gets a dict for each."""
    from tests.trials import mutants

    watched, count = Watched(), collections.Counter()
    try:
        for number in numbers:
            name, changes, text = mutants.mutant(number)
            ended = watched(text)
            count[ended["ended"]] += 1
            note({"number": number, "deck": name, "changes": changes, **ended})
    finally:
        watched.end()
    return count


@contextlib.contextmanager
def kept(first: str, last: str, file: str):
    """(numbers from first up to last without a line in a file, function that adds the line of one, a dict)."""
    path = Path(file)
    done = {json.loads(line)["number"] for line in path.read_text().splitlines()} if path.exists() else set()
    with path.open("a") as out:

        def note(line: dict) -> None:
            out.write(json.dumps(line) + "\n")
            out.flush()

        yield [number for number in range(int(first), int(last)) if number not in done], note


def main(first: str, last: str, file: str) -> None:
    """The command."""
    with kept(first, last, file) as (numbers, note):
        print(dict(run(numbers, note)))


if __name__ == "__main__":
    main(*sys.argv[1:])
