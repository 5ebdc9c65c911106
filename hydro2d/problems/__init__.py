"""The shipped decks and materials as a package: in a checkout they lie in the folder `problems` beside `hydro2d`."""

from hydro2d.files.shipped import problems_folder

__path__ = [str(problems_folder())]
