"""Voronoi diagrams, the duals of Delaunay triangulations."""

from exactmesh.voronoi.centres import circumcentres, dual_edges

__all__ = ["circumcentres", "dual_edges"]
