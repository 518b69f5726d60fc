"""Output that may be quadratic: refused before it fills the machine."""

import os
from collections.abc import Iterator

from exactmesh.crossings.segment_meetings import MeetingArrays
from exactmesh.errors import TooManyCrossingsError

__all__ = ["limited", "room_for"]

_ASSUMED = 1 << 32  # bytes, where the system does not tell


def _available() -> int:
    """Return a quarter of the machine's memory."""
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 4
    except (AttributeError, OSError, ValueError):  # not a POSIX system
        return _ASSUMED // 4


def room_for(bytes_each: int) -> int:
    """Return how many things fit into a quarter of the machine's memory."""
    return _available() // bytes_each


def limited(portions: Iterator[MeetingArrays], bytes_each: int) -> Iterator[MeetingArrays]:
    """Yield the portions as long as all meetings together fit into a quarter of the machine's memory.

    Raises:
        TooManyCrossingsError: they do not.
    """
    most = room_for(bytes_each)
    count = 0
    for portion in portions:
        count += len(portion.first)
        if count > most:
            s, t = int(portion.first[-1]), int(portion.second[-1])
            raise TooManyCrossingsError(
                f"more than {most} pairs of segments meet, {s} and {t} among them: too many for this machine's memory",
                indices=[s, t],
            )
        yield portion
