"""Writes docs/gallery.md: what every kind of `hydro2d new` gives, beside what is measured or expected, and every study.

    python docs/gallery.py              # runs all kinds and draws the studies: half an hour on one core
    python docs/gallery.py spall rod    # runs these again, and keeps the numbers of the others
    python docs/gallery.py --studies    # draws studies and exact solutions again, from the results that problems/ keeps

Numbers are kept in docs/gallery.json, so that the page can be written again without a run.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

import figures
from _pages import exact, kinds, studies

HERE = Path(__file__).resolve().parent
NUMBERS, PAGE = HERE / "gallery.json", HERE / "gallery.md"
LEAD = """# Gallery

Nine shots to start from, with what each gives beside what was measured or is expected; problems with exact solutions; and every
study of the repository.
`hydro2d new KIND` writes the deck. Times are those of one core of an AMD EPYC, without the compilation that the first run of
all needs.

*`python docs/gallery.py` writes this page: it runs the commands that are shown and draws the results that `problems` keeps.*
"""


def command(words: str) -> list[str]:
    """A command of the page as a process."""
    return [sys.executable, "-m", "hydro2d", *shlex.split(words)[1:]]


def run_kind(kind: kinds.Kind, folder: Path, settings: tuple[str, ...] = ()) -> dict:
    """Runs the commands of a kind in a folder. Returns the seconds of the run and the results in words.

    settings : further arguments of `hydro2d run`, to cut it short
    """
    environment = os.environ | {"PYTHONPATH": str(HERE.parent), "MPLBACKEND": "agg"}
    seconds = 0.0
    for words in kind.commands():
        more = settings if words.startswith("hydro2d run") else ()
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        subprocess.run([*command(words), *more], cwd=folder, env=environment, check=True)
        if words.startswith("hydro2d run"):
            seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    import hydro2d

    results = hydro2d.open_run(folder / "runs" / kind.name)
    return {"seconds": round(seconds, 1), "results": {what: found(results) for what, _, found in kind.numbers}}


def page(numbers: dict[str, dict]) -> str:
    """The text of the page from the numbers of docs/gallery.json."""
    shots = (kind.section(numbers[kind.name]) for kind in kinds.KINDS)
    parts = [LEAD, *shots, *exact.sections(), *studies.sections()]
    return "\n".join(parts)


def main(arguments: list[str] | None = None) -> int:
    """Runs what is asked for, and writes page, pictures and numbers."""
    parser = argparse.ArgumentParser(description="Writes docs/gallery.md, its pictures and docs/gallery.json.")
    parser.add_argument("kinds", nargs="*", choices=[[], *(kind.name for kind in kinds.KINDS)], metavar="KIND")
    parser.add_argument("--studies", action="store_true",
                        help="draws studies and exact solutions, and runs no kind that is not named")
    given = parser.parse_args(arguments)
    numbers = json.loads(NUMBERS.read_text(encoding="utf-8")) if NUMBERS.is_file() else {}
    chosen = given.kinds or ([] if given.studies else [kind.name for kind in kinds.KINDS])
    for kind in (kind for kind in kinds.KINDS if kind.name in chosen):
        with tempfile.TemporaryDirectory() as folder:
            numbers[kind.name] = run_kind(kind, Path(folder))
            figures.shrink(Path(folder) / f"{kind.name}.png", figures.STATIC / kind.picture)
        NUMBERS.write_text(json.dumps(numbers, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        print(f"{kind.name}: {numbers[kind.name]}", flush=True)
    if given.studies or not given.kinds:
        studies.draw(figures.STATIC)
        exact.draw(figures.STATIC)
    if set(numbers) >= {kind.name for kind in kinds.KINDS}:
        PAGE.write_text(page(numbers), encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
