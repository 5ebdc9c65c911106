"""The format of compiled code on disk: one file for each function and the types of its arguments.

A file is a line with the form and a checksum of its name and the rest, then the code as numba pickles it. Code that does not
match its checksum is never unpickled: it is compiled anew, and a line says so. A place that cannot be written, or has no room
left, only costs time, and a line says so once.

numba's own cache keeps an index next to the code, in which two processes can give one name to two functions, has no checksums,
and ends the run if a file is damaged. It also keeps a text of a third of a file's size, with the path of the source in it,
that only reports of its compiler need.
"""

from __future__ import annotations

import functools
import hashlib
import os
import pickle
import re
import warnings
from pathlib import Path

from numba.core import caching, compiler, serialize, sigutils

from hydro2d.files.strange import StrangeFile, own
from hydro2d.files.whole import replacing
from hydro2d.jit import cache, shipped

#: the first word of every file, and its ending
FORM, ENDING = b"hydro2d-code-1", ".code"
#: letters of a function's name in that of its file
MOST_NAME = 120


class DamagedFile(Exception):
    """A file of compiled code that differs from the one written."""


class Kept(caching._Cache):
    """The compiled code of one function, as numba's dispatcher asks for it.

    folders : those searched, in this order; newly compiled code is kept in the last
    """

    def __init__(self, function, *folders: Path):
        self._function, self._folders, self._enabled = function, folders, True

    @property
    def cache_path(self) -> str:
        return str(self._folders[-1])

    def enable(self) -> None:
        self._enabled = True

    def disable(self) -> None:
        self._enabled = False

    def flush(self) -> None:
        """Removes the kept code of the function."""
        for file in self._folders[-1].glob(f"{_name(self._function)}.*{ENDING}"):
            file.unlink(missing_ok=True)

    def file_name(self, types) -> str:
        """The name of the file for these types of the arguments."""
        code, (arguments, _) = self._function.__code__, sigutils.normalize_signature(types)
        digest = hashlib.sha256(_text_hash(code.co_filename).encode())
        digest.update(repr((self._function.__qualname__, code.co_firstlineno, arguments)).encode())
        if self._function.__closure__:
            digest.update(serialize.dumps(tuple(cell.cell_contents for cell in self._function.__closure__)))
        return f"{_name(self._function)}.{digest.hexdigest()[:24]}{ENDING}"

    def has(self, types) -> bool:
        """Whether there is a file for these types of the arguments."""
        name = self.file_name(types)
        return self._enabled and any(os.path.isfile(folder / name) for folder in self._folders)

    def load_overload(self, sig, target_context):
        """The compiled function for these types, None if there is none that can be used."""
        target_context.refresh()
        if not self._enabled:
            return None
        name = self.file_name(sig)
        for folder in self._folders:
            try:
                return _rebuilt(folder / name, target_context)
            except (FileNotFoundError, NotADirectoryError):
                pass
            except DamagedFile as problem:
                cache.say_once(f"{folder / name} is damaged ({problem}): the function is compiled anew")
            except OSError as problem:
                cache.say_once(f"{folder} cannot be read ({problem.strerror}): what it keeps is compiled anew")
        shipped.say_if_unused()
        return None

    def save_overload(self, sig, data) -> None:
        """Keeps a compiled function."""
        if not self._enabled:
            return
        if data.lifted or data.library.has_dynamic_globals:
            warnings.warn(f"{self._function.__qualname__} is not kept: it has addresses of this process in it", stacklevel=2)
            return
        file = self._folders[-1] / self.file_name(sig)
        code = serialize.dumps(data._replace(type_annotation="")._reduce())
        with cache.kept_if_possible():
            file.parent.mkdir(parents=True, exist_ok=True)
            with replacing(file) as temporary:
                temporary.write_bytes(b"%s %s\n" % (FORM, _checksum(file, code)) + code)


def _rebuilt(file: Path, target_context):
    """The compiled function in a file. Raises OSError and DamagedFile."""
    try:
        data = own(file, links=True).read_bytes()
    except (StrangeFile, IsADirectoryError):
        raise DamagedFile("it is no file") from None
    head, _, code = data.partition(b"\n")
    if not re.fullmatch(FORM + rb" [0-9a-f]{64}", head):
        raise DamagedFile("it does not begin as such a file does" if data else "it is empty")
    if head.split()[1] != _checksum(file, code):
        raise DamagedFile("its checksum does not match")
    try:
        return compiler.CompileResult._rebuild(target_context, *pickle.loads(code))
    except Exception as problem:
        raise DamagedFile(f"numba cannot read it: {type(problem).__name__}: {problem}") from problem


def _checksum(file: Path, code: bytes) -> bytes:
    """A checksum of the code and the name of its file, which names the function and types."""
    return hashlib.sha256(file.name.encode() + b"\n" + code).hexdigest().encode()


def _name(function) -> str:
    """The readable part of a file's name."""
    code = function.__code__
    words = f"{Path(code.co_filename).stem}.{function.__qualname__}".replace("<", "").replace(">", "")
    return f"{words[:MOST_NAME]}-{code.co_firstlineno}"


@functools.cache
def _text_hash(file: str) -> str:
    """A hash of the text that contains a function."""
    text = cache.generated(file)
    return hashlib.sha256(Path(file).read_bytes() if text is None else text.encode()).hexdigest()
