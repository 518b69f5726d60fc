"""Editing a triangulation step by step: the builder and what it is made of."""

from exactmesh.editing.builder import TriangulationBuilder

__all__ = ["TriangulationBuilder"]
