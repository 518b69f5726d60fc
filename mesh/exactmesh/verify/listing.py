"""Which cells are listed the other way round than most: where any way is allowed, the sign of one that is inverted."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from exactmesh.verify.cells import orientation_of_quads
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.properties import Orientation, Property
from exactmesh.verify.report import Finding, Violation
from exactmesh.verify.triangles import Shapes

__all__ = ["with_listing"]

_WAYS = {1: "counterclockwise", -1: "clockwise"}


@dataclass(frozen=True, slots=True)
class _Listing:
    """Cells with their signs, and how many are listed in either way."""

    mesh: Mesh
    shapes: Shapes
    clockwise: int
    counterclockwise: int

    @property
    def rare(self) -> int:
        """The sign of the fewer cells, of which there may be none; 0 where there are as many of both."""
        return (self.clockwise > self.counterclockwise) - (self.clockwise < self.counterclockwise)

    def sign(self, row: int) -> int:
        """Return how a cell is listed; 0 where it has no orientation."""
        m = len(self.mesh.triangles)
        if row < m:
            return int(self.shapes.orientation[row])
        return int(orientation_of_quads(self.shapes.turns[[row - m]])[0])

    def remarked(self, violation: Violation) -> Violation:
        """Return a violation of several cells that says which of them are listed the other way round than most."""
        rows = [row for row in violation.triangles if self.rare and self.sign(row) == self.rare]
        if len(violation.triangles) < 2 or not rows:
            return violation
        cells = f"{self.mesh.noun}{'s' if len(rows) > 1 else ''} {' and '.join(map(str, rows))}"
        verb = "are" if len(rows) > 1 else "is"
        remark = f"{cells} {verb} listed {_WAYS[self.rare]}, most are {_WAYS[-self.rare]}"
        return replace(violation, message=f"{violation.message}; {remark}")


def with_listing(
    mesh: Mesh, shapes: Shapes, orientation: Orientation, findings: Mapping[Property, Finding]
) -> dict[Property, Finding]:
    """Return the findings with remarks on cells that are listed the other way round than most. O(m)."""
    signs = orientation_of_quads(shapes.turns)
    clockwise, counterclockwise = (
        int(np.count_nonzero(shapes.orientation == sign) + np.count_nonzero(signs == sign)) for sign in (-1, 1)
    )
    listing, told = _Listing(mesh, shapes, clockwise, counterclockwise), dict(findings)
    if orientation is Orientation.ANY and clockwise and counterclockwise:
        note = f"{clockwise} of {mesh.size} {mesh.noun}s are listed clockwise"
        told[Property.ORIENTATION] = replace(findings[Property.ORIENTATION], note=note)
    for property_ in (Property.EDGE_MANIFOLD, Property.ADMISSIBLE):
        violations = tuple(listing.remarked(violation) for violation in findings[property_].violations)
        told[property_] = replace(findings[property_], violations=violations)
    return told
