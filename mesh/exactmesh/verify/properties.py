"""What can be claimed of a mesh, and what can be answered. Each property is defined so that brute force could
decide it.

Points p_0 .. p_(n-1) and a list of triangles, each a triple of indices. A triangle is the closed set of
points that its three corners span; an edge of it is directed so that the corners keep their order.

There may be quadrilaterals besides, four indices each, in the order of their sides. Where a property speaks of
triangles, it is then said of all cells, numbered triangles first; what is said of triangles only is not decided.
"""

from collections.abc import Collection
from enum import StrEnum

from exactmesh.errors import ChoiceError

__all__ = [
    "ADMISSIBLE_MESH",
    "CONFORMING_TRIANGULATION",
    "CONSTRAINED_TRIANGULATION",
    "DELAUNAY_TRIANGULATION",
    "DOMAIN_TRIANGULATION",
    "LOCAL_PROPERTIES",
    "ChoiceError",
    "Kind",
    "Orientation",
    "Property",
    "Severity",
    "Verdict",
    "asked_properties",
    "claimed_properties",
    "decided_properties",
    "default_claims",
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
    does. A quadrilateral has to be a simple polygon with its interior on the left (with ``ANY``, on one side)."""
    CONVEX = "convex"
    """Every quadrilateral is strictly convex: its four corners are left turns, or all of them right turns."""
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
    """Every triangle has an area, every quadrilateral is strictly convex, and any two cells of the list meet in
    nothing, in one corner of both, or in one edge of both; corners and edges are compared by index. So no overlap, no
    repeated triangle, no hanging node, no corners at the same position under two indices. Whether corners are listed
    clockwise does not matter."""
    COVERS_HULL = "covers_hull"
    """The union of the triangles is the convex hull of all points (of collinear points, whose hull has no
    area: nothing). UNDECIDED without ADMISSIBLE: whether overlapping triangles cover a region is
    3SUM-hard."""
    DELAUNAY = "delaunay"
    """Every triangle has an area and no point of the set, used or not, strictly inside its circumcircle.
    UNDECIDED without ADMISSIBLE and COVERS_HULL unless a violation is found or there is no triangle."""
    SEGMENTS_PRESENT = "segments_present"
    """Every segment is a strictly monotone chain of edges of the triangles, exactly collinear, from end to end, by
    index. The ends of a segment of the domain are the corners at their positions, and parts of it may be missing that
    lie outside of the closed domain and outside of all triangles; but where parts are missing, two segments may cross
    in a corner or in an end of a segment only. Within a distance, the chain need not be straight, see
    :func:`exactmesh.verify.verify`. UNDECIDED without ADMISSIBLE if some segment is no chain."""
    CONSTRAINED_DELAUNAY = "constrained_delaunay"
    """Every triangle has an area, and no point of the set, used or not, that is strictly inside its circumcircle is
    visible from its interior: for no x in the interior of the triangle does the open line segment from x to the point
    avoid the segments and the boundary of the triangles' union. UNDECIDED without ADMISSIBLE and SEGMENTS_PRESENT
    unless a triangle has no area."""
    COVERS_DOMAIN = "covers_domain"
    """The union of the triangles is the closed domain: the closure of those faces of its segments that its rule
    chooses, see :class:`Domain`. A hole's point that lies on a segment is in no face. Within a distance, the faces are
    those of the displaced segments, their chains. UNDECIDED without ADMISSIBLE, or
    if a segment does not run along edges within the triangles (see SEGMENTS_PRESENT)."""
    DOMAIN_POINTS = "domain_points"
    """Every point of the domain's list that lies in the closed domain is at the position of a corner, or within the
    distance of one. UNDECIDED without COVERS_DOMAIN if some point is at no corner."""
    NO_NEW_POINTS = "no_new_points"
    """Every corner is at the position of a point of the domain's list: no Steiner points."""
    REGIONS = "regions"
    """Triangles on both sides of an edge that lies on no segment have the same label, and where points of regions lie
    within a face of the segments that triangles cover, their label is the attribute of one of these points. UNDECIDED
    without ADMISSIBLE and SEGMENTS_PRESENT."""
    WEAKLY_ACUTE = "weakly_acute"
    """Every triangle has an area and no angle above 90 degrees."""
    ACUTE = "acute"
    """Every triangle has an area and only angles below 90 degrees."""
    GABRIEL = "gabriel"
    """For every edge of the boundary and every edge on a segment, no corner of a triangle is strictly inside its
    diametral circle and visible from a point inside the edge, that is, joined to it by a line segment in the union of
    the triangles. UNDECIDED without ADMISSIBLE, SEGMENTS_PRESENT and DELAUNAY or CONSTRAINED_DELAUNAY unless a
    violation is found."""
    CIRCUMCENTRES_INSIDE = "circumcentres_inside"
    """Every triangle has an area, and the union of the triangles contains its circumcentre. UNDECIDED without
    ADMISSIBLE unless a triangle has no area."""
    MIN_ANGLE = "min_angle"
    """Every triangle has an area and no angle below a bound."""
    MAX_ANGLE = "max_angle"
    """Every triangle has an area and no angle above a bound."""
    MAX_AREA = "max_area"
    """No triangle has an area above its bound."""
    MAX_LENGTH = "max_length"
    """No triangle has an edge longer than the size that is wanted at its centroid (rounded), or that is given for
    it."""
    VORONOI_DUAL = "voronoi_dual"
    """A Voronoi diagram is the dual of the triangles: to every edge between triangles of different circumcentres, and
    to every edge of the boundary, one ridge is dual; it ends at the circumcentres, each coordinate the exact one or one
    of the two doubles next to it, or at infinity, in a direction (if it is given) that points away from the triangles
    and is perpendicular but for the rounding of its coordinates. Besides, there may be ridges dual to edges between
    equal circumcentres. UNDECIDED without DELAUNAY, and without triangles."""
    REGION_AREAS = "region_areas"
    """No triangle in a face of the segments that contains the point of a region is larger than the fourth number of the
    region, if that is positive. UNDECIDED without ADMISSIBLE and SEGMENTS_PRESENT."""


#: The default claims: a Delaunay triangulation of all the points.
DELAUNAY_TRIANGULATION: tuple[Property, ...] = tuple(
    property_
    for property_ in tuple(Property)[: tuple(Property).index(Property.DELAUNAY) + 1]
    if property_ is not Property.CONVEX
)


#: What a few cells can violate all by themselves: its violations name as few as that takes.
LOCAL_PROPERTIES = frozenset(
    {
        *(Property.FINITE, Property.INDICES, Property.DISTINCT_POINTS, Property.ORIENTATION, Property.CONVEX),
        *(Property.EDGE_MANIFOLD, Property.VERTEX_MANIFOLD, Property.ADMISSIBLE),
        *(Property.DELAUNAY, Property.CONSTRAINED_DELAUNAY, Property.GABRIEL, Property.CIRCUMCENTRES_INSIDE),
        *(Property.WEAKLY_ACUTE, Property.ACUTE, Property.MIN_ANGLE, Property.MAX_ANGLE, Property.MAX_AREA),
        Property.MAX_LENGTH,
    }
)


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
    REFLEX_CORNER = "reflex_corner"
    STRAIGHT_CORNER = "straight_corner"
    NOT_SIMPLE = "not_simple"
    POINT_OUTSIDE = "point_outside"
    NOT_COVERED = "not_covered"
    POINT_IN_CIRCLE = "point_in_circle"
    OBTUSE_ANGLE = "obtuse_angle"
    RIGHT_ANGLE = "right_angle"
    NO_SEGMENT = "no_segment"
    MISSING_SEGMENT = "missing_segment"
    OFF_SEGMENTS = "off_segments"
    COVERED_HOLE = "covered_hole"
    COVERED_OUTSIDE = "covered_outside"
    MISSING_POINT = "missing_point"
    NEW_POINT = "new_point"
    LABELS_DIFFER = "labels_differ"
    WRONG_LABEL = "wrong_label"
    ENCROACHED = "encroached"
    CENTRE_OUTSIDE = "centre_outside"
    SMALL_ANGLE = "small_angle"
    LARGE_ANGLE = "large_angle"
    LARGE_AREA = "large_area"
    LONG_EDGE = "long_edge"
    MISSING_RIDGE = "missing_ridge"
    EXTRA_RIDGE = "extra_ridge"
    WRONG_RAY = "wrong_ray"
    WRONG_CENTRE = "wrong_centre"


#: The default claims with segments: a constrained Delaunay triangulation of the hull of the points.
CONSTRAINED_TRIANGULATION: tuple[Property, ...] = (
    *(property_ for property_ in DELAUNAY_TRIANGULATION if property_ is not Property.DELAUNAY),
    Property.SEGMENTS_PRESENT,
    Property.CONSTRAINED_DELAUNAY,
)

#: The default claims with a domain: a constrained Delaunay triangulation of it. Its boundary may touch itself in a
#: vertex; points that no triangle uses may be listed, if they lie outside of it; Steiner points may be there.
DOMAIN_TRIANGULATION: tuple[Property, ...] = (
    Property.FINITE,
    Property.INDICES,
    Property.ORIENTATION,
    Property.EDGE_MANIFOLD,
    Property.ADMISSIBLE,
    Property.SEGMENTS_PRESENT,
    Property.CONSTRAINED_DELAUNAY,
    Property.COVERS_DOMAIN,
    Property.DOMAIN_POINTS,
)

#: The claims of a boundary conforming Delaunay triangulation of a domain.
CONFORMING_TRIANGULATION: tuple[Property, ...] = (
    *DOMAIN_TRIANGULATION,
    Property.GABRIEL,
    Property.CIRCUMCENTRES_INSIDE,
)

#: The claims of any mesh of finite elements: cells that meet as the definition of admissibility says. The union may be
#: any set, and points that no cell uses may be listed, at whatever position. By default, with quadrilaterals CONVEX is
#: claimed besides, with segments SEGMENTS_PRESENT, with a domain COVERS_DOMAIN and DOMAIN_POINTS.
ADMISSIBLE_MESH: tuple[Property, ...] = (
    Property.FINITE,
    Property.INDICES,
    Property.ORIENTATION,
    Property.EDGE_MANIFOLD,
    Property.ADMISSIBLE,
)

#: What has a meaning for quadrilaterals as well.
_OF_CELLS = (
    Property.FINITE,
    Property.INDICES,
    Property.DISTINCT_POINTS,
    Property.ORIENTATION,
    Property.CONVEX,
    Property.ALL_POINTS_USED,
    Property.EDGE_MANIFOLD,
    Property.VERTEX_MANIFOLD,
    Property.ADMISSIBLE,
    Property.COVERS_HULL,
    Property.SEGMENTS_PRESENT,
    Property.COVERS_DOMAIN,
    Property.DOMAIN_POINTS,
    Property.NO_NEW_POINTS,
    Property.REGIONS,
)

#: What is decided only if it is claimed: it takes time, or says nothing of most meshes.
_ON_CLAIM = (Property.GABRIEL, Property.CIRCUMCENTRES_INSIDE, Property.REGION_AREAS)

#: What each property needs besides points and triangles.
_NEEDS = {
    Property.CONVEX: "quadrilaterals",
    Property.SEGMENTS_PRESENT: "segments or a domain",
    Property.CONSTRAINED_DELAUNAY: "segments or a domain",
    Property.COVERS_DOMAIN: "a domain",
    Property.DOMAIN_POINTS: "a domain",
    Property.NO_NEW_POINTS: "a domain",
    Property.REGIONS: "labels, and segments or a domain",
    Property.MIN_ANGLE: "min_angle=",
    Property.MAX_ANGLE: "max_angle=",
    Property.MAX_AREA: "max_area=",
    Property.MAX_LENGTH: "size=",
    Property.VORONOI_DUAL: "dual=",
    Property.REGION_AREAS: "a domain",
}
#: What is claimed wherever it is given.
_BOUNDS = (Property.MIN_ANGLE, Property.MAX_ANGLE, Property.MAX_AREA, Property.MAX_LENGTH, Property.VORONOI_DUAL)


def asked_properties(
    *, segments: bool, domain: bool, labels: bool, bounds: Collection[Property] = (), quads: bool = False
) -> tuple[Property, ...]:
    """Return the properties that can be decided with what was given.

    Raises:
        ChoiceError: there are bounds on triangles, but quadrilaterals as well.
    """
    if quads and bounds:
        raise ChoiceError(f"{_NEEDS[next(iter(bounds))]} is about triangles, and there are quadrilaterals")
    given = {
        "quadrilaterals": quads,
        "segments or a domain": segments or domain,
        "a domain": domain,
        "labels, and segments or a domain": labels and (segments or domain),
        **{_NEEDS[property_]: property_ in bounds for property_ in _BOUNDS},
    }
    return tuple(
        property_
        for property_ in Property
        if (property_ not in _NEEDS or given[_NEEDS[property_]]) and (not quads or property_ in _OF_CELLS)
    )


def default_claims(asked: tuple[Property, ...], usual: tuple[Property, ...] | None = None) -> tuple[Property, ...]:
    """Return what is claimed if nothing else is said: of what was asked, what :func:`verify` promises.

    Args:
        asked: what can be decided.
        usual: what is claimed of a mesh of this sort; that of quadrilaterals is ADMISSIBLE_MESH.
    """
    if usual is not None or Property.CONVEX in asked:
        besides = (Property.SEGMENTS_PRESENT, Property.COVERS_DOMAIN, Property.DOMAIN_POINTS, Property.CONVEX)
        claims = ADMISSIBLE_MESH if usual is None else usual
        claims += tuple(property_ for property_ in besides if property_ in asked)
    elif Property.COVERS_DOMAIN in asked:
        claims = DOMAIN_TRIANGULATION
    elif Property.SEGMENTS_PRESENT in asked:
        claims = CONSTRAINED_TRIANGULATION
    else:
        claims = DELAUNAY_TRIANGULATION
    return claims + tuple(property_ for property_ in (Property.REGIONS, *_BOUNDS) if property_ in asked)


def claimed_properties(
    claims: Collection[Property | str] | None,
    asked: tuple[Property, ...] = tuple(Property),
    usual: tuple[Property, ...] | None = None,
) -> tuple[Property, ...]:
    """Return the claims in the order of the enum; None stands for what the given things are expected to be, which
    ``usual`` says of meshes of some sorts.

    In names "-" stands for "_".

    Raises:
        ChoiceError: a claim is no property, or needs what was not given, or there is none.
    """
    if claims is None:
        return tuple(property_ for property_ in Property if property_ in default_claims(asked, usual))
    try:
        claims = (claims,) if isinstance(claims, str) else tuple(claims)
    except TypeError:
        raise ChoiceError(f"claims={claims!r} is no collection of properties") from None
    if not claims:
        raise ChoiceError("no claim: nothing would be promised; None claims a Delaunay triangulation")
    named = [str(claim).replace("-", "_") for claim in claims]
    for claim, name in zip(claims, named, strict=True):
        if name not in tuple(Property):
            raise ChoiceError(f"{claim!r} is no property; choose from {', '.join(Property)}")
        if name not in asked:
            on_quads = Property.CONVEX in asked and name not in _OF_CELLS
            why_not = "of quadrilaterals" if on_quads else f"without {_NEEDS[Property(name)]}"
            raise ChoiceError(f"{name} cannot be claimed {why_not}")
    bounds = tuple(property_ for property_ in _BOUNDS if property_ in asked)
    return tuple(property_ for property_ in Property if property_ in named or property_ in bounds)


def decided_properties(asked: tuple[Property, ...], claimed: tuple[Property, ...]) -> tuple[Property, ...]:
    """Return the properties that are reported: all that were asked but for those that are decided on a claim only."""
    return tuple(property_ for property_ in asked if property_ not in _ON_CLAIM or property_ in claimed)


def orientation_of(orientation: Orientation | str) -> Orientation:
    """Return the enum member.

    Raises:
        ChoiceError: there is none of that name.
    """
    if orientation not in tuple(Orientation):
        raise ChoiceError(f"orientation={orientation!r}; choose from {', '.join(Orientation)}")
    return Orientation(orientation)
