"""Expressions of a deck: "depth / length0" as a formula of named numbers, whose units are checked before a run begins.

An expression has numbers, names, + - * / **, brackets and the functions of `FUNCTIONS`. Single quotes enclose quantities
with a unit, '8 mm', and names with other characters than letters, digits and underscores. Nothing is executed: Python's
parser gives the tree, and every kind of node that is not in this file is refused.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from hydro2d.base import units
from hydro2d.base.errors import unknown
from hydro2d.base.parsing import parsed

#: exponents of m, kg, s, K
Dimension = tuple[Fraction, ...]


def _dimension(*exponents: int) -> Dimension:
    return tuple(Fraction(exponent) for exponent in (*exponents, *(0,) * (4 - len(exponents))))


PURE = _dimension()
#: dimensions of the units that names can have
DIMENSIONS = {
    "1": PURE, "rad": PURE, "m": _dimension(1), "m2": _dimension(2), "m3": _dimension(3), "kg": _dimension(0, 1),
    "s": _dimension(0, 0, 1), "1/s": _dimension(0, 0, -1), "K": _dimension(0, 0, 0, 1), "m/s": _dimension(1, 0, -1),
    "m/s2": _dimension(1, 0, -2), "N": _dimension(1, 1, -2), "N s": _dimension(1, 1, -1), "J": _dimension(2, 1, -2),
    "W": _dimension(2, 1, -3), "J/kg": _dimension(2, 0, -2), "J/m2": _dimension(0, 1, -2), "Pa": _dimension(-1, 1, -2),
    "Pa s": _dimension(-1, 1, -1), "kg/m3": _dimension(-3, 1), "m3/J": _dimension(1, -1, 2),
}

#: these dimensions by units as `units` reads them
SPELLED = {re.sub(r"(?<=[a-z])(?=[23])", "^", name).replace(" ", "*"): dimension for name, dimension in DIMENSIONS.items()}

OPERATORS: dict[type, Callable[[float, float], float]] = {
    ast.Add: lambda a, b: a + b, ast.Sub: lambda a, b: a - b, ast.Mult: lambda a, b: a * b, ast.Div: lambda a, b: a / b,
    ast.Pow: lambda a, b: math.pow(a, b),
}
#: functions; those of SAME keep the unit of their arguments, sqrt gives its root, the others take and give plain numbers
FUNCTIONS: dict[str, Callable[..., float]] = {
    "abs": abs, "min": min, "max": max, "sqrt": math.sqrt, "exp": math.exp, "log": math.log, "log10": math.log10,
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "atan": math.atan,
}
SAME, CONSTANTS = ("abs", "min", "max"), {"pi": math.pi}
#: characters of an expression, and how deep its brackets may be
LONGEST, DEEPEST = 500, 30

Value = Callable[[Mapping[str, float | None]], float]


class ExpressionError(ValueError):
    """An expression that is wrong; the message is for the user."""


@dataclass(frozen=True)
class Expression:
    """A checked expression. text : as written;  names : those it uses;  dimension : of its value"""

    text: str
    names: frozenset[str]
    dimension: Dimension
    _value: Value

    def evaluate(self, numbers: Mapping[str, float | None]) -> float | None:
        """Its value in SI; None if a number is unknown or the result is undefined, as 1/0."""
        if any(numbers.get(name) is None for name in self.names):
            return None
        try:
            value = self._value(numbers)
        except (ArithmeticError, ValueError):
            return None
        return value if math.isfinite(value) else None


def parse(text: str, known: Mapping[str, str]) -> Expression:
    """Checks an expression.

    known : the names that it may use, with the unit of each, one of DIMENSIONS

    Raises ExpressionError.
    """
    if len(text) > LONGEST:
        raise ExpressionError(f"is longer than {LONGEST} characters")
    try:
        tree = parsed(text.strip(), "eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise ExpressionError(f'"{text}" is not a formula, such as "depth / length0"') from None
    parser = _Parser(text, known)
    dimension, value = parser.of(tree, 0)
    return Expression(text, frozenset(parser.names), dimension, value)


def in_words(dimension: Dimension) -> str:
    """A dimension as a unit: "m", "kg m2/s3"."""
    for name, each in DIMENSIONS.items():
        if each == dimension:
            return name
    return " ".join(f"{name}^{exponent}" for name, exponent in zip(("m", "kg", "s", "K"), dimension, strict=True) if exponent)


class _Parser:
    """Walks the tree; gives the dimension of each part and the function that computes it."""

    def __init__(self, text: str, known: Mapping[str, str]):
        self.text, self.known = text, known
        self.names: set[str] = set()

    def _part(self, node: ast.AST) -> str:
        return ast.get_source_segment(self.text.strip(), node) or self.text

    def of(self, node: ast.AST, depth: int) -> tuple[Dimension, Value]:
        if depth > DEEPEST:
            raise ExpressionError(f'"{self.text[:20]} ..." has brackets nested more than {DEEPEST} deep')
        if isinstance(node, ast.Constant):
            return self._constant(node)
        if isinstance(node, ast.Name):
            return self._name(node.id)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
            dimension, value = self.of(node.operand, depth + 1)
            sign = -1.0 if isinstance(node.op, ast.USub) else 1.0
            return dimension, lambda numbers: sign * value(numbers)
        if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
            return self._operation(node, depth)
        if isinstance(node, ast.Call):
            return self._call(node, depth)
        raise ExpressionError(f'"{self._part(node)}": a formula has numbers, names, + - * / **, brackets and the functions '
                              f"{', '.join(FUNCTIONS)}")

    def _constant(self, node: ast.Constant) -> tuple[Dimension, Value]:
        if isinstance(node.value, (int, float)) and not isinstance(node.value, bool):
            try:
                number = float(node.value)
            except OverflowError:
                raise ExpressionError(f'"{self._part(node)}" is too large') from None
            return PURE, lambda numbers: number
        if not isinstance(node.value, str):
            raise ExpressionError(f'"{self._part(node)}" is not a number')
        if node.value in self.known or not node.value[:1].isdigit():
            return self._name(node.value)
        try:
            quantity, unit = units.of_kinds(node.value, SPELLED)
        except ValueError as error:
            raise ExpressionError(str(error)) from None
        return SPELLED[unit], lambda numbers: quantity

    def _name(self, name: str) -> tuple[Dimension, Value]:
        if name in CONSTANTS:
            return PURE, lambda numbers: CONSTANTS[name]
        if name not in self.known:
            near = unknown("name", name, self.known).split(" (")[0]
            raise ExpressionError(f"{near.removesuffix('?')}; names are the columns of history.h5, crater_KEY, and where there "
                                  "is a projectile and a target short ones such as depth, length0, u and v")
        self.names.add(name)
        return DIMENSIONS[self.known[name]], lambda numbers: float(numbers[name])  # type: ignore[arg-type]

    def _operation(self, node: ast.BinOp, depth: int) -> tuple[Dimension, Value]:
        (left, a), (right, b) = self.of(node.left, depth + 1), self.of(node.right, depth + 1)
        operate = OPERATORS[type(node.op)]
        if isinstance(node.op, (ast.Add, ast.Sub)):
            self._same(node, left, right)
            dimension = left
        elif isinstance(node.op, ast.Pow):
            dimension = self._power(node, left, right, b)
        else:
            sign = 1 if isinstance(node.op, ast.Mult) else -1
            dimension = tuple(one + sign * other for one, other in zip(left, right, strict=True))
        return dimension, lambda numbers: operate(a(numbers), b(numbers))

    def _same(self, node: ast.AST, left: Dimension, right: Dimension) -> None:
        if left != right:
            raise ExpressionError(f'"{self._part(node)}": the units are {in_words(left)} and {in_words(right)}')

    def _power(self, node: ast.BinOp, left: Dimension, right: Dimension, exponent: Value) -> Dimension:
        if right != PURE:
            raise ExpressionError(f'"{self._part(node)}": an exponent is a plain number, not in {in_words(right)}')
        if left == PURE:
            return PURE
        if any(isinstance(each, (ast.Name, ast.Call)) for each in ast.walk(node.right)):
            raise ExpressionError(f'"{self._part(node)}": the exponent of a quantity with a unit must be a number')
        try:
            power = Fraction(exponent({})).limit_denominator(60)
        except (ArithmeticError, ValueError):
            raise ExpressionError(f'"{self._part(node)}": the exponent is not a number') from None
        return tuple(each * power for each in left)

    def _call(self, node: ast.Call, depth: int) -> tuple[Dimension, Value]:
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name not in FUNCTIONS or node.keywords:
            raise ExpressionError(f'"{self._part(node)}": {unknown("function", name or self._part(node.func), FUNCTIONS)}')
        arguments = [self.of(argument, depth + 1) for argument in node.args]
        several = name in ("min", "max")
        if len(arguments) < 2 if several else len(arguments) != 1:
            raise ExpressionError(f'"{self._part(node)}": {name} takes {"two or more numbers" if several else "one number"}')
        function, values = FUNCTIONS[name], [value for _, value in arguments]
        first = arguments[0][0]
        for dimension, _ in arguments[1:]:
            self._same(node, first, dimension)
        if name not in (*SAME, "sqrt") and first != PURE:
            raise ExpressionError(f'"{self._part(node)}": {name} takes a plain number, not one in {in_words(first)}')
        dimension = tuple(each / 2 for each in first) if name == "sqrt" else first
        return dimension, lambda numbers: function(*(value(numbers) for value in values))
