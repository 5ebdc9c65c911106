"""The exponents of imploding shocks against printed ones."""

import pytest

from problems.verification.exact.guderley import exponent

#: Ramsey, Kamm and Bolstad, Int. J. Comput. Fluid Dyn. 26 (2012) 79, as used in ExactPack's tests
PRINTED = [(2, 1.4, 0.835323192), (2, 5 / 3, 0.815624901), (2, 3.0, 0.775666619), (3, 1.4, 0.717174501),
           (3, 5 / 3, 0.688376823), (3, 2.0, 0.667046070), (3, 3.0, 0.636410594), (3, 6.0, 0.610339148)]


@pytest.mark.thorough
@pytest.mark.parametrize(("j", "gamma", "alpha"), PRINTED)
def test_printed_exponents(j, gamma, alpha):
    assert exponent(j, gamma) == pytest.approx(alpha, abs=2e-9)
