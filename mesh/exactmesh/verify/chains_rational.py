"""The chains of bottleneck.py in rationals, for coordinates so far apart that no expansion holds them."""

from dataclasses import dataclass
from heapq import heappop, heappush

import numpy as np
from gmpy2 import mpq

from exactkernel.types import FloatArray
from exactmesh.verify.links import _LOW, Links

__all__ = ["Chain", "chain_in_rationals"]


@dataclass(frozen=True, slots=True)
class Chain:
    """Vertices from end to end, and the farthest one between them, -1 without any."""

    vertices: tuple[int, ...]
    farthest: int


class Line:
    """A segment and the vertices near it."""

    def __init__(self, points: FloatArray, links: Links, line: FloatArray, within: float) -> None:
        (self.ax, self.ay), (bx, by) = ((mpq(x), mpq(y)) for x, y in line.tolist())
        self.ux, self.uy = bx - self.ax, by - self.ay
        self.points, self.links = points, links
        self.length = self.ux * self.ux + self.uy * self.uy
        self.limit = None if within == float("inf") else mpq(within) * mpq(within) * self.length

    def along(self, v: int) -> mpq:
        """Return how far v is along the segment, from 0 to the squared length."""
        x, y = self.points[v].tolist()
        return self.ux * (mpq(x) - self.ax) + self.uy * (mpq(y) - self.ay)

    def across(self, v: int) -> mpq:
        """Return the magnitude of the cross product."""
        x, y = self.points[v].tolist()
        return abs(self.ux * (mpq(y) - self.ay) - self.uy * (mpq(x) - self.ax))

    def ahead(self, v: int, b: int) -> list[tuple[mpq, int]]:
        """Return the neighbours ahead of v with their distances: b at once, others between the ends only."""
        bucket = self.links.slots[self.links.first[v] : self.links.last[v]]
        here, found = self.along(v), []
        for w in np.unique([bucket >> 32, bucket & _LOW]).tolist():
            place = self.along(w)
            if w == b and place > here:
                return [(mpq(-1), b)]
            across = self.across(w)
            is_near = self.limit is None or across * across <= self.limit
            if w != b and is_near and place > here and 0 < place < self.length:
                found.append((across, w))
        return found


def _bottleneck(line: Line, a: int, b: int) -> tuple[mpq, int] | None:
    heap, seen, farthest, v = list[tuple[mpq, int]](), {a}, (mpq(-1), -1), a
    while True:
        for across, w in line.ahead(v, b):
            if w == b:
                return farthest
            if w not in seen:
                seen.add(w)
                heappush(heap, (across, w))
        if not heap:
            return None
        across, v = heappop(heap)
        if across > farthest[0]:
            farthest = (across, v)


def chain_in_rationals(
    points: FloatArray, links: Links, line: FloatArray, a: int, b: int, within: float
) -> Chain | None:
    """Return the chain from a to b, or None: see bottleneck.py for which one of several."""
    near = Line(points, links, line, within)
    found = _bottleneck(near, a, b)
    if found is None:
        return None
    visited, path = {a}, [a]
    while path[-1] != b:
        ahead = [(across, w) for across, w in near.ahead(path[-1], b) if across <= found[0] and w not in visited]
        if not ahead:
            path.pop()
            continue
        visited.add(min(ahead)[1])
        path.append(min(ahead)[1])
    return Chain(tuple(path), found[1])
