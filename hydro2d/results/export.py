"""Exports a run: a VTK series with chosen fields, or the state in the restart file, and the history as CSV."""

from __future__ import annotations

import shutil
from pathlib import Path

from hydro2d.files.strange import own, own_folder, within
from hydro2d.files.whole import replacing
from hydro2d.materials import quantities
from hydro2d.output import history, vtk
from hydro2d.output.directory import HISTORY
from hydro2d.results.reading import Results, ResultsError


def names(dump: vtk.Dump, keys) -> list[str]:
    """Names in a dump of the quantities `keys` (or groups of quantities.GROUPS), and of those that are always written."""
    wanted = []
    for quantity in (quantities.BY_KEY[key] for key in quantities.expand(keys)):
        candidates = [quantity.name(body) for body in dump.bodies] if quantity.per_body else [quantity.name()]
        wanted += [name for name in candidates if name in dump.fields]
    return wanted


def export(run: Results, out: Path, keys=("all",)) -> list[Path]:
    """Writes `out`/series.pvd with the dumps of a run, and `out`/history.csv. Returns the files to open.

    keys : quantities of quantities.TABLE to export. For a run without dumps, the state in its restart file is written.

    Raises ResultsError, FieldError, SnapshotError, StrangeFile (a symbolic link in one of the two directories).
    """
    quantities.expand(keys)
    out = Path(out)
    if out.resolve() == run.directory.resolve():
        raise ResultsError(f"{out} is the run directory itself; export to another directory")
    out.mkdir(parents=True, exist_ok=True)
    own_folder(out / vtk.FOLDER)
    dumps = [vtk.read_grid(file) for _, file in run.dumps] or [run.state()]
    entries = []
    for number, dump in enumerate(dumps):
        name = f"{vtk.FOLDER}/dump_{number:06d}.vtr"
        fields = {name: dump.fields[name] for name in names(dump, keys)}
        vtk.write_grid(out / name, dump.r_edges, dump.z_edges, fields.items(), dump.time)
        entries.append((dump.time, name))
    written = [out / vtk.SERIES["dump"]]
    vtk.write_series(written[0], entries)
    for kind in ("interfaces", "tracers"):
        if (run.directory / vtk.SERIES[kind]).exists():
            for _, file in vtk.read_series(run.directory / vtk.SERIES[kind]):
                vtk.check_lines(within(run.directory, file))
                _copy(within(run.directory, file), out / file)
            _copy(own(run.directory / vtk.SERIES[kind]), out / vtk.SERIES[kind])
            written.append(out / vtk.SERIES[kind])
    if (run.directory / HISTORY).exists():
        written.append(out / "history.csv")
        history.write_csv(run.history, written[-1])
    return written


def _copy(source: Path, path: Path) -> None:
    with replacing(path) as temporary:
        shutil.copyfile(source, temporary)
