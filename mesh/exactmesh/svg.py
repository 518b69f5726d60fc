"""A small picture for notebooks; :mod:`exactmesh.plot` makes the good ones."""

import numpy as np

from exactkernel.types import FloatArray, IntArray

__all__ = ["svg_of"]

_WIDTH = 480.0
_MOST_EDGES = 20_000  # a notebook stays quick; the caption says what was left out


def svg_of(points: FloatArray, edges: IntArray) -> str:
    """Return the edges as a self-contained SVG, y up. Beyond 20,000 edges only the first ones are drawn."""
    unit = np.ldexp(points, -int(np.frexp(np.abs(points).max())[1]))  # the extent neither over- nor underflows
    low, high = unit.min(axis=0), unit.max(axis=0)
    extent = float((high - low).max())
    xy = (unit - low) / extent * _WIDTH
    height = float((high - low)[1]) / extent * _WIDTH
    drawn = edges[:_MOST_EDGES]
    path = "".join(
        f"M{xy[a, 0]:.2f} {height - xy[a, 1]:.2f}L{xy[b, 0]:.2f} {height - xy[b, 1]:.2f}" for a, b in drawn.tolist()
    )
    caption = f"{len(points)} vertices, {len(edges)} edges"
    if len(drawn) < len(edges):
        caption += f" ({len(drawn)} drawn)"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-4 -4 {_WIDTH + 8:.0f} {height + 28:.2f}" '
        f'width="{_WIDTH + 8:.0f}"><path d="{path}" fill="none" stroke="#2a6f97" stroke-width="0.8" '
        f'stroke-linejoin="round"/><text x="0" y="{height + 18:.2f}" font-family="sans-serif" font-size="12" '
        f'fill="#555">{caption}</text></svg>'
    )
