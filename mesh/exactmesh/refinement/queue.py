"""The triangles that wait to be refined.

Each bucket is a ring of half-edges, doubly linked: node BUCKETS + h stands for half-edge h, node b for bucket b itself.
A triangle that is destroyed leaves the queue at once, so that there is nothing stale in it and always room. Reference
[Shewchuk 1996].
"""

import math

from exactkernel.jit import jit, jit_inline
from exactmesh.refinement.sheet import FAULTS, TOP, Sheet

__all__ = ["BUCKETS", "bucket_of", "clear_queue", "enqueue", "forget", "next_half"]

BUCKETS = 512

_HALFWAY = 0.7071067811865476


@jit
def clear_queue(s: Sheet) -> None:
    """Empty all buckets."""
    for b in range(BUCKETS):
        s.before[b] = s.after[b] = b


@jit_inline
def bucket_of(unit: float, squared: float, is_skinny: bool) -> int:
    """Return the bucket for a squared length of the shortest edge; ``unit`` is about the largest there is.

    Triangles that are too large come first, large ones before small ones, so that the lattices grow undisturbed; then
    the skinny ones, small ones before large ones. Buckets are steps of a factor of about 1.4.
    """
    mantissa, exponent = math.frexp(squared / unit)
    step = min(max(8 - 2 * exponent - (1 if mantissa > _HALFWAY else 0), 0), BUCKETS // 2 - 1)
    return step if is_skinny else BUCKETS - 1 - step


@jit_inline
def enqueue(s: Sheet, half: int, bucket: int) -> None:
    """Put a half-edge that is in no bucket into one.

    Skinny triangles wait their turn, for that takes fewer points; of the large ones the newest is first, for it is
    still in the cache.
    """
    node = BUCKETS + half
    left = s.before[bucket] if bucket < BUCKETS // 2 else bucket
    right = s.after[left]
    s.after[left] = node
    s.before[node] = left
    s.after[node] = right
    s.before[right] = node
    s.counts[TOP] = max(s.counts[TOP], bucket)


@jit_inline
def forget(s: Sheet, half: int) -> None:
    """Take what is known of a triangle off a half-edge, out of the queue if it is there."""
    if s.state[half] == 0:
        return
    if s.state[half] & FAULTS:
        node = BUCKETS + half
        left, right = s.before[node], s.after[node]
        s.after[left] = right
        s.before[right] = left
    s.state[half] = 0


@jit_inline
def next_half(s: Sheet) -> int:
    """Return the first half-edge of the highest bucket that has one, or -1; it stays there."""
    top = s.counts[TOP]
    while top >= 0 and s.after[top] == top:
        top -= 1
    s.counts[TOP] = top
    return -1 if top < 0 else int(s.after[top]) - BUCKETS
