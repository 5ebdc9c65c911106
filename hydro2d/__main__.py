"""`python -m hydro2d` is the command `hydro2d`."""

from hydro2d.cli.main import main

if __name__ == "__main__":
    main()
