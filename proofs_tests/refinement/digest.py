"""Prints one digest a refined domain: for comparing lanes and processes, bit for bit.

python -m proofs_tests.refinement.digest
"""

import math
import sys

import numpy as np
from proofs_tests.mesh.digest import _hash

from exactmesh import PSLG, refine
from exactmesh.refinement import Refinement, Steiner

__all__ = ["digests", "domains"]


def domains() -> dict[str, PSLG]:
    """Right angles, a small angle, a hole and regions, rounded segments, and coordinates outside of the window."""
    box = [(-8.0, -8.0), (8.0, -8.0), (8.0, 8.0), (-8.0, 8.0)]
    ring = [(0, 1), (1, 2), (2, 3), (3, 0)]
    spokes = [(6 * math.cos(t), 5 * math.sin(t)) for t in (0.1, 0.4, 1.9, 3.3, 5.0)]
    inner = [(-2.0, -2.0), (3.0, -2.0), (3.0, 1.0), (-2.0, 1.0)]
    return {
        "plate": PSLG(box, ring),
        "star": PSLG([*box, (0.0, 0.0), *spokes], [*ring, *((4, 5 + i) for i in range(5))]),
        "hole": PSLG([*box, *inner], [*ring, (4, 5), (5, 6), (6, 7), (7, 4)], holes=[(0.0, 0.0)]),
        "regions": PSLG([*box, *inner], [*ring, (4, 5), (5, 6), (6, 7), (7, 4)], regions=[(0.0, 0.0, 1.0, 0.5)]),
        "far": PSLG(np.array([*box, *inner]) * 2.0**-700, [*ring, (4, 5), (5, 6), (6, 7)]),
        "no window": PSLG([*box, (0.1, 3e-300), (4.0, 1e-200)], [*ring, (4, 5)]),
    }


def digest_of(done: Refinement) -> str:
    account = (done.unrefined, done.reasons, done.steiner, done.kinds, done.parents, done.radii)
    mesh = done.triangulation
    columns = (mesh.points, mesh.triangles, mesh.neighbors, mesh.segments, mesh.segment_markers, mesh.vertex_markers)
    return _hash(np.array([str(done.displacement_squared)]), *columns, *account)


def digests() -> dict[str, str]:
    found: dict[str, str] = {}
    for name, domain in domains().items():
        extent = float(np.ptp(domain.points, axis=0).max())
        runs = {
            "angles": refine(domain, min_angle=30.0, max_steiner=150),
            "conforming": refine(domain, min_angle=0.0, conforming=True, max_steiner=150),
            "areas": refine(domain, max_area=(extent * extent / 60) or None, steiner=Steiner.NOT_ON_BOUNDARY),
            "sizes": refine(domain, size=extent / 8, min_edge=extent / 50),
        }
        found.update((f"{kind} of {name}", digest_of(done)) for kind, done in runs.items())
    return found


if __name__ == "__main__":
    for name, digest in digests().items():
        sys.stdout.write(f"{name}: {digest}\n")
