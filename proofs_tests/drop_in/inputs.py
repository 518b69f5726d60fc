"""Dictionaries for the drop-in, small enough to be looked through by eye."""

from typing import TypeAlias

Content: TypeAlias = dict[str, list[tuple[float, ...]]]

SQUARE: Content = {"vertices": [(0, 0), (4, 0), (4, 4), (0, 4)]}
COURSE: Content = {
    "vertices": [(0, 0), (1, 0), (0.4, 0.4), (0, 1), (0.2, 0.3)],
    "segments": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "segment_markers": [(1,), (2,), (3,), (4,)],
}
#: Two vertices lie outside of what the segments enclose.
OUTSIDE: Content = {**COURSE, "vertices": [*COURSE["vertices"], (5, 5), (0.6, 0.6)]}
#: A box in two halves with an attribute each, and a triangular hole in the right one.
HALVES: Content = {
    "vertices": [(0, 0), (4, 0), (4, 4), (0, 4), (2, 0), (2, 4), (2.5, 1), (3, 1), (3, 2)],
    "segments": [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5), (6, 7), (7, 8), (8, 6)],
    "holes": [(2.9, 1.1)],
    "regions": [(1, 1, 7, 0.5), (3.5, 3, 8, -1)],
}
#: Diagonals that cross; the attribute is x + y.
CROSSING: Content = {
    "vertices": [(0, 0), (4, 0), (4, 4), (0, 4), (3, 1)],
    "vertex_attributes": [(0,), (4,), (8,), (4,), (4,)],
    "segments": [(0, 2), (1, 3)],
}
TWICE: Content = {"vertices": [(0, 0), (4, 0), (4, 4), (0, 4), (4, 4), (2, 2)]}
TRIANGLES: Content = {**SQUARE, "triangles": [(0, 1, 2), (0, 2, 3)]}
MARKED: Content = {
    **TRIANGLES,
    "vertex_attributes": [(0, 1), (4, 1), (8, 1), (4, 1)],
    "vertex_markers": [(2,), (0,), (0,), (0,)],
    "triangle_attributes": [(3,), (4,)],
    "triangle_max_area": [(1,), (100,)],
    "segments": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "segment_markers": [(5,), (6,), (7,), (8,)],
}
#: A triangle that is no corner's: vertex 0 is used by none.
UNUSED: Content = {
    "vertices": [(9, 9), (0, 0), (4, 0), (4, 4), (0, 4)],
    "triangles": [(1, 2, 3), (1, 3, 4)],
}
INPUTS = {
    "square": SQUARE, "course": COURSE, "outside": OUTSIDE, "halves": HALVES, "crossing": CROSSING, "twice": TWICE,
    "triangles": TRIANGLES, "marked": MARKED, "unused": UNUSED,
}  # fmt: skip

_PLAIN = ("", "e", "n", "B", "P", "N", "E", "j", "o2", "c", "ce", "en", "cP", "A", "O", "z")
_GRAPH = (
    "p",
    "pc",
    "pe",
    "pn",
    "pA",
    "pO",
    "pAO",
    "pB",
    "pP",
    "pN",
    "pE",
    "pj",
    "pjo2",
    "pcj",
    "pcAen",
    "po2",
    "pBeo2",
)
_REFINED = ("q", "a1", "qc", "a0.5e")
_REFINED_GRAPH = ("pq", "pD", "pa0.5", "pAa", "pqa0.3en", "pqS3", "pqYY")
_GIVEN = ("r", "re", "rp", "rpe", "ro2", "rA", "rc", "rn", "ra1", "rpa0.5")


def calls() -> dict[str, tuple[list[str], list[str]]]:
    """Return for each input the switches with which no vertex is new, but at crossings, and those that refine."""
    found = {}
    for name, content in INPUTS.items():
        graph = "segments" in content and "r" not in name
        plain = [*_PLAIN, *(_GRAPH if graph and name != "crossing" else ())]
        plain += ["pc", "pce", "pcj"] if name == "crossing" else []
        refined = [*_REFINED, *(_REFINED_GRAPH if graph and name != "crossing" else ())]
        if "triangles" in content:
            plain += [o for o in _GIVEN if "a" not in o and ("segments" in content or "p" not in o)]
            refined += ["ra1", *(["rpa0.5", "ra"] if "triangle_max_area" in content else [])]
        found[name] = (plain, refined)
    return found
