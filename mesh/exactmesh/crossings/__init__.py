"""Segments that meet where they should not: find all of them, or make a planar graph of them."""

from exactmesh.crossings.arrangement import Arrangement, Rounding, arrange
from exactmesh.crossings.search import SegmentPairs, crossing_pairs, find_crossings
from exactmesh.crossings.segment_meetings import Meeting

__all__ = ["Arrangement", "Meeting", "Rounding", "SegmentPairs", "arrange", "crossing_pairs", "find_crossings"]
