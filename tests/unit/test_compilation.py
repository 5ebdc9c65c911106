"""A run says that kernels are being compiled when they are, once, and not when they come from the cache."""

import numba

from hydro2d.compilation import announced


def test_what_is_compiled_is_said():
    inner = numba.njit(lambda x: x + 1)
    outer = numba.njit(lambda x: inner(x) * 2)
    said = []
    with announced(said.append) as compiled:
        assert said == []
        assert outer(1.0) == 4.0
        assert len(said) == 1
        assert said[0].startswith("compiling")
        compiled.report()
        assert said[1].startswith("compiled 1 kernel in ")
        outer(2.0)
    assert len(said) == 2
    numba.njit(lambda x: x)(1.0)  # outside: nobody listens
    assert len(said) == 2


def test_silence_where_nothing_is_compiled():
    compiled, said = numba.njit(lambda x: x + 3), []
    compiled(1.0)
    with announced(said.append):
        compiled(2.0)
    assert said == []
