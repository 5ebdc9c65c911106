"""Studies: many runs from one file, on any number of machines, and their directory read back."""


def load(directory):
    """A study directory: title, axes, cases with their status. See `hydro2d.study.layout.Study`.

    directory : path of a study directory
    """
    from hydro2d.study import layout

    return layout.load(directory)
