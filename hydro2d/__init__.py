"""hydro2d: a small, CTH-like, two-dimensional axisymmetric Eulerian hydrocode for rod-into-plate impact."""

__version__ = "0.1.0"


def register(*models):
    """Makes models from outside known: paths of files, or names of models that installed packages give.

    A deck that is loaded registers its own; this is for a process that loads the kernels before the deck. Raises
    hydro2d.materials.outside.ModelError for a model that is wrong, or that comes after the kernels are loaded.
    """
    from hydro2d.materials import outside

    outside.register(*models)


def load(directory):
    """The results of a run: summary, history, dumps, sections. See `hydro2d.results.reading.Results`.

    directory : path of a run directory; `hydro2d.study.load` reads a study

    Raises hydro2d.results.reading.ResultsError.
    """
    from hydro2d.results import reading

    return reading.load(directory)
