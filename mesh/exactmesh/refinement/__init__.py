"""Refinement of triangulations: Ruppert's algorithm."""

from exactmesh.refinement.options import Steiner
from exactmesh.refinement.refine import refine
from exactmesh.refinement.result import Refinement
from exactmesh.refinement.rules import Reason, SteinerKind

__all__ = ["Reason", "Refinement", "Steiner", "SteinerKind", "refine"]
