"""`python -m hydro2d` is the command `hydro2d`."""

from .cli import main

if __name__ == "__main__":
    main()
