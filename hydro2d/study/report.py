"""`hydro2d report`: runs and studies as one page, a table and pictures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from hydro2d.files import write_text
from hydro2d.study import layout, pictures, table
from hydro2d.study.contents import collect
from hydro2d.study.page import page

PAGE, TABLE = "report.html", "cases.csv"


def report(directories: Sequence[Path], out: Path | None = None, say: Callable[[str], None] = print) -> Path:
    """Writes the report of a study directory, or of run directories and folders of them.

    out : the folder it is written into; default: `report` in the first directory
    say : takes one line for everything that could not be read, and for what was written

    Returns the page's path. Raises StudyError, OSError.
    """
    study = layout.load(directories[0]) if len(directories) == 1 else layout.gather(directories)
    folder = Path(out or Path(directories[0]) / "report")
    if folder.exists() and not folder.is_dir():
        raise layout.StudyError(f"{folder} is a file; --out names a folder")
    contents = collect(study)
    for note in contents.notes:
        say(f"warning: {note}")
    folder.mkdir(parents=True, exist_ok=True)
    drawn = list(pictures.draw(contents, folder))
    files = {picture.file for picture in drawn}
    for old in folder.glob("*.png"):
        if pictures.NAMES.fullmatch(old.name) and old not in files:
            old.unlink()
    write_text(folder / TABLE, table.to_csv(contents.rows))
    write_text(folder / PAGE, page(contents, drawn))
    for path in (folder / PAGE, folder / TABLE, *(picture.file for picture in drawn)):
        say(f"wrote {path}")
    return folder / PAGE
