"""Studies: many runs from one file, on any number of machines, read back together, and the page that reports them."""


def load(directory):
    """A study directory, a run directory or a folder of runs, read back. See `hydro2d.study.layout.load`."""
    from hydro2d.study.layout import load as read

    return read(directory)
