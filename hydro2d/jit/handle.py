"""A handle: one word in place of a hundred arguments, by which compiled code finds arrays and numbers by name.

The word is the address of a table with eight words for each name: the address and the shape of an array, or a number. In
compiled code the names are attributes of the handle, ``w.u[b, j, i]`` and ``w.dt``, with types that `declare` fixes; in
Python a `Handle` fills the table and reads it. The table is an array of the handle itself, in two views, by which a kernel
marked `control` sets numbers.
"""

from __future__ import annotations

import llvmlite.ir as ir
import numba
import numpy as np
from numba import types
from numba.core.imputils import lower_getattr_generic
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import intrinsic, models, register_model
from numba.np import arrayobj

#: words of a row of the table: the address of an array and its shape, or a number
WORDS = 8

#: types accepted as a number of each kind
NUMBERS: dict[type, tuple[type, ...]] = {float: (float, int, np.floating), int: (int, np.integer), bool: (bool, np.bool_)}

#: names of the table itself, as whole numbers and as floats
TABLE = {int: "words", float: "numbers"}

#: row, kind and number of axes of every name
_rows: dict[str, tuple[int, type, int]] = {"words": (0, int, 2), "numbers": (1, float, 2)}


def declare(names: dict[str, tuple[type, int]]) -> None:
    """Declares names of handles: the kind of number that a name stands for (float, int, bool, numpy.int8), and its axes.

    Compiled code contains the row of a name and its type, so names must be declared in a file that all compiled code using
    them imports.

    Raises ValueError for a name that is declared already.
    """
    for name, (kind, axes) in names.items():
        if name in _rows:
            raise ValueError(f"the name {name} is declared twice")
        _rows[name] = len(_rows), kind, axes


def declared() -> dict[str, tuple[type, int]]:
    """Kind and number of axes of every name."""
    return {name: (kind, axes) for name, (_, kind, axes) in _rows.items()}


def row_of(name: str) -> int:
    """The row of a name in the table."""
    return _rows[name][0]


class Handle:
    """Values by their names, as compiled code finds them in the table.

    Attributes
    ----------
    address : int, of the table
    words : int64[rows, WORDS], the table
    """

    def __init__(self):
        self.words = np.zeros((len(_rows), WORDS), dtype=np.int64)
        self._floats = self.words.view(np.float64)
        #: the arrays by kind, address and shape, and the names that have a value
        self._arrays: dict[tuple, np.ndarray] = {}
        self._known: set[str] = set()
        self.address: int = self.words.ctypes.data
        self.update(words=self.words, numbers=self._floats)

    def update(self, **values) -> None:
        """Sets the values of names.

        Raises KeyError for a name that is not declared, TypeError for a value of another type, axes or order in memory.
        """
        for name, value in values.items():
            row, kind, axes = _rows[name]
            if axes:
                if not (isinstance(value, np.ndarray) and value.dtype == kind and value.ndim == axes
                        and value.flags.c_contiguous):
                    raise TypeError(f"{name} is an array of {np.dtype(kind)} with {axes} axes, in the order of C, "
                                    f"not {value!r:.80}")
                place = value.__array_interface__["data"][0], *value.shape
                before = self._place(name)
                self.words[row, : 1 + axes] = place
                self._arrays[kind, *place] = value
                if before != self._place(name) and before[1] not in self.words[:, 0]:
                    self._arrays.pop(before, None)
            elif not isinstance(value, NUMBERS[kind]):
                raise TypeError(f"{name} is a number, {kind.__name__}, not {value!r:.80}")
            else:
                (self._floats if kind is float else self.words)[row, 0] = value
            self._known.add(name)

    def exchange(self, name: str, partner: str) -> None:
        """Exchanges the values of a name and of its partner, which is of the same type."""
        here, there = row_of(name), row_of(partner)
        self.words[[here, there]] = self.words[[there, here]]

    def _place(self, name: str) -> tuple:
        """Kind, address and shape of the array of a name, as the table has them."""
        row, kind, axes = _rows[name]
        return kind, *self.words[row, : 1 + axes].tolist()

    @property
    def values(self) -> dict[str, object]:
        """The arrays and numbers, by name."""
        return {name: getattr(self, name) for name in _rows if name in self._known}

    def __getattr__(self, name: str):
        if name.startswith("_") or name not in self._known:
            raise AttributeError(name)
        row, kind, axes = _rows[name]
        if axes:
            return self._arrays[self._place(name)]
        return kind((self._floats if kind is float else self.words)[row, 0])


class _HandleType(types.Type):
    """The type of a handle in compiled code."""

    def __init__(self):
        super().__init__(name="hydro2d handle")


handle_type = _HandleType()


@register_model(_HandleType)
class _HandleModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, ir.IntType(64))


def _type_of(kind: type, axes: int):
    scalar = numba.from_dtype(np.dtype(kind))
    return types.Array(scalar, axes, "C") if axes else scalar


@infer_getattr
class _HandleAttributes(AttributeTemplate):
    key = _HandleType

    def generic_resolve(self, handle, name):
        if name in _rows:
            return _type_of(*_rows[name][1:])
        return None


@lower_getattr_generic(_HandleType)
def _look_up(context, builder, handle, value, name):
    """Reads a row of the table, marked for the compiler as unchanging: it is not written while compiled code runs."""
    row, kind, axes = _rows[name]
    numba_type, word = _type_of(kind, axes), ir.IntType(64)
    table = builder.inttoptr(value, word.as_pointer())

    def read(place: int, as_type=word):
        pointer = builder.gep(table, [ir.Constant(word, row * WORDS + place)])
        load = builder.load(builder.bitcast(pointer, as_type.as_pointer()) if as_type is not word else pointer)
        load.set_metadata("invariant.load", builder.module.add_metadata([]))
        return load

    if not axes:
        if kind is bool:
            return builder.icmp_signed("!=", read(0), ir.Constant(word, 0))
        return read(0, context.get_value_type(numba_type))
    array = arrayobj.make_array(numba_type)(context, builder)
    size = context.get_abi_sizeof(context.get_data_type(numba_type.dtype))
    shape = [read(1 + axis) for axis in range(axes)]
    strides, step = [], ir.Constant(word, size)
    for length in reversed(shape):
        strides.insert(0, step)
        step = builder.mul(step, length, flags=["nsw"])
    arrayobj.populate_array(array, data=builder.inttoptr(read(0), context.get_data_type(numba_type.dtype).as_pointer()),
                            shape=shape, strides=strides, itemsize=ir.Constant(word, size), meminfo=None)
    return array._getvalue()


@intrinsic
def as_handle(context, address):
    """The handle whose table has this address."""

    def code(context, builder, signature, arguments):
        return arguments[0]

    return handle_type(types.int64), code


@intrinsic
def call_at(context, function, part, address):
    """Calls compiled code at an address with two numbers, as C does."""

    def code(context, builder, signature, arguments):
        word = ir.IntType(64)
        kind = ir.FunctionType(ir.VoidType(), [word, word])
        builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), arguments[1:])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, types.int64), code
