"""Low-discrepancy sequences in the unit cube."""

import numpy as np

from ravemj.core.transforms import Floats, Ints


def halton(first: int, count: int, dimensions: int) -> Floats:
    """Return ``count`` points of Halton's sequence from the index ``first``, in the prime bases 2, 3, 5, ...

    Point 0 is the origin. The shape is (count, dimensions), and values are in [0, 1).

    Source: J. H. Halton, On the efficiency of certain quasi-random sequences of points, 1960.
    """
    places = np.arange(first, first + count)
    return np.column_stack([_radical_inverse(places, base) for base in _primes(dimensions)]).reshape(count, dimensions)


def _radical_inverse(places: Ints, base: int) -> Floats:
    """Return the radical inverse of indices: their digits mirrored at the radix point."""
    mirrored, weight, rest = np.zeros(len(places)), 1.0 / base, places.copy()
    while rest.any():
        mirrored += rest % base * weight
        rest //= base
        weight /= base
    return mirrored


def _primes(count: int) -> list[int]:
    primes: list[int] = []
    candidate = 2
    while len(primes) < count:
        if all(candidate % prime for prime in primes):
            primes.append(candidate)
        candidate += 1
    return primes
