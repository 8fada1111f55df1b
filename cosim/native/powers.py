"""Powers of ten for the conversion of doubles to text in decimal.c."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

#: The powers that the exponents of doubles call for, as in decimal.h.
SMALLEST, LARGEST = -292, 324


def powers_of_ten() -> npt.NDArray[np.uint64]:
    """The 128 leading bits of every power of ten, rounded up.

    Returns:
        High and low word of 10^k 2^(127 - floor(log2(10^k))), shape (powers, 2).

    Source: R. Giulietti, "The Schubfach way to render doubles" (2021), section 9.

    >>> [hex(int(word)) for word in powers_of_ten()[1 - SMALLEST]]
    ['0xa000000000000000', '0x0']
    """
    words = [divmod(_leading_bits(k), 1 << 64) for k in range(SMALLEST, LARGEST + 1)]
    return np.array(words, dtype=np.uint64)


def _leading_bits(exponent: int) -> int:
    power: int = 10 ** abs(exponent)
    if exponent >= 0:
        excess = power.bit_length() - 128
        return power << -excess if excess <= 0 else -(-power >> excess)
    # 1 / power lies between 2^-bits and 2^(1 - bits)
    return -(-(1 << (127 + power.bit_length())) // power)
