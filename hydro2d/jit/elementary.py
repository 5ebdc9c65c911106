"""exp, log, x^y and erf that the compiler can evaluate for several cells at once, with the same bits as for one.

Library functions are called cell by cell, and their last bits depend on the library. These functions are products and sums
without branches or tables, in an order that the compiler does not change, so a loop around them is vectorised and the bits are
the same on every machine with IEEE arithmetic. A NaN stays a NaN.
"""

from __future__ import annotations

import math

from hydro2d.jit.bits import bits_of, from_bits
from hydro2d.jit.calls import point

#: a sum with it has the nearest integer in its last bits (Hecker 1996): 1.5 2^52
_ROUND = 6755399441055744.0
_ROUND_BITS = 0x4338000000000000
#: 2^52, and its bits
_LARGE, _LARGE_BITS = 4503599627370496.0, 0x4330000000000000
_BIAS, _FRACTION, _EXPONENT = 1023, 0x000FFFFFFFFFFFFF, 0x7FF
#: bits of sqrt(1/2) rounded down to 32 bits, and the difference from those of 1
_ROOT_BITS = 0x3FE6A09E00000000
_LIFT = 0x3FF0000000000000 - _ROOT_BITS

#: ln 2 in two parts; the first has 33 bits, so that its products with exponents are exact
_LN2_HIGH = float.fromhex("0x1.62e42feep-1")
_LN2_LOW = 1.9082149292705877e-10
_INVERSE_LN2 = 1.0 / math.log(2.0)

#: exp is 0 below the first and infinite above the second; the first is just above the logarithm of the least normal number
_LOWEST, _HIGHEST = -708.0, 709.782712893384
#: least argument for which log is computed
_LEAST = 2.2250738585072014e-308

#: 1/n!
_E2, _E3, _E4, _E5, _E6, _E7 = 1 / 2, 1 / 6, 1 / 24, 1 / 120, 1 / 720, 1 / 5040
_E8, _E9, _E10, _E11, _E12, _E13 = 1 / 40320, 1 / 362880, 1 / 3628800, 1 / 39916800, 1 / 479001600, 1 / 6227020800
#: 2/(2 n + 1)
_L1, _L2, _L3, _L4, _L5 = 2 / 3, 2 / 5, 2 / 7, 2 / 9, 2 / 11
_L6, _L7, _L8, _L9, _L10 = 2 / 13, 2 / 15, 2 / 17, 2 / 19, 2 / 21

#: coefficients of (1 + 2 x) exp(x^2) erfc(x) in powers of t = (x - K)/(x + K) (the expansion of Shepherd & Laframboise, Math.
#: Comp. 36 (1981) 249, interpolated at Chebyshev's points); K; beyond the last number erf is 1
_F0, _F1, _F2, _F3, _F4, _F5, _F6 = (
    1.2375126308378264, -0.14024059858550575, 0.0035854154857627857, 0.08227673848704045,
    -0.10880393015433062, 0.09230432122771155, -0.05869339838397541)
_F7, _F8, _F9, _F10, _F11, _F12, _F13 = (
    0.02836227674782648, -0.009746581262494456, 0.0017556295487634313, 0.0002937218341919264,
    -0.00029016639136143893, 5.162479200942778e-05, 2.241015775977701e-05)
_F14, _F15, _F16, _F17, _F18, _F19, _F20 = (
    -1.1397625287921655e-05, -1.0084713725546233e-06, 1.6939254478276176e-06, -2.7685663849700945e-08,
    -2.1321360409864602e-07, 8.512559451761331e-09, 1.7312209083118933e-08)
_ERFC_SCALE, _ERF_IS_1 = 3.75, 6.0


@point
def exp(x):
    """e^x, wrong by at most 2^-52 of it: 0 below -708, where it is under 3.4e-308, and infinite above 709.78.

    x = k ln 2 + r with |r| <= ln(2)/2, and the series of e^r up to r^13.
    """
    shifted = x * _INVERSE_LN2 + _ROUND
    k = shifted - _ROUND
    r = (x - k * _LN2_HIGH) - k * _LN2_LOW
    r2 = r * r
    r4 = r2 * r2
    low = (_E2 + r * _E3) + r2 * (_E4 + r * _E5)
    middle = (_E6 + r * _E7) + r2 * (_E8 + r * _E9)
    high = (_E10 + r * _E11) + r2 * (_E12 + r * _E13)
    series = 1.0 + (r + r2 * ((low + r4 * middle) + (r4 * r4) * high))
    half = from_bits((bits_of(shifted) - _ROUND_BITS + (_BIAS - 1)) << 52)  # 2^(k - 1), which never overflows
    value = series * half * 2.0
    value = 0.0 if x < _LOWEST else value
    return math.inf if x > _HIGHEST else value


@point
def log(x):
    """ln x, wrong by at most 2^-52 of it: minus infinity at 0 and for subnormal numbers, NaN below.

    x = 2^k (1 + f) with sqrt(1/2) <= 1 + f < sqrt(2), and ln(1 + f) = 2 artanh(f/(2 + f)), whose series runs to the 21st
    power. f - f^2/2 is separated from it, since f is exact.
    """
    lifted = bits_of(x) + _LIFT
    k = from_bits(((lifted >> 52) & _EXPONENT) | _LARGE_BITS) - (_LARGE + _BIAS)
    f = from_bits((lifted & _FRACTION) + _ROOT_BITS) - 1.0
    s = f / (2.0 + f)
    z = s * s
    z2 = z * z
    z4 = z2 * z2
    low = (_L1 + z * _L2) + z2 * (_L3 + z * _L4)
    high = (_L5 + z * _L6) + z2 * (_L7 + z * _L8) + z4 * (_L9 + z * _L10)
    half = 0.5 * f * f
    rest = (s * half + k * _LN2_LOW) + (s * z) * (low + z4 * high)
    value = k * _LN2_HIGH + (f - (half - rest))
    below = -math.inf if x >= 0.0 else math.nan
    value = value if x >= _LEAST else below
    return x if x == math.inf else value


@point
def power(x, y):
    """x^y for x >= 0, wrong by at most (1 + |y ln x|) 2^-52 of it; subnormal x counts as 0; 0^0 and x < 0 give NaN."""
    return exp(y * log(x))


@point
def erf(x):
    """The error function of x >= 0, wrong by at most 2^-47."""
    t = (x - _ERFC_SCALE) / (x + _ERFC_SCALE)
    t3 = t * t * t
    t7 = t3 * t3 * t
    low = _F0 + t * (_F1 + t * (_F2 + t * (_F3 + t * (_F4 + t * (_F5 + t * _F6)))))
    middle = _F7 + t * (_F8 + t * (_F9 + t * (_F10 + t * (_F11 + t * (_F12 + t * _F13)))))
    high = _F14 + t * (_F15 + t * (_F16 + t * (_F17 + t * (_F18 + t * (_F19 + t * _F20)))))
    series = low + t7 * (middle + t7 * high)
    return 1.0 if x > _ERF_IS_1 else 1.0 - exp(-x * x) * series / (1.0 + 2.0 * x)
