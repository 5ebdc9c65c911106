"""hydro2d: a small, CTH-like, two-dimensional axisymmetric Eulerian hydrocode for rod-into-plate impact."""

__version__ = "0.1.0"


def load(directory):
    """The results of a run: summary, history, dumps, sections. See `hydro2d.results.reading.Results`.

    directory : path of a run directory; `hydro2d.study.load` reads a study

    Raises hydro2d.results.reading.ResultsError.
    """
    from hydro2d.results import reading

    return reading.load(directory)
