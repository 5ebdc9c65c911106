"""The command `hydro2d diverge`: where and when two runs diverge."""

from __future__ import annotations

from pathlib import Path

from hydro2d.base.terminal import say
from hydro2d.cli.base import Out, UsageError, import_matplotlib


def diverge(
    first: Path,
    second: Path,
    *,
    size: float = 0.01,
    field: list[str] | None = None,
    out: Out | None = None,
    csv: Path | None = None,
) -> int:
    """Shows where and when two runs diverge, and how fast their difference grows.

    Both runs are of one deck, but differ by chance or by a small change. Depth, length, velocity and fields are compared, each
    relative to its largest value.

    Example: hydro2d diverge runs/a runs/b --size 0.001 -o apart.png

    Parameters
    ----------
    first
        Run directory.
    second
        Run directory with the same mesh.
    size
        Relative difference from which the runs count as diverged; the growth time is fitted up to it.
    field
        Field to compare, as `hydro2d info` names it; can be repeated. Default: velocity, pressure, density, plastic_strain.
    out
        Picture of the differences against time, on a logarithmic scale.
    csv
        The differences as CSV.
    """
    if not 0.0 < size < 1.0:
        raise UsageError(f"--size {size:g}: must lie between 0 and 1, a difference relative to the largest value")
    from hydro2d.results.reading import Results
    from hydro2d.study.report import divergence

    comparison = divergence.compare(Results(first), Results(second), field or ())
    for line in comparison.lines(size):
        say(line)
    if csv is not None:
        divergence.write_csv(comparison, csv)
        say(f"wrote {csv}")
    if out is not None:
        import_matplotlib()
        from hydro2d.results import figures

        figures.save_figure(divergence.figure(comparison, size), out)
        say(f"wrote {out}")
    return 0
