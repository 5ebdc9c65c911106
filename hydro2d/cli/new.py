"""The command `hydro2d new`: a deck to start from."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from hydro2d.base.formats import in_shell
from hydro2d.base.terminal import say, wrapped
from hydro2d.cli.base import Out, UsageError


def new(kind: str | None = None, *, out: Out | None = None,
        list_: Annotated[bool, Parameter(name="--list")] = False) -> int:
    """Writes a short commented deck for a kind of shot, which runs as it is and is meant to be changed.

    Example: hydro2d new whipple

    Parameters
    ----------
    kind
        Kind of shot, such as rod, crater or whipple.
    out
        Deck to write; default: KIND.toml.
    list_
        Lists the kinds.
    """
    from hydro2d.deck import templates
    from hydro2d.files.whole import write_text

    if list_ or kind is None:
        if kind is not None or out is not None:
            raise UsageError("--list lists the kinds and writes nothing; omit the kind and --out")
        if not list_:
            raise UsageError(f"give a kind of shot: {', '.join(templates.kinds())} (hydro2d new --list describes them)")
        width = max(map(len, templates.kinds()))
        for name, what in templates.kinds().items():
            say(wrapped(f"{name:<{width}}  {what}"))
        return 0
    text = templates.text(kind)
    deck = out or Path(f"{kind}.toml")
    if deck.exists():
        raise UsageError(f"{deck} exists; give another name with --out")
    if not deck.parent.is_dir():
        raise UsageError(f"{deck.parent}: there is no such directory")
    write_text(deck, text)
    file, run = in_shell(deck), in_shell(f"runs/{deck.stem}")
    steps = {
        f"hydro2d check {file} --picture {in_shell(deck.with_suffix('.png'))}": "look at bodies, mesh and cost",
        f"hydro2d run {file} --out {run}": "run it",
        f"hydro2d view {run}": "look at it in the browser",
    }
    say(wrapped(f"wrote {deck}: {templates.kinds()[kind]}\n\nNext, after reading the file:\n"))
    width = max(map(len, steps))
    for command, what in steps.items():
        say(f"    {command:<{width}}   # {what}")
    return 0
