"""V1 for the way cells are listed: who is told to be listed the other way round than most, by counting."""

from collections.abc import Sequence
from random import Random

import pytest
from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint

from exactmesh.verify import Orientation, Property, verify

Cell = tuple[int, ...]
PLACES = [(5.0, 0.0), (3.0, 4.0), (-3.0, 4.0), (-5.0, 0.0), (0.0, -5.0), (1.0, 1.0), (-2.0, 2.0)]
WAYS = {1: "counterclockwise", -1: "clockwise"}


def way_of(points: Sequence[RationalPoint], cell: Cell) -> int:
    """How a cell is listed, by the turns at its corners, of which one may be reflex; 0 for bow ties and flat ones."""
    turns = [oracles.orient(points[cell[i - 2]], points[cell[i - 1]], points[cell[i]]) for i in range(len(cell))]
    left, right = sum(turn > 0 for turn in turns), sum(turn < 0 for turn in turns)
    return (left >= 3) - (right >= 3)


def remark(cells: Sequence[Cell], ways: Sequence[int], rows: Sequence[int]) -> str:
    """What is said of some cells; nothing where there are as many of both ways, or of one cell."""
    few = min((1, -1), key=ways.count)
    named = [row for row in rows if ways[row] == few]
    if ways.count(1) == ways.count(-1) or len(rows) < 2 or not named:
        return ""
    noun = "cell" if any(len(cell) == 4 for cell in cells) else "triangle"
    subject = f"{noun} {named[0]} is" if len(named) == 1 else f"{noun}s {named[0]} and {named[1]} are"
    return f"{subject} listed {WAYS[few]}, most are {WAYS[-few]}"


def cells_of(random: Random) -> list[Cell]:
    n = random.randint(1, 7)
    widths = sorted(random.choice((3, 3, 4)) if n % 2 else 3 for _ in range(n))
    return [tuple(random.sample(range(len(PLACES)), width)) for width in widths]


@pytest.mark.obligation(
    "V1", "who is told to be listed the other way round is so, and all are told", method="differential"
)
class TestListing:
    """Where two cells overlap, or list an edge in the same direction, the message ends with those of them that are
    listed in the rarer way, if one is rarer; and where both ways are allowed, a note counts the clockwise ones."""

    @pytest.mark.parametrize("orientation", [*Orientation])
    @pytest.mark.parametrize("seed", range(5))
    def test_random(self, seed: int, orientation: Orientation) -> None:
        random, exact, seen = Random(seed), oracles.rationals(PLACES), set[bool]()
        for _ in range(30):
            cells = cells_of(random)
            ways = [way_of(exact, cell) for cell in cells]
            triangles, quads = [c for c in cells if len(c) == 3], [c for c in cells if len(c) == 4]
            findings = verify(PLACES, triangles, quads=quads, orientation=orientation).findings
            for property_ in (Property.EDGE_MANIFOLD, Property.ADMISSIBLE):
                for violation in findings[property_].violations:
                    told = violation.message.rpartition("; ")[2] if "listed" in violation.message else ""
                    assert told == remark(cells, ways, violation.triangles), (cells, violation)
                    seen.add(bool(told))
            noun = "cells" if quads else "triangles"
            both = orientation is Orientation.ANY and 1 in ways and -1 in ways
            note = f"{ways.count(-1)} of {len(cells)} {noun} are listed clockwise" if both else ""
            assert findings[Property.ORIENTATION].note == note
        assert seen == {False, True}

    def test_control_one_turned_round(self) -> None:
        """Two triangles that overlap, one of them turned round: neither way is rarer, and another one decides."""
        exact = oracles.rationals(PLACES)
        cells: list[Cell] = [(0, 1, 3), (0, 3, 2), (0, 4, 3)]
        ways = [way_of(exact, cell) for cell in cells]
        assert remark(cells, ways, (0, 1)) != remark(cells[:2], ways[:2], (0, 1)) == ""
