"""What can be claimed of a mesh, and what can be answered. Each property is defined so that brute force could
decide it.

Points p_0 .. p_(n-1) and a list of triangles, each a triple of indices. A triangle is the closed set of
points that its three corners span; an edge of it is directed so that the corners keep their order.
"""

from collections.abc import Collection
from enum import StrEnum

from exactmesh.errors import ChoiceError

__all__ = [
    "DELAUNAY_TRIANGULATION",
    "ChoiceError",
    "Kind",
    "Orientation",
    "Property",
    "Severity",
    "Verdict",
    "claimed_properties",
    "orientation_of",
]


class Property(StrEnum):
    """A property of (points, triangles)."""

    FINITE = "finite"
    """No coordinate is NaN or infinite. Everything but INDICES rests on it."""
    INDICES = "indices"
    """Every index is in 0 .. n-1, and the three of a triangle differ. Everything but FINITE and
    DISTINCT_POINTS rests on it."""
    DISTINCT_POINTS = "distinct_points"
    """No two points have the same position."""
    ORIENTATION = "orientation"
    """Every triangle is listed counterclockwise; with ``Orientation.ANY`` clockwise will do. Zero area never
    does."""
    ALL_POINTS_USED = "all_points_used"
    """Every point is a corner of some triangle (by index: an unused duplicate counts as unused)."""
    EDGE_MANIFOLD = "edge_manifold"
    """No directed edge occurs twice: at most two triangles share an edge, and they list it in opposite
    directions. Purely combinatorial (with ``Orientation.ANY``, after clockwise triangles are turned
    round)."""
    VERTEX_MANIFOLD = "vertex_manifold"
    """Around every used vertex v the triangles form one fan: the directed edges opposite v form one simple
    path or one simple cycle. Combinatorial in the same sense; it implies EDGE_MANIFOLD."""
    ADMISSIBLE = "admissible"
    """Every triangle has an area, and any two triangles of the list meet in nothing, in one corner of both,
    or in one edge of both; corners and edges are compared by index. So no overlap, no repeated triangle, no
    hanging node, no corners at the same position under two indices. The order in which corners are listed
    does not matter."""
    COVERS_HULL = "covers_hull"
    """The union of the triangles is the convex hull of all points (of collinear points, whose hull has no
    area: nothing). UNDECIDED without ADMISSIBLE: whether overlapping triangles cover a region is
    3SUM-hard."""
    DELAUNAY = "delaunay"
    """Every triangle has an area and no point of the set, used or not, strictly inside its circumcircle.
    UNDECIDED without ADMISSIBLE and COVERS_HULL unless a violation is found or there is no triangle."""
    WEAKLY_ACUTE = "weakly_acute"
    """Every triangle has an area and no angle above 90 degrees."""
    ACUTE = "acute"
    """Every triangle has an area and only angles below 90 degrees."""


#: The default claims: a Delaunay triangulation of all the points.
DELAUNAY_TRIANGULATION: tuple[Property, ...] = tuple(Property)[: tuple(Property).index(Property.DELAUNAY) + 1]


class Verdict(StrEnum):
    """The answer to a claim: a theorem about the input, or the statement that there is none."""

    HOLDS = "holds"
    FAILS = "fails"
    UNDECIDED = "undecided"


class Orientation(StrEnum):
    """How triangles may be listed."""

    CCW = "ccw"
    ANY = "any"


class Severity(StrEnum):
    """Whether an exact answer different from the claim is visible to double arithmetic.

    ``ROUNDING`` is a nonzero determinant within the error bound of its evaluation in doubles, as an edge gets
    when points were rounded onto a circle. ``WRONG`` is everything else.
    """

    WRONG = "wrong"
    ROUNDING = "rounding"


class Kind(StrEnum):
    """What exactly is violated."""

    NOT_FINITE = "not_finite"
    OUT_OF_RANGE = "out_of_range"
    REPEATED_CORNER = "repeated_corner"
    COINCIDENT_POINTS = "coincident_points"
    CLOCKWISE = "clockwise"
    ZERO_AREA = "zero_area"
    UNUSED_POINT = "unused_point"
    REPEATED_EDGE = "repeated_edge"
    BROKEN_FAN = "broken_fan"
    OVERLAP = "overlap"
    CROSSING = "crossing"
    HANGING_NODE = "hanging_node"
    REFLEX_BOUNDARY = "reflex_boundary"
    DISCONNECTED = "disconnected"
    POINT_OUTSIDE = "point_outside"
    NOT_COVERED = "not_covered"
    POINT_IN_CIRCLE = "point_in_circle"
    OBTUSE_ANGLE = "obtuse_angle"
    RIGHT_ANGLE = "right_angle"


def claimed_properties(claims: Collection[Property | str] | None) -> tuple[Property, ...]:
    """Return the claims in the order of the enum; None stands for a Delaunay triangulation.

    Raises:
        ChoiceError: a claim is no property, or there is none.
    """
    if claims is None:
        return DELAUNAY_TRIANGULATION
    try:
        claims = (claims,) if isinstance(claims, str) else tuple(claims)
    except TypeError:
        raise ChoiceError(f"claims={claims!r} is no collection of properties") from None
    if not claims:
        raise ChoiceError("no claim: nothing would be promised; None claims a Delaunay triangulation")
    unknown = [claim for claim in claims if claim not in tuple(Property)]
    if unknown:
        raise ChoiceError(f"{unknown[0]!r} is no property; choose from {', '.join(Property)}")
    return tuple(property_ for property_ in Property if property_ in claims)


def orientation_of(orientation: Orientation | str) -> Orientation:
    """Return the enum member.

    Raises:
        ChoiceError: there is none of that name.
    """
    if orientation not in tuple(Orientation):
        raise ChoiceError(f"orientation={orientation!r}; choose from {', '.join(Orientation)}")
    return Orientation(orientation)
