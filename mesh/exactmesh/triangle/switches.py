"""Triangle's switch strings, read without its traps: what is not understood is refused, nothing is skipped.

Reference: [Shewchuk 1996]
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from decimal import Decimal
from enum import StrEnum
from typing import NoReturn

from exactmesh.refinement.options import MAX_ANGLE
from exactmesh.triangle.errors import SwitchError

__all__ = ["MEANINGS", "Switch", "Switches", "parse"]

_DEFAULT_ANGLE = 20.0


class Switch(StrEnum):
    """The switches of Triangle, by their letters."""

    PSLG = "p"
    REFINE = "r"
    QUALITY = "q"
    AREA = "a"
    UNSUITABLE = "u"
    ATTRIBUTES = "A"
    CONVEX = "c"
    CONFORMING = "D"
    SPLIT = "s"
    NO_BISECT = "Y"
    STEINER = "S"
    JETTISON = "j"
    EDGES = "e"
    VORONOI = "v"
    NEIGHBORS = "n"
    GEOMVIEW = "g"
    QUADRATIC = "o"
    NO_MARKERS = "B"
    NO_POLY = "P"
    NO_NODES = "N"
    NO_ELEMENTS = "E"
    NO_ITERATION = "I"
    NO_HOLES = "O"
    ZERO = "z"
    CHECK = "C"
    QUIET = "Q"
    VERBOSE = "V"
    INEXACT = "X"
    INCREMENTAL = "i"
    SWEEPLINE = "F"
    VERTICAL = "l"
    WEIGHTED = "w"
    HELP = "h"


#: What each switch does, for people.
MEANINGS: dict[Switch, str] = {
    Switch.PSLG: "a planar straight line graph: segments, holes, regions; crossings become vertices",
    Switch.REFINE: "refine the given triangles",
    Switch.QUALITY: "no angle below a bound: q is 20 degrees, q30 is 30",
    Switch.AREA: "no larger area: a0.1; a alone: as the regions (p), or the given triangles (r) have it; or both",
    Switch.UNSUITABLE: "ask a function which triangles are too large",
    Switch.ATTRIBUTES: "attributes of the regions for the triangles (with p)",
    Switch.CONVEX: "keep the convex hull, and make its edges segments",
    Switch.CONFORMING: "conforming Delaunay (also L): all triangles Delaunay, all segments Gabriel",
    Switch.SPLIT: "split segments instead of constraining them; here as D",
    Switch.NO_BISECT: "no new vertex on the boundary; YY: on no segment",
    Switch.STEINER: "at most so many new vertices: S100; S alone is none",
    Switch.JETTISON: "leave out vertices that no triangle uses",
    Switch.EDGES: "edges, and their markers",
    Switch.VORONOI: "the Voronoi diagram (files only; call voronoi)",
    Switch.NEIGHBORS: "the neighbour opposite each corner",
    Switch.GEOMVIEW: "an .off file (files only)",
    Switch.QUADRATIC: "o2: six nodes a triangle, the last three opposite the corners",
    Switch.NO_MARKERS: "no markers",
    Switch.NO_POLY: "no segments",
    Switch.NO_NODES: "no vertices",
    Switch.NO_ELEMENTS: "no triangles",
    Switch.NO_ITERATION: "no iteration number in names of files",
    Switch.NO_HOLES: "ignore the holes",
    Switch.ZERO: "count from 0 (files; dictionaries always do)",
    Switch.CHECK: "check the result: here by the exact verifier",
    Switch.QUIET: "print nothing: always so here",
    Switch.VERBOSE: "print more: nothing is printed here",
    Switch.INEXACT: "inexact arithmetic: here it is always exact",
    Switch.INCREMENTAL: "the incremental algorithm: here the Delaunay triangulation is the same by any",
    Switch.SWEEPLINE: "the sweepline algorithm: here the Delaunay triangulation is the same by any",
    Switch.VERTICAL: "vertical cuts only: here the Delaunay triangulation is the same by any algorithm",
    Switch.WEIGHTED: "weighted Delaunay triangulations: not offered",
    Switch.HELP: "this list: exactmesh.triangle.MEANINGS",
}

_ALIASES = {"L": Switch.CONFORMING, "W": Switch.WEIGHTED}
_IGNORED = (Switch.INEXACT, Switch.INCREMENTAL, Switch.SWEEPLINE, Switch.VERTICAL, Switch.VERBOSE, Switch.HELP)
_QUALITY = (Switch.QUALITY, Switch.AREA, Switch.UNSUITABLE, Switch.CONFORMING, Switch.SPLIT)
_UNWEIGHTED = (Switch.PSLG, Switch.REFINE, *_QUALITY)  # with these Triangle ignores weights

_NUMBER = re.compile(r"[0-9.]+")
_DECIMAL = re.compile(r"[0-9]+\.?[0-9]*|\.[0-9]+")
_EXPONENT = re.compile(r"[0-9.]+[eE][+-]?[0-9]+")
_SIGNED = re.compile(r"[+-][0-9.]*")
_COMMA = re.compile(r"[0-9.]+,[0-9]+")
_APART = re.compile(r"[0-9.]+([eE][+-]?[0-9]+)?")


@dataclass(frozen=True, slots=True)
class Switches:
    """What a switch string asks for; ``str`` gives it back in one canonical form.

    Attributes:
        given: the switches, each once.
        min_angle: degrees, or None: no bound.
        max_area: the bound for all triangles, or None.
        local_areas: whether the areas of regions, or of the given triangles, bound as well.
        unsplit: 0; 1: no new vertex on the boundary; 2: none on a segment.
        max_steiner: at most so many new vertices, or None.

    >>> from exactmesh.triangle import parse
    >>> switches = parse("pq30a0.1e")
    >>> switches.min_angle, switches.max_area, Switch.EDGES in switches.given, str(switches)
    (30.0, 0.1, True, 'pq30a0.1e')
    """

    given: frozenset[Switch] = field(default_factory=frozenset)
    min_angle: float | None = None
    max_area: float | None = None
    local_areas: bool = False
    unsplit: int = 0
    max_steiner: int | None = None

    def asks(self, *switches: Switch) -> bool:
        """Tell whether any of the switches is given."""
        return not self.given.isdisjoint(switches)

    @property
    def refines(self) -> bool:
        """Whether new vertices may be asked for."""
        return self.asks(*_QUALITY)

    def notes(self) -> Iterator[str]:
        """Yield what the switches mean here, of those that mean something else than to Triangle."""
        for switch in Switch:
            if switch in self.given and switch in (*_IGNORED, Switch.SPLIT):
                yield f"{switch}: {MEANINGS[switch]}"
        if self.asks(Switch.WEIGHTED):
            yield "w: weights are ignored with p, r, q, a, u, D and s, as by Triangle"
        if self.asks(Switch.ATTRIBUTES) and (self.asks(Switch.REFINE) or not self.asks(Switch.PSLG)):
            yield "A: without p, or with r, there are no regions to take attributes from"

    def __str__(self) -> str:
        return "".join(self._word(switch) for switch in Switch if switch in self.given)

    def _word(self, switch: Switch) -> str:
        if switch is Switch.QUALITY:
            return "q" if self.min_angle in (None, _DEFAULT_ANGLE) else f"q{_plain(self.min_angle or 0.0)}"
        if switch is Switch.AREA:
            return ("" if self.max_area is None else f"a{_plain(self.max_area)}") + "a" * self.local_areas
        if switch is Switch.STEINER:
            return f"S{self.max_steiner}" if self.max_steiner else "S"
        repeats = {Switch.NO_BISECT: "Y" * self.unsplit, Switch.QUADRATIC: "o2"}
        return repeats.get(switch, switch.value)


def _plain(value: float) -> str:
    """Return a number without an exponent, which Triangle cannot read."""
    text = format(Decimal(repr(value)), "f")
    return text.removesuffix(".0")


def parse(switches: str) -> Switches:
    """Return what a switch string asks for.

    Triangle skips what it does not know and reads numbers without exponents, so that ``a1e-3`` is an area of 1 to it,
    the list of edges, and a rest. Here that is an error that says what to write. A leading ``-`` and spaces between
    switches are allowed.

    Raises:
        SwitchError: an unknown switch, a number that is not one or belongs to none, or two that contradict; no string.

    >>> parse("pa1e-3")
    Traceback (most recent call last):
    exactmesh.triangle.errors.SwitchError: 'a1e-3' at 1 of 'pa1e-3': numbers have no exponents: write a0.001
    """
    if not isinstance(switches, str):
        raise SwitchError(
            "switches are a string, such as 'pq30'", switches=str(switches), position=0, culprit=str(switches)
        )
    reader = _Reader(switches)
    reader.read()
    result = reader.result()
    if result.asks(Switch.WEIGHTED) and not result.asks(*_UNWEIGHTED):
        place = min(i for i in (switches.find("w"), switches.find("W")) if i >= 0)
        reader.fail(MEANINGS[Switch.WEIGHTED], place, place + 1)
    return result


class _Reader:
    """Reads one string from left to right."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.given: set[Switch] = set()
        self.numbers: dict[Switch, float] = {}
        self.local_areas = False
        self.unsplit = 0

    def fail(self, message: str, start: int, stop: int) -> NoReturn:
        raise SwitchError(message, switches=self.text, position=start, culprit=self.text[start:stop])

    def result(self) -> Switches:
        steiner = self.numbers.get(Switch.STEINER)
        return Switches(
            frozenset(self.given),
            self.numbers.get(Switch.QUALITY),
            self.numbers.get(Switch.AREA),
            self.local_areas,
            self.unsplit,
            None if steiner is None else int(steiner),
        )

    def read(self) -> None:
        may_dash = True
        while self.at < len(self.text):
            letter = self.text[self.at]
            if letter.isspace() or (letter == "-" and may_dash):
                may_dash = letter != "-"
                self.at += 1
                continue
            may_dash = False
            self.take(letter)

    def take(self, letter: str) -> None:
        start = self.at
        apart = _APART.match(self.text, start)
        if apart:
            self.fail("the number belongs to no switch: write it behind one, without a space", start, apart.end())
        switch = _ALIASES.get(letter) or (Switch(letter) if letter in tuple(Switch) else None)
        if switch is None:
            self.fail(f"no switch; there are {' '.join((*Switch, *_ALIASES))}", start, start + 1)
        self.at += 1
        self.given.add(switch)
        if switch in (Switch.QUALITY, Switch.AREA, Switch.STEINER):
            self.take_number(switch, start)
        elif switch is Switch.NO_BISECT:
            self.unsplit = min(self.unsplit + 1, 2)
        elif switch is Switch.QUADRATIC:
            if self.text[self.at : self.at + 1] != "2":
                self.fail("only o2 is offered: six nodes a triangle", start, start + 2)
            self.at += 1

    def take_number(self, switch: Switch, start: int) -> None:
        found = self.digits(switch, start)
        if found is None:
            if switch is Switch.AREA:
                self.local_areas = True
                return
            found = _DEFAULT_ANGLE if switch is Switch.QUALITY else 0.0
        if self.numbers.setdefault(switch, found) != found:
            self.fail(f"{switch} is there with another number already: leave one out", start, self.at)

    def digits(self, switch: Switch, start: int) -> float | None:
        """Return the number that follows, or None if none does."""
        text = self.text
        exponent, sign, comma = (form.match(text, self.at) for form in (_EXPONENT, _SIGNED, _COMMA))
        if exponent:
            self.fail(
                f"numbers have no exponents: write {switch}{_without_exponent(exponent[0])}", start, exponent.end()
            )
        if comma:
            self.fail(f"the decimal mark is a point: write {switch}{comma[0].replace(',', '.')}", start, comma.end())
        if sign:
            remedy = "for the areas of the regions write a alone" if switch is Switch.AREA else "leave the sign out"
            self.fail(f"numbers have no sign: {remedy}", start, sign.end())
        number = _NUMBER.match(text, self.at)
        if number is None:
            return None
        self.at = number.end()
        if not _DECIMAL.fullmatch(number[0]):
            self.fail("not a number", start, self.at)
        value = float(number[0])
        if math.isinf(value):
            self.fail("beyond the largest double", start, self.at)
        if switch is Switch.AREA and value == 0.0:
            self.fail("an area must be greater than 0", start, self.at)
        if switch is Switch.QUALITY and value > MAX_ANGLE:
            self.fail(f"more than refinement can promise: ask for {MAX_ANGLE:g} at most", start, self.at)
        if switch is Switch.STEINER and not number[0].isdigit():
            self.fail("a number of vertices is an integer", start, self.at)
        return value


def _without_exponent(text: str) -> str:
    """Return the number written out, or what to write where nobody would want to read that."""
    mantissa, exponent = re.split("[eE]", text)
    if not _DECIMAL.fullmatch(mantissa) or len(exponent) > 3:
        return "0.001 for 1e-3"
    return format(Decimal(text), "f")
