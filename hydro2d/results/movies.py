"""Films of runs: the sections of figures.py, dump by dump, with one colour range for all frames."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from hydro2d.base.errors import unknown
from hydro2d.files.whole import replacing
from hydro2d.output.vtk import Dump
from hydro2d.results import figures
from hydro2d.results.scales import LINEAR, FigureError, balanced

#: file endings of films, and the writer of each
FORMATS = {".gif": "pillow", ".mp4": "ffmpeg"}
DPI = 110

Window = tuple[float, float, float] | None


def film(runs: list, path: Path, field: str = "pressure", *, mirror: str | None = None, window: Window = None,
         follow: str | None = None, limits: tuple[float, float] | None = None, rate: float = 10.0,
         beside: bool = False, dpi: float = DPI) -> int:
    """Writes a film of runs (results.Results): a frame for each dump of the run with most, and the nearest of the others.

    Parameters
    ----------
    path : the film file; its suffix, .gif or .mp4, sets the format
    field, mirror : fields of the upper and of the lower half, see figures.chosen
    window : (z0, z1, r1) in m, the part to show; default: the whole mesh
    follow : a body that the window follows; z0 and z1 are then measured from its leading end along z
    limits : colour range of `field` in the reader's unit; default: the range of all frames
    rate : frames per second
    beside : shows runs side by side instead of below one another
    dpi : dots per inch of the frames

    Returns the number of frames. Raises FigureError.
    """
    path = Path(path)
    _refuse(path, runs, window, follow)
    times = max(([time for time, _ in run.dumps] for run in runs), key=len)
    if not times:
        raise FigureError(f"{runs[0].directory} has no dumps to make a film of")
    if not path.parent.is_dir():
        raise FigureError(f"{path.parent}: there is no such directory")
    shown = _Window(runs, window, follow)
    ranges = _ranges(runs, times, [field, mirror or field], shown)
    if limits is not None:
        ranges[field] = limits
    figure, writer = None, None
    with replacing(path) as temporary:
        target = temporary.with_name(temporary.name + path.suffix)
        try:
            for time in times:
                panels = [(run.dump(time), run.label, run.measured_position) for run in runs]
                rows = [panels] if beside else [[panel] for panel in panels]
                windows = {id(dump): shown.of(run, dump) for run, (dump, _, _) in zip(runs, panels, strict=True)}
                figure = figures.draw_sections(rows, field, mirror, lambda dump, at=windows: at[id(dump)], ranges, figure)
                if writer is None:
                    writer = _writer(path, rate)
                    writer.setup(figure, str(target.absolute()), dpi)  # else ffmpeg reads "a:" as a protocol
                writer.grab_frame()
            writer.finish()
            target.replace(temporary)
        finally:
            target.unlink(missing_ok=True)
    return len(times)


def _refuse(path: Path, runs: list, window: Window, follow: str | None) -> None:
    if path.suffix.lower() not in FORMATS:
        raise FigureError(f'{path}: unknown film format "{path.suffix}" (allowed: {", ".join(FORMATS)})')
    if follow is not None and window is None:
        raise FigureError(f"a film that follows {follow} needs a window, with z0 and z1 measured from its leading end")
    for run in runs if follow is not None else ():
        names = [body["name"] for body in run.bodies]
        if follow not in names:
            raise FigureError(f"{run.directory}: {unknown('body', follow, names)}")


def has_ffmpeg() -> bool:
    """Whether films can be MP4: ffmpeg is installed, or imageio-ffmpeg provides it."""
    from matplotlib import animation, rcParams

    if animation.FFMpegWriter.isAvailable():
        return True
    try:
        from imageio_ffmpeg import get_ffmpeg_exe

        rcParams["animation.ffmpeg_path"] = get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        return False
    return True


def _writer(path: Path, rate: float):
    """The matplotlib writer of a format. Raises FigureError if ffmpeg is missing."""
    from matplotlib import animation

    if FORMATS[path.suffix.lower()] == "pillow":
        return animation.PillowWriter(fps=rate)
    if not has_ffmpeg():
        raise FigureError(f"{path}: ffmpeg is not installed: pip install 'hydro2d[movie]'; a .gif does not need it")
    return animation.FFMpegWriter(fps=rate, extra_args=["-pix_fmt", "yuv420p", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2"])


class _Window:
    """The window of each run, which may travel."""

    def __init__(self, runs: list, window: Window, follow: str | None):
        self.window, self.follow = window, follow
        self.last: dict[int, Window] = {}
        self.down = {id(run): self._flies_down(run) for run in runs} if follow is not None else {}

    def _flies_down(self, run) -> bool:
        velocity = next(body.get("velocity", 0.0) for body in run.bodies if body["name"] == self.follow)
        axial = velocity[-1] if isinstance(velocity, list) and velocity else velocity
        return isinstance(axial, (int, float)) and axial < 0.0

    def of(self, run, dump: Dump) -> Window:
        """The window of a run at the time of a dump; the last one if the body is gone."""
        if self.follow is None:
            return self.window
        fraction = dump.fields[f"Volume Fraction for {self.follow}"]
        rows = np.nonzero((fraction >= 0.5).any(axis=1))[0]
        if len(rows) == 0:
            return self.last.get(id(run))
        end = dump.z_edges[rows[0]] if self.down[id(run)] else dump.z_edges[rows[-1] + 1]
        z0, z1, r1 = self.window
        self.last[id(run)] = (end - z1, end - z0, r1) if self.down[id(run)] else (end + z0, end + z1, r1)
        return self.last[id(run)]


def _ranges(runs: list, times: list[float], words: list[str], shown: _Window) -> dict[str, tuple[float, float]]:
    """One colour range for each field, from all frames."""
    ranges: dict[str, tuple[float, float]] = {}
    for word, dump in _seen(runs, times, words, shown):
        low, high = LINEAR.limits([figures.chosen(dump, word).values])
        before = ranges.get(word, (low, high))
        ranges[word] = (min(low, before[0]), max(high, before[1]))
    return {word: balanced(*ends) for word, ends in ranges.items()}


def _seen(runs: list, times: list[float], words: list[str], shown: _Window) -> Iterator[tuple[str, Dump]]:
    for run in runs:
        for time in times:
            dump = run.dump(time)
            part = figures.cropped(dump, shown.of(run, dump))
            for word in dict.fromkeys(words):
                if word != "material":
                    yield word, part
