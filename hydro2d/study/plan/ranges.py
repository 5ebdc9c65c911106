"""Values of a range, exact in decimals: 0.1, 0.2, 0.3 and "900 m/s", "950 m/s", as they would be written by hand."""

from __future__ import annotations

from decimal import Decimal, InvalidOperation

from hydro2d.study.plan.definition import Range

#: the most values of one axis, and the most cases of a study
MOST = 10_000


def _split(value, key: str) -> tuple[Decimal, str]:
    """Number and unit."""
    number, _, unit = str(value).strip().partition(" ")
    try:
        decimal = Decimal(number)
    except InvalidOperation:
        decimal = Decimal("nan")
    if isinstance(value, bool) or not decimal.is_finite():
        raise ValueError(f'{key} = {value!r}: expected a number, or a string with number and unit such as "900 m/s"')
    return decimal, unit.strip()


def values(given: Range) -> list[int | float | str]:
    """All values of a range. Raises ValueError if it never ends or has too many values."""
    parts = {"from": given.from_, "to": given.to} | ({} if given.step is None else {"step": given.step})
    split = {key: _split(value, key) for key, value in parts.items()}
    units = {unit for _, unit in split.values()}
    if len(units) > 1:
        raise ValueError(f"{', '.join(parts)} must have the same unit; given: {', '.join(sorted(units or '-'))}")
    first, last = split["from"][0], split["to"][0]
    numbers = _stepped(first, last, split["step"][0]) if "step" in split else _counted(first, last, given.count)
    whole = all(isinstance(value, int) for value in parts.values()) and all(n == n.to_integral() for n in numbers)
    (unit,) = units
    return [_written(number, unit, whole) for number in numbers]


def _stepped(first: Decimal, last: Decimal, step: Decimal) -> list[Decimal]:
    if step == 0 or (last - first) * step < 0:
        raise ValueError(f"never ends: from {first} to {last} by steps of {step}")
    count = int((last - first) / step) + 1
    return [first + n * step for n in range(_few(count))]


def _counted(first: Decimal, last: Decimal, count: int) -> list[Decimal]:
    if first == last:
        raise ValueError(f"from and to are both {first}")
    return [first + (last - first) * n / (count - 1) for n in range(_few(count))]


def _few(count: int) -> int:
    if count > MOST:
        raise ValueError(f"has {count} values; at most {MOST} are allowed")
    return count


def _written(number: Decimal, unit: str, whole: bool) -> int | float | str:
    if unit:
        return f"{float(number):.12g} {unit}"
    return int(number) if whole else float(f"{float(number):.12g}")
