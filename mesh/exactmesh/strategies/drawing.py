"""What the strategies draw: many numbers by one choice, and a seed that scatters them."""

import numpy as np
import numpy.typing as npt
from hypothesis import reject
from hypothesis import strategies as st

from exactkernel.errors import shown
from exactkernel.types import FloatArray
from exactmesh.errors import OptionError

__all__ = [
    "Words",
    "bits_for",
    "check_integer",
    "check_sizes",
    "codes",
    "distinct",
    "heights",
    "lattice",
    "scattered",
    "seeds",
    "shuffled",
    "units",
]

#: Numbers without sign: hashes wrap.
Words = npt.NDArray[np.uint64]

#: Zero, to which they shrink, stands for "as they are".
seeds = st.integers(0, 2**16)


def check_sizes(min_size: int, max_size: int, least: int = 0) -> None:
    """Refuse sizes that no strategy can keep.

    Raises:
        OptionError: they are no integers, negative, below the least possible, or in the wrong order.
    """
    check_integer("min_size", min_size)
    check_integer("max_size", max_size)
    if min_size < 0:
        raise OptionError(f"min_size={min_size} is negative")
    if max_size < min_size:
        raise OptionError(f"max_size={max_size} is below min_size={min_size}")
    if max_size < least:
        raise OptionError(f"max_size={max_size}: {least} points are needed")


def check_integer(name: str, value: object) -> None:
    """Refuse what is no integer.

    Raises:
        OptionError: it is none, or a bool.
    """
    if isinstance(value, bool) or not isinstance(value, int):
        raise OptionError(f"{name}={shown(value)} is no integer")


def words(min_size: int, max_size: int) -> st.SearchStrategy[Words]:
    """Draw numbers below 256. They shrink to zeros.

    Hypothesis generates and shrinks bytes as one choice; fifty integers would be fifty choices, and five times as slow.
    """
    return st.binary(min_size=min_size, max_size=max_size).map(_words_of)


def _words_of(drawn: bytes) -> Words:
    return np.frombuffer(drawn, dtype=np.uint8).astype(np.uint64)


@st.composite
def heights(draw: st.DrawFn, min_size: int, max_size: int) -> npt.NDArray[np.int64]:
    """Draw numbers from 0, small ones or up to 2^20."""
    drawn = draw(words(min_size, max_size)).astype(np.int64)
    span = draw(st.sampled_from((8, 64, 256)))
    return drawn % span if span < 256 else 16 * drawn * drawn


def codes(min_size: int, max_size: int) -> st.SearchStrategy[Words]:
    """Draw distinct numbers, hardly larger than they have to be, as one choice. They shrink to 0, 1, 2, ..."""
    return words(min_size, max_size).map(_spread)


def _spread(drawn: Words) -> Words:
    order = np.argsort(drawn, kind="stable")
    steps = np.arange(len(drawn))
    spread = np.empty_like(drawn)
    spread[order] = np.maximum.accumulate(drawn[order].astype(np.int64) - steps) + steps  # if taken, the next one
    return spread


def lattice(numbers: Words) -> FloatArray:
    """Return the cells of the plane along Morton's curve: 0, 1, 2, 3 are the corners of the unit square."""
    cells = np.stack([numbers, numbers >> np.uint64(1)], axis=1)
    cells &= np.uint64(0x5555555555555555)
    for shift, mask in (
        (1, 0x3333333333333333),
        (2, 0x0F0F0F0F0F0F0F0F),
        (4, 0x00FF00FF00FF00FF),
        (8, 0x0000FFFF0000FFFF),
    ):
        cells = (cells | cells >> np.uint64(shift)) & np.uint64(mask)
    return cells.astype(np.float64)


def scattered(seed: int, numbers: Words) -> Words:
    """Return a hash of each number, the finalizer of SplitMix64: one-to-one for a seed."""
    word = (numbers + np.uint64(seed << 32)) * np.uint64(0x9E3779B97F4A7C15)
    word = (word ^ word >> np.uint64(30)) * np.uint64(0xBF58476D1CE4E5B9)
    word = (word ^ word >> np.uint64(27)) * np.uint64(0x94D049BB133111EB)
    return word ^ word >> np.uint64(31)


def units(seed: int, numbers: Words, bits: int) -> FloatArray:
    """Return a point with coordinates k 2^-bits in [0, 1) for each number, (n, 2)."""
    pairs = np.stack([numbers << np.uint64(1), numbers << np.uint64(1) | np.uint64(1)], axis=1)
    return np.ldexp((scattered(seed, pairs) >> np.uint64(64 - bits)).astype(np.float64), -bits)


def bits_for(size: int, least: int = 1) -> int:
    """Return how many bits a coordinate needs for that many random points hardly ever to coincide."""
    return min(53, max(least, 2 * size.bit_length() + 4))


def shuffled(seed: int, size: int) -> Words:
    """Return a permutation; in order for the seed 0."""
    numbers = np.arange(size, dtype=np.uint64)
    return numbers if seed == 0 else np.argsort(scattered(seed, numbers)).astype(np.uint64)


def distinct(points: FloatArray) -> FloatArray:
    """Return the points; where two coincide, which is rare, tell hypothesis to draw others."""
    if len(points) > 1:
        ranked = np.sort((points + 0.0).view(np.complex128).ravel())  # + 0.0: there is one zero
        if (ranked[1:] == ranked[:-1]).any():
            reject()
    return points
