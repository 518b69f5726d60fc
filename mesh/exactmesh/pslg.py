"""The input of constrained triangulations: a planar straight line graph, validated once, then immutable."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from enum import StrEnum
from typing import TYPE_CHECKING, Self

import numpy as np
import numpy.typing as npt
from gmpy2 import mpq

from exactkernel.arrays import exact_doubles, finite_points
from exactkernel.errors import ShapeError
from exactkernel.types import FloatArray, IntArray
from exactmesh.coincident import first_of_each, lexicographic_order
from exactmesh.columns import MarkerArray, attributes_of, frozen, integers, markers_of, regions_of, rows_for
from exactmesh.errors import ChoiceError, GeometryError, PSLGError
from exactmesh.faults import seed_faults, segment_faults
from exactmesh.geojson import geojson_of, pieces_of_geojson
from exactmesh.rings import Piece, graph_of, pieces_of_rings, rings_of
from exactmesh.shapes import domain_of, pieces_of_shapely
from exactmesh.svg import svg_of

if TYPE_CHECKING:
    from shapely import MultiPolygon, Polygon
    from shapely.geometry.base import BaseGeometry

__all__ = ["PSLG", "Carve"]


class Carve(StrEnum):
    """Which faces of the segments are the domain.

    >>> Carve("even-odd")
    <Carve.EVEN_ODD: 'even-odd'>
    """

    SEEDS = "seeds"
    """All but the face that reaches infinity, and those that reach the seed of a hole. The rule of Triangle."""
    EVEN_ODD = "even-odd"
    """Those that an odd number of segments separates from infinity, so that a ring inside a ring is a hole; each of
    several coincident segments counts. Seeds of holes take out faces besides."""

    @classmethod
    def _missing_(cls, value: object) -> Self:
        hull = "the whole hull is carve=False of constrained_delaunay"
        raise ChoiceError(f"{value!r} is no rule for carving; choose from {', '.join(cls)} ({hull})")


@dataclass(frozen=True, eq=False, repr=False)
class PSLG:
    """A planar straight line graph: points, segments between them, seeds of holes and regions. Immutable.

    Everything is kept as given and in its order. Points at the same position are merged in the triangulation, not
    refused: ``representative`` and ``duplicates`` report them. Segments may overlap, cross, and meet in T-junctions;
    what to do about crossings is for :func:`exactmesh.constrained_delaunay` to be told.

    Attributes:
        points: float64 (n, 2), y up.
        segments: int32 (s, 2), the indices of their end points.
        holes: float64 (h, 2), a point inside each hole, or none: (0, 2).
        regions: float64 (r, 4): x, y of a point inside the region, its attribute, its largest triangle area (not
            positive: unlimited; rows of three get -1).
        point_markers: int64 (n,), or None.
        segment_markers: int64 (s,), or None.
        point_attributes: float64 (n, a), or None.
        rule: which faces are the domain when it is carved.
        representative: int32 (n,), the first point at the position of each point.
        duplicates: int32 (k,), the points that are not the first at their position. -0.0 is 0.0.

    Raises:
        PSLGError: segments that name no point, have no length or repeat another (the same two indices), seeds that are
            not finite, on a segment or not inside the convex hull of the points. All faults at once, in ``faults``.
        ShapeError, CoordinateError, NonFiniteError: arrays that are none, see :func:`exactmesh.delaunay`.

    O((n + s) log(n + s)) with seeds off the beaten track: O(s h) at worst for h seeds. Every decision is exact.

    >>> from exactmesh import PSLG
    >>> pslg = PSLG([(0, 0), (4, 0), (4, 3), (0, 3), (4, 3)], [(0, 1), (1, 2), (2, 3), (3, 0)], holes=[(1, 1)])
    >>> pslg
    PSLG(5 points, 4 segments, 1 hole, 0 regions, carve by seeds)
    >>> pslg.representative.tolist(), pslg.duplicates.tolist()
    ([0, 1, 2, 3, 2], [4])
    >>> PSLG([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 3), (2, 2)])
    Traceback (most recent call last):
    exactmesh.errors.PSLGError: segment 1 (1, 3) has an end that does not exist: points are 0 to 2 (segments count \
points from 0); segment 2 begins and ends in point 2 (leave it out)
    """

    points: FloatArray
    segments: IntArray
    holes: FloatArray
    regions: FloatArray
    point_markers: MarkerArray | None
    segment_markers: MarkerArray | None
    point_attributes: FloatArray | None
    rule: Carve
    representative: IntArray = field(init=False)
    duplicates: IntArray = field(init=False)

    def __init__(
        self,
        points: npt.ArrayLike,
        segments: npt.ArrayLike = (),
        *,
        holes: npt.ArrayLike | None = None,
        regions: npt.ArrayLike | None = None,
        point_markers: npt.ArrayLike | None = None,
        segment_markers: npt.ArrayLike | None = None,
        point_attributes: npt.ArrayLike | None = None,
        rule: Carve | str = Carve.SEEDS,
    ) -> None:
        coordinates = finite_points(points)
        n, ends = len(coordinates), _pairs(segments)
        seeds = {
            "hole": exact_doubles(() if holes is None else holes, "holes"),
            "region": regions_of(regions, "regions"),
        }
        content: dict[str, object] = {
            "points": coordinates,
            "holes": seeds["hole"],
            "regions": seeds["region"],
            "point_markers": rows_for(markers_of(point_markers, "point_markers"), "point_markers", n),
            "segment_markers": rows_for(markers_of(segment_markers, "segment_markers"), "segment_markers", len(ends)),
            "point_attributes": rows_for(attributes_of(point_attributes, "point_attributes"), "point_attributes", n),
            "rule": Carve(rule),
        }
        for name, value in content.items():  # a caller may hold a view of what it gave, however read-only
            if isinstance(value, np.ndarray):
                content[name] = value.copy(order="C")
        order = lexicographic_order(coordinates)
        representative = first_of_each(coordinates, order)
        faults, sound = segment_faults(ends, representative)
        for what, places in seeds.items():
            faults += seed_faults(what, places, coordinates, order, ends, sound)
        if faults:
            raise PSLGError(faults)
        content["segments"] = ends.astype(np.int32)
        content["representative"] = representative
        content["duplicates"] = np.flatnonzero(representative != np.arange(n, dtype=np.int32)).astype(np.int32)
        self.__setstate__(content)

    @classmethod
    def from_rings(cls, rings: Iterable[npt.ArrayLike], *, markers: npt.ArrayLike | None = None) -> Self:
        """Return the PSLG of rings, to be carved by even-odd: a ring inside a ring is a hole.

        Args:
            rings: arrays (k, 2) of vertices in order, of either orientation; the first may be repeated at the end.
            markers: one integer a ring, for its segments.

        Raises:
            PSLGError: rings of fewer than three distinct vertices.
            ShapeError, CoordinateError, NonFiniteError: as for points; the message names ``rings[i]``.

        Linear time, and the check of a PSLG.

        >>> from exactmesh import PSLG
        >>> pslg = PSLG.from_rings([[(0, 0), (9, 0), (0, 9), (0, 0)], [(1, 1), (2, 1), (1, 2)]], markers=[7, 8])
        >>> pslg.segments.tolist(), pslg.segment_markers.tolist()
        ([[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3]], [7, 7, 7, 8, 8, 8])
        >>> [ring.tolist() for ring in pslg.rings()]
        [[[0.0, 0.0], [9.0, 0.0], [0.0, 9.0]], [[1.0, 1.0], [2.0, 1.0], [1.0, 2.0]]]
        """
        return cls._of(pieces_of_rings(rings), markers)

    @classmethod
    def from_geojson(cls, source: str | bytes | Mapping[str, object]) -> Self:
        """Return the PSLG of a GeoJSON object, to be carved by even-odd; files are for :func:`exactmesh.io.read_pslg`.

        Rings of polygons and lines become segments, points become points, in their order; properties are not read.

        Even-odd counts: of polygons that overlap, the domain is their symmetric difference; for their union, unite them
        before (``shapely.union_all``). A line separates nothing: beside polygons it counts twice, and so each of its
        segments is there twice, on points of its own. Lines alone are to be carved by seeds, and are there once.

        Args:
            source: the text, or the dictionary that it stands for: a geometry, a Feature, a FeatureCollection.

        Raises:
            GeometryError: no GeoJSON, or a third coordinate; it says where.
            PSLGError: rings of fewer than three distinct vertices.

        >>> from exactmesh import PSLG
        >>> PSLG.from_geojson('{"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [0, 0.1], [0, 0]]]}')
        PSLG(3 points, 3 segments, 0 holes, 0 regions, carve by even-odd)
        >>> PSLG.from_geojson('{"type": "LineString", "coordinates": [[0, 0], [1, 0]]}')
        PSLG(2 points, 1 segment, 0 holes, 0 regions, carve by seeds)
        """
        return cls._of(pieces_of_geojson(source))

    @classmethod
    def from_shapely(cls, geometry: BaseGeometry | Iterable[BaseGeometry]) -> Self:
        """Return the PSLG of one shapely geometry or of several, to be carved by even-odd. Needs the extra ``shapely``.

        Rings of polygons and lines become segments, points become points, in their order, bit for bit.

        Even-odd counts: of polygons that overlap, the domain is their symmetric difference; for their union, unite them
        before (``shapely.union_all``). A line separates nothing: beside polygons it counts twice, and so each of its
        segments is there twice, on points of its own. Lines alone are to be carved by seeds, and are there once.

        Raises:
            ShapelyUnavailableError: shapely is not installed; the message says how to get it.
            GeometryError: no geometry of straight lines, or a third coordinate.
            PSLGError: rings of fewer than three distinct vertices.
        """
        return cls._of(pieces_of_shapely(geometry))

    @classmethod
    def _of(cls, pieces: Sequence[Piece], markers: npt.ArrayLike | None = None) -> Self:
        graph = graph_of(pieces)
        of_piece = markers_of(markers, "markers")
        if of_piece is not None and len(of_piece) != len(pieces):
            raise ShapeError(f"markers has {len(of_piece)} rows for {len(pieces)} rings")
        segment_markers = None if of_piece is None else of_piece[graph.piece]
        rule = Carve.SEEDS if graph.only_lines else Carve.EVEN_ODD
        return cls(graph.points, graph.segments, segment_markers=segment_markers, rule=rule)

    def rings(self) -> list[FloatArray]:
        """Return the cycles that the segments form, arrays (k, 2) that do not repeat the first vertex.

        Cycles are those of the indices as given: points at the same position are not merged. Each begins with its
        first segment. O(n + s).

        Raises:
            PSLGError: a point where other than two segments end, or none.
        """
        return rings_of(self.points, self.segments)

    def to_geojson(self) -> str:
        """Return GeoJSON that :meth:`from_geojson` reads back, each number as the same double.

        Rings become a Polygon or MultiPolygon, the outer ring of each before its holes, and keep their orientation;
        points at which no segment ends become a MultiPoint.

        Raises:
            GeometryError: GeoJSON has no place for something: the rule of seeds, holes, regions, markers, attributes.
            PSLGError: the segments are no rings.

        >>> from exactmesh import PSLG
        >>> PSLG.from_rings([[(0, 0), (1, 0), (0, 0.1)]]).to_geojson()
        '{"type": "Polygon", "coordinates": [[[0.0, 0.0], [1.0, 0.0], [0.0, 0.1], [0.0, 0.0]]]}'
        """
        names = ("holes", "regions", "point_markers", "segment_markers", "point_attributes")
        lost = [name for name in names if (array := getattr(self, name)) is not None and len(array)]
        if len(self.segments) and self.rule is not Carve.EVEN_ODD:
            lost.append("the rule of seeds")
        if lost:
            remedy = "leave out what is not needed by dataclasses.replace(pslg, ...)"
            raise GeometryError(f"GeoJSON has no place for {', '.join(lost)}; {remedy}")
        alone = np.ones(len(self.points), dtype=np.bool_)
        alone[self.segments] = False
        return geojson_of(self.rings(), self.points[alone])

    def to_shapely(self) -> Polygon | MultiPolygon:
        """Return the domain, by the rule and the seeds of holes, as a shapely polygon. Needs the extra ``shapely``.

        This is exchange, by shapely's arithmetic. Which faces belong to the domain is decided exactly, and vertices are
        points of the PSLG, bit for bit, as long as no segments cross; where they do, shapely rounds.

        Raises:
            ShapelyUnavailableError: shapely is not installed; the message says how to get it.
            GeometryError: segments cross, and shapely fails at that.
        """
        return domain_of(self.points, self.segments, self.holes, even_odd=self.rule is Carve.EVEN_ODD)

    def __setstate__(self, content: dict[str, object]) -> None:
        # copies and pickles come this way as well: numpy does not pass on that an array is read-only
        for name, value in content.items():
            object.__setattr__(self, name, frozen(value) if isinstance(value, np.ndarray) else value)

    def with_rule(self, rule: Carve | str) -> PSLG:
        """Return the same graph with another rule for its domain. O(1).

        >>> from exactmesh import PSLG
        >>> PSLG([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)]).with_rule("even-odd")
        PSLG(3 points, 3 segments, 0 holes, 0 regions, carve by even-odd)
        """
        other = object.__new__(PSLG)
        other.__setstate__({**{f.name: getattr(self, f.name) for f in fields(self)}, "rule": Carve(rule)})
        return other

    def snapped(self, bits: int) -> PSLG:
        """Return the same graph on a grid, so that its segments can be halved exactly.

        Let E be the smallest power of two that is at least the extent of the points in x and in y, and R one that is at
        least their largest coordinate. The grid has the spacing g = 2^-bits E; each point goes to the nearest of it,
        and so does each seed. Then each point at a parameter k / 2^m of a segment is a double, exactly, for
        m <= 53 - bits - log2(R / E): so many times can each segment be halved, as far as no coordinate is larger than
        R. Steiner points on segments stay on them, and the domain is covered exactly. Each point moves by at most
        g / sqrt(2); :meth:`displacement_squared` says how far exactly.

        Numbers, markers and attributes stay. The result is the same drawing: that is proved, or refused.

        Args:
            bits: 1 to 52, the resolution; 53 - bits is what is left for halving.

        Raises:
            OptionError: bits that are none, or more than doubles have so far from the origin.
            SnappingError: something is smaller than the cells: points that would fall together, segments that pass the
                cell of a point that is not on them, or of a seed; ``merged``, ``run_over``, ``holes``, ``regions``.
            CrossingError: segments cross; snap ``arrange(pslg).pslg``.

        O((n + s) log(n + s)) where segments are short. Reference [Guibas 1998].

        >>> from exactmesh import PSLG
        >>> lake = PSLG([(0, 0), (0.7, 0.1), (0.3, 0.9)], [(0, 1), (1, 2), (2, 0)])
        >>> lake.snapped(4).points.tolist()
        [[0.0, 0.0], [0.6875, 0.125], [0.3125, 0.875]]
        >>> float(lake.snapped(20).displacement_squared(lake)) < 2.0 ** -41
        True
        >>> PSLG([(0, 0), (0.01, 0), (1, 1)], [(0, 1), (1, 2)]).snapped(4)
        Traceback (most recent call last):
        exactmesh.errors.SnappingError: grid of spacing 0.0625 too coarse: points 0 and 1 share a cell \
(take more bits, or merge what should be one)
        """
        from exactmesh.grid_rounding import rounded_to_grid  # whose parts need a PSLG

        to = rounded_to_grid(self.points, self.segments, self.representative, self.holes, self.regions, bits)
        content = {f.name: getattr(self, f.name) for f in fields(self) if f.init}
        return PSLG(**{**content, "points": to.points, "holes": to.holes, "regions": to.regions})

    def displacement_squared(self, other: PSLG) -> mpq:
        """Return the exact square of the largest distance of a point from the one of the same number in another PSLG.

        Raises:
            ShapeError: they differ in the number of points.

        >>> from exactmesh import PSLG
        >>> PSLG([(0, 0), (1, 0)]).displacement_squared(PSLG([(0, 0), (1.5, 0.25)]))
        mpq(5,16)
        """
        from exactmesh.refinement.displacement import displacement_squared

        if len(self.points) != len(other.points):
            raise ShapeError(f"there are {len(self.points)} points here and {len(other.points)} there")
        return displacement_squared(self.points, other.points, other.points)

    def __repr__(self) -> str:
        named = ((len(getattr(self, name)), name) for name in ("points", "segments", "holes", "regions"))
        counts = ", ".join(f"{k} {name[:-1] if k == 1 else name}" for k, name in named)
        return f"PSLG({counts}, carve by {self.rule})"

    def __eq__(self, other: object) -> bool:
        """Tell whether everything is the same, number by number."""
        if not isinstance(other, PSLG):
            return NotImplemented
        return all(_same(getattr(self, f.name), getattr(other, f.name)) for f in fields(self))

    def __hash__(self) -> int:
        return hash((self.rule, len(self.points), self.segments.tobytes()))

    def _repr_svg_(self) -> str:
        return svg_of(self.points, self.segments)


def _same(one: object, other: object) -> bool:
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        return np.array_equal(one, other)
    return type(one) is type(other) and one == other


def _pairs(segments: npt.ArrayLike) -> MarkerArray:
    array = integers(segments, "segments")
    if array.size == 0 and array.ndim <= 2:
        return np.zeros((0, 2), dtype=np.int64)
    if array.ndim != 2 or array.shape[1] != 2:
        raise ShapeError(f"segments has shape {array.shape}; expected (s, 2)")
    return array
