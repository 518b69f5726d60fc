"""Everybody's meshes as arrays: what :func:`exactmesh.verify` takes besides points and triangles.

One file a package, with a function that recognises what the package makes and one that converts it. No package is
imported to recognise an object, and none but the object's own to convert it.

>>> from exactmesh.adapters import given_mesh
>>> given = given_mesh({"vertices": [(0, 0), (1, 0), (0, 1)], "triangles": [(0, 1, 2)]})
>>> given.source, given.triangles.tolist()
('a dictionary of triangle', [[0, 1, 2]])
"""

from exactmesh.adapters.given import GivenDomain, GivenMesh
from exactmesh.adapters.registry import given_mesh

__all__ = ["GivenDomain", "GivenMesh", "given_mesh"]
