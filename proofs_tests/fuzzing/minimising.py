"""Small inputs out of large ones, and others out of small ones."""

import random
from collections.abc import Callable, Sequence

__all__ = ["minimised", "mutated"]

_INTERESTING = (b"\0", b"\xff", b"0", b"9", b"-", b"\n", b" ", b".", b"1e999", b"\x80", b"4294967296", b"\xc3\xa9")


def minimised(data: bytes, is_bad: Callable[[bytes], bool], tries: int = 1500) -> bytes:
    """Return a short input that is bad as well: pieces are taken out, then bytes become zeros, as long as it is.

    Greedy, with pieces that are halved: at most ``tries`` inputs are asked about.
    """
    left = [tries]

    def is_still_bad(candidate: bytes) -> bool:
        left[0] -= 1
        return left[0] >= 0 and is_bad(candidate)

    size = max(len(data) // 2, 1)
    while True:
        at, before = 0, len(data)
        while at < len(data):
            shorter = data[:at] + data[at + size :]
            if is_still_bad(shorter):
                data = shorter
            else:
                at += size
        if (size == 1 and len(data) == before) or left[0] < 0:
            break
        size = max(size // 2, 1)
    for at in range(len(data)):
        for simple in (b"0", b"\0"):
            plainer = data[:at] + simple + data[at + 1 :]
            if data[at : at + 1] not in (b"0", b"\0") and is_still_bad(plainer):
                data = plainer
    return data


def mutated(seeds: Sequence[bytes], words: Sequence[bytes], chance: random.Random) -> bytes:
    """Return one of the seeds with one to four changes: bytes, pieces, words, a part of another seed."""
    data = bytearray(chance.choice(seeds))
    for _ in range(chance.randint(1, 4)):
        _change(data, seeds, words, chance)
    return bytes(data)


def _change(data: bytearray, seeds: Sequence[bytes], words: Sequence[bytes], chance: random.Random) -> None:
    at, length = chance.randint(0, len(data)), chance.choice((1, 1, 2, 4, 9, 30))
    way = chance.randrange(7)
    if way == 0 and at < len(data):
        data[at] ^= 1 << chance.randrange(8)
    elif way == 1 and at < len(data):
        data[at] = chance.randrange(256)
    elif way == 2:
        del data[at : at + length]
    elif way == 3:
        data[at:at] = data[at : at + length]
    elif way == 4:
        data[at : at + chance.choice((0, length))] = chance.choice((*_INTERESTING, *words))
    elif way == 5:
        other = chance.choice(seeds)
        start = chance.randint(0, len(other))
        data[at : at + length] = other[start : start + length]
    else:
        del data[at:]
