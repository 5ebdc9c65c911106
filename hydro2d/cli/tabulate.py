"""The command `hydro2d tabulate`: a table of the SESAME type 301 from another equation of state."""

from __future__ import annotations

from hydro2d.base.terminal import say
from hydro2d.cli.base import Out, UsageError, quantity

#: default range of densities over that at rest, largest temperature in K, and the numbers of both
DENSITIES, HOTTEST = (0.8, 3.0), 20000.0
NUMBERS = 151, 101
#: smallest and largest number of points
LEAST, MOST = 3, 1000


def tabulate(material: str, *, out: Out, density: str | None = None, temperature: str | None = None) -> int:
    """Writes the equation of state of a material as a table of the SESAME type 301, and prints its range.

    Example: hydro2d tabulate Al_tillotson -o aluminium.301 --density "2.2 g/cm^3:8 g/cm^3:201" --temperature "30000 K:101"

    Parameters
    ----------
    material
        Material of the library, NAME or NAME:VARIANT, whose equation of state has no internal variables.
    out
        File of the table.
    density
        Smallest and largest density, and the number of densities, in equal ratios, as LOW:HIGH:NUMBER; the density at rest is
        among them. Default: 0.8 to 3 times the density at rest, 151 densities.
    temperature
        Largest temperature and the number of temperatures from zero on, as HIGH:NUMBER; the temperature at rest is among them.
        Default: 20000 K and 101.
    """
    from hydro2d.files.whole import write_text
    from hydro2d.materials import library, sesame, tabulate

    chosen = library.load(material)
    rest, at_rest = chosen.reference_density, chosen.eos.numbers.get("reference_temperature")
    T = at_rest.value if at_rest else 0.0
    (low, high), rows = _range("--density", density, "kg/m^3", 2) or (
        tuple(share * rest for share in DENSITIES), NUMBERS[0])
    (hottest,), columns = _range("--temperature", temperature, "K", 1) or ((HOTTEST,), NUMBERS[1])
    if not 0.0 < low < rest < high:
        raise UsageError(f"--density {low:g} to {high:g} kg/m^3: must have {rest:g}, the density at rest, between its ends")
    if not T < hottest:
        raise UsageError(f"--temperature {hottest:g} K: must be above {T:g} K, the temperature at rest")
    table = tabulate.of_material(chosen, tabulate.points(low, rest, high, rows), tabulate.temperatures(T, hottest, columns))
    write_text(out, text := sesame.write(table))
    say(f"wrote {out}: {rows} densities, {columns} temperatures")
    for line in lines(sesame.read(text), rest, T):
        say(line)
    return 0


def lines(table, rest: float, T: float) -> list[str]:
    """Lines with the range of a table, and with its density and temperature at rest, kg/m^3 and K, which a deck must give."""
    from eos import tabular

    row = tabular.row({"reference_density": rest, "reference_temperature": T}, table)
    return [f"  reference_density = {rest:.8g} kg/m^3, reference_temperature = {T:g} K", f"  {tabular.span(row)}"]


def _range(option: str, text: str | None, unit: str, ends: int) -> tuple[tuple[float, ...], int] | None:
    """Ends and number of HIGH:NUMBER or LOW:HIGH:NUMBER; None without a text."""
    if text is None:
        return None
    *given, number = text.split(":")
    form = "LOW:HIGH:NUMBER" if ends == 2 else "HIGH:NUMBER"
    if len(given) != ends or not number.strip().isdecimal() or not LEAST <= int(number) <= MOST:
        raise UsageError(f"{option} {text}: expected {form}, with a NUMBER from {LEAST} to {MOST}")
    return tuple(quantity(part.strip(), unit, option) for part in given), int(number)
