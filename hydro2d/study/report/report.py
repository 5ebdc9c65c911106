"""`hydro2d report`: runs and studies as one page, a table, pictures and films."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from urllib.parse import quote

from hydro2d.base.terminal import say
from hydro2d.files.strange import own
from hydro2d.files.whole import write_text
from hydro2d.output.history import HistoryError
from hydro2d.output.vtk import VtkError
from hydro2d.results.reading import Results, ResultsError
from hydro2d.results.viewer import page as viewer
from hydro2d.results.viewer.field_arrays import ViewError
from hydro2d.results.viewer.packing import DEFAULT_BITS
from hydro2d.study.ensemble import ensembles
from hydro2d.study.ensemble.contents import Contents, collect
from hydro2d.study.records import responses, study_directory, table
from hydro2d.study.report import panels, pictures, uncertain
from hydro2d.study.report.page import PAGE, TABLE, charts_script, page


def _views(contents: Contents, folder: Path, make: bool, say: Callable[[str], None]) -> dict[str, str]:
    """Links from a folder to the pages of runs, by case; ``make``: those of runs with dumps are made first."""
    links = {}
    for each in contents.records:
        file = own(each.case.directory / viewer.PAGE)
        if make:
            try:
                run = Results(each.case.directory)
                viewer.view([run], ("all",), DEFAULT_BITS).save(file)
                say(f"wrote {file}")
            except (ResultsError, ViewError, VtkError, HistoryError) as error:
                say(f"warning: {each.case.name} has no page of its own: {error}")
        if file.is_file():
            links[each.case.name] = quote(Path(os.path.relpath(file.resolve(), folder.resolve())).as_posix())
    return links


def report(directories: Sequence[Path], out: Path | None = None, say: Callable[[str], None] = say, *, x: str | None = None,
           y: Sequence[str] = (), by: Sequence[str] = (), movie: str | None = None, view: bool = False,
           trust: bool = False) -> Path:
    """Writes the report of a study directory, or of run directories and folders of them.

    out : folder to write to; default: `report` in the first directory
    say : receives one line for everything that could not be read, and for every file written
    x, y, by : axes and series of the figures, see responses.choose
    movie : a field; a film of it is made for every run with dumps
    view : whether the page of `hydro2d view` is made for every run with dumps; the report links to existing ones
    trust : whether the code of models from outside that the decks of the runs carry may be run

    Returns the path of the page. Raises MissingPackage, StudyError, FigureError, OSError.
    """
    charts_script()  # refuses charts that cannot be drawn, before the pictures are made
    study = study_directory.load(directories[0]) if len(directories) == 1 else study_directory.gather(directories)
    folder = Path(out or own(Path(directories[0]) / "report"))
    if folder.exists() and not folder.is_dir():
        raise study_directory.StudyError(f"{folder} is a file; --out must name a folder")
    if movie:
        pictures.check_field(movie)
    contents = collect(study, trust)
    choice = responses.choose(study, contents.records, x, y, by)
    missing = [name for name in y if all(responses.raw(each, name) is None for each in contents.records)]
    contents.notes += [f"no run has {name}, so it is not drawn" for name in missing]
    contents.table = table.with_responses(contents.table, contents.records, choice)
    for note in contents.notes:
        say(f"warning: {note}")
    folder.mkdir(parents=True, exist_ok=True)
    drawn = list(pictures.draw(contents, folder))
    fitted = list(pictures.fitted(contents, folder))
    parts = uncertain.parts(study, folder)
    films = list(pictures.films(contents, movie, folder, say)) if movie else []
    views = _views(contents, folder, view, say)
    of_sample = [picture for part in parts for picture in part.pictures]
    files = {picture.file for picture in (*drawn, *fitted, *of_sample, *films)}
    for old in folder.iterdir():
        if pictures.NAMES.fullmatch(old.name) and old not in files:
            old.unlink()
    write_text(folder / TABLE, table.to_csv(contents.table))
    write_text(folder / PAGE, page(contents, choice, list(panels.draw(contents, choice)), drawn, films, fitted,
                                    views=views, uncertain=parts))
    written = [folder / PAGE, folder / TABLE, *sorted(files)]
    if study.ensembles:
        write_text(folder / ensembles.FILE, table.to_csv(contents.table_of_ensembles(choice)))
        written.insert(2, folder / ensembles.FILE)
    for path in written:
        say(f"wrote {path}")
    return folder / PAGE
