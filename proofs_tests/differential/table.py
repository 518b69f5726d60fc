"""A few points in Python's integers: the sign of every orientation and of every incircle test, from the definition."""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import combinations

__all__ = ["Table", "sign"]


def sign(value: int) -> int:
    return (value > 0) - (value < 0)


class Table:
    """Points by their ranks in lexicographic order, each position once.

    Attributes:
        rank: of each given point, its rank: the same for points at one position.
        at: the positions by rank, integers, as if the first were the origin and the unit small enough.
        twice: twice the signed area of each triple of ranks.
    """

    def __init__(self, points: Iterable[Sequence[float]]) -> None:
        given = [(float(x), float(y)) for x, y in points]
        positions = sorted(set(given))
        number = {position: i for i, position in enumerate(positions)}
        self.rank = [number[position] for position in given]
        self._unit, self._origin, self.at = _integers(positions)
        self.n = len(self.at)
        self.twice: list[list[list[int]]] = [[[0] * self.n for _ in range(self.n)] for _ in range(self.n)]
        for i, j, k in combinations(range(self.n), 3):
            (ax, ay), (bx, by), (cx, cy) = self.at[i], self.at[j], self.at[k]
            area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
            if area:
                self._fill(i, j, k, area)
        self.lifts = [x * x + y * y for x, y in self.at]
        self._known: dict[tuple[int, int, int, int], tuple[int, int]] = {}

    def _fill(self, i: int, j: int, k: int, area: int) -> None:
        twice = self.twice
        twice[i][j][k] = twice[j][k][i] = twice[k][i][j] = area
        twice[i][k][j] = twice[k][j][i] = twice[j][i][k] = -area

    def circle_of(self, i: int, j: int, k: int, m: int) -> tuple[int, int]:
        """Return the signs of incircle, plain and perturbed, of four ranks in increasing order.

        The determinant of the rows (x, y, x^2 + y^2, 1), by its third column. Perturbed, the lift of the
        lexicographically smallest point grows most: the sign is that of the first cofactor that is not 0.
        """
        known = self._known.get((i, j, k, m))
        if known is not None:
            return known
        t = self.twice
        slopes = (t[j][k][m], -t[i][k][m], t[i][j][m], -t[i][j][k])
        z = self.lifts
        plain = sign(z[i] * slopes[0] + z[j] * slopes[1] + z[k] * slopes[2] + z[m] * slopes[3])
        perturbed = plain or next((sign(slope) for slope in slopes if slope), 0)
        self._known[i, j, k, m] = plain, perturbed
        return plain, perturbed

    def incircle(self, a: int, b: int, c: int, d: int) -> tuple[int, int]:
        """Return the signs of incircle, plain and perturbed, of four different ranks in any order."""
        inversions = (a > b) + (a > c) + (a > d) + (b > c) + (b > d) + (c > d)
        plain, perturbed = self.circle_of(*sorted((a, b, c, d)))
        return (-plain, -perturbed) if inversions % 2 else (plain, perturbed)

    def contains(self, a: int, b: int, c: int, place: Sequence[float]) -> bool:
        """Tell whether a place lies in a closed triangle that is counterclockwise."""
        x, y = (Fraction(z) * self._unit - origin for z, origin in zip(place, self._origin, strict=True))
        corners = [self.at[v] for v in (a, b, c)]
        sides = zip(corners, corners[1:] + corners[:1], strict=True)
        return all((qx - px) * (y - py) - (qy - py) * (x - px) >= 0 for (px, py), (qx, qy) in sides)

    def between(self, a: int, b: int) -> list[int]:
        """Return the ranks on the closed segment from the smaller to the larger rank, in order."""
        low, high = min(a, b), max(a, b)
        return [w for w in range(low, high + 1) if self.twice[low][high][w] == 0]

    def cross(self, s: tuple[int, int], t: tuple[int, int]) -> bool:
        """Tell whether two segments meet in one point inside both."""
        (a, b), (c, d) = s, t
        ab, cd = self.twice[a][b], self.twice[c][d]
        return sign(ab[c]) * sign(ab[d]) < 0 and sign(cd[a]) * sign(cd[b]) < 0


def _integers(positions: Sequence[tuple[float, float]]) -> tuple[int, tuple[int, int], list[tuple[int, int]]]:
    """Return a unit, an origin and integers: positions times the unit, less the origin.

    Denominators of doubles are powers of two; the largest serves all.
    """
    ratios = [(x.as_integer_ratio(), y.as_integer_ratio()) for x, y in positions]
    unit = max((ratio[1] for pair in ratios for ratio in pair), default=1)
    whole = [(xn * (unit // xd), yn * (unit // yd)) for (xn, xd), (yn, yd) in ratios]
    origin = whole[0] if whole else (0, 0)
    return unit, origin, [(x - origin[0], y - origin[1]) for x, y in whole]
