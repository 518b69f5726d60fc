"""Guibas and Stolfi's edge algebra on a flat array: the compiled operators that the algorithms are made of.

An undirected edge has four quarter-edges ``q = 4 * edge + r``: r = 0 is the edge from its origin to its destination,
r = 2 the same edge backwards, r = 1 its dual, from the face on its right to the face on its left, r = 3 the dual
backwards. The only stored relation is ``ring[q] = onext(q)``, the next edge counterclockwise with the same origin;
everything else follows. ``org[q >> 1]`` is the origin of a primal q. Reference [Guibas 1985].

              dest                         onext(e)   next counterclockwise round the origin
          lnext \\ | / dnext                oprev(e)   next clockwise round the origin
                 \\|/                       lnext(e)   next counterclockwise round the left face
         left     |e    right               lprev(e)   next clockwise round the left face
                 /|\\                       rnext(e)   next counterclockwise round the right face
          onext / | \\ oprev                dnext(e)   next counterclockwise with the same destination
               origin
"""

import numpy as np
import numpy.typing as npt

from exactkernel.jit import jit

__all__ = [
    "EdgeArray",
    "dest",
    "dnext",
    "dprev",
    "inv_rot",
    "left_next",
    "link_ring",
    "lnext",
    "lprev",
    "make_edge",
    "onext",
    "oprev",
    "origin",
    "rnext",
    "rot",
    "rprev",
    "splice",
    "split_face",
    "swap",
    "sym",
]

EdgeArray = npt.NDArray[np.int32]


@jit
def rot(q: int) -> int:
    """Return q turned counterclockwise by 90 degrees: the dual edge from its right face to its left face."""
    return (q & ~3) | ((q + 1) & 3)


@jit
def sym(q: int) -> int:
    """Return q backwards."""
    return q ^ 2


@jit
def inv_rot(q: int) -> int:
    """Return q turned clockwise by 90 degrees: the dual edge from its left face to its right face."""
    return (q & ~3) | ((q + 3) & 3)


@jit
def onext(ring: EdgeArray, q: int) -> int:
    """Return the next edge counterclockwise with the same origin."""
    return int(ring[q])


@jit
def oprev(ring: EdgeArray, q: int) -> int:
    """Return the next edge clockwise with the same origin."""
    return rot(ring[rot(q)])


@jit
def dnext(ring: EdgeArray, q: int) -> int:
    """Return the next edge counterclockwise with the same destination."""
    return sym(ring[sym(q)])


@jit
def dprev(ring: EdgeArray, q: int) -> int:
    """Return the next edge clockwise with the same destination."""
    return inv_rot(ring[inv_rot(q)])


@jit
def lnext(ring: EdgeArray, q: int) -> int:
    """Return the next edge counterclockwise round the left face."""
    return rot(ring[inv_rot(q)])


@jit
def lprev(ring: EdgeArray, q: int) -> int:
    """Return the next edge clockwise round the left face."""
    return sym(ring[q])


@jit
def rnext(ring: EdgeArray, q: int) -> int:
    """Return the next edge counterclockwise round the right face."""
    return inv_rot(ring[rot(q)])


@jit
def rprev(ring: EdgeArray, q: int) -> int:
    """Return the next edge clockwise round the right face."""
    return int(ring[sym(q)])


@jit
def origin(org: EdgeArray, e: int) -> int:
    """Return the vertex from which the primal edge starts."""
    return int(org[e >> 1])


@jit
def dest(org: EdgeArray, e: int) -> int:
    """Return the vertex at which the primal edge ends."""
    return int(org[(e ^ 2) >> 1])


@jit
def make_edge(ring: EdgeArray, q: int) -> None:
    """Make q (r = 0) an edge of its own: alone at each end, one face on both its sides."""
    ring[q] = q
    ring[q + 1] = q + 3
    ring[q + 2] = q + 2
    ring[q + 3] = q + 1


@jit
def splice(ring: EdgeArray, a: int, b: int) -> None:
    """Exchange what follows a and b round their origins, and so round their left faces; its own inverse.

    Two different origins become one (and one left face two), or one origin becomes two.
    """
    alpha, beta = rot(ring[a]), rot(ring[b])
    ring[a], ring[b] = ring[b], ring[a]
    ring[alpha], ring[beta] = ring[beta], ring[alpha]


# For a primal edge (r even) turning is an XOR: rot(e) = e ^ 1, inv_rot(e) = e ^ 3, and back for its dual. The
# algorithms walk and build primal edges only, by the face relation lnext and the vertex relation onext.


@jit
def left_next(ring: EdgeArray, e: int) -> int:
    """Return lnext of a primal edge."""
    return int(ring[e ^ 3]) ^ 3


@jit
def link_ring(ring: EdgeArray, e: int, f: int) -> None:
    """Make f follow e round their left face, and so sym(e) follow f round the vertex between: one corner of a face."""
    ring[e ^ 3] = f ^ 3
    ring[f] = e ^ 2


@jit
def split_face(ring: EdgeArray, org: EdgeArray, e: int, new: int, p: int) -> None:
    """Join the new vertex p to the corners of the triangle on the left of e, by the edges new, new + 4, new + 8.

                    c                                 c
                   / \\                              /|\\
                  /   \\                            / | \\          new      p -> a
                 /     \\             ->           /  p  \\         new + 4  p -> b
                /       \\                        / .   . \\        new + 8  p -> c
               a----e--->b                       a----e--->b
    """
    bc = left_next(ring, e)
    ca = left_next(ring, bc)
    pa, pb, pc = new, new + 4, new + 8
    org[pa >> 1] = org[pb >> 1] = org[pc >> 1] = p
    org[(pa ^ 2) >> 1] = org[e >> 1]
    org[(pb ^ 2) >> 1] = org[bc >> 1]
    org[(pc ^ 2) >> 1] = org[ca >> 1]
    link_ring(ring, e, pb ^ 2)
    link_ring(ring, pb ^ 2, pa)
    link_ring(ring, pa, e)
    link_ring(ring, bc, pc ^ 2)
    link_ring(ring, pc ^ 2, pb)
    link_ring(ring, pb, bc)
    link_ring(ring, ca, pa ^ 2)
    link_ring(ring, pa ^ 2, pc)
    link_ring(ring, pc, ca)


@jit
def swap(ring: EdgeArray, org: EdgeArray, e: int) -> None:
    """Turn the edge e counterclockwise inside the quadrilateral of its two triangles.

                    c                                 c
                   / \\                              /^\\
                  /   \\                            / | \\
                 /     \\                          /  |  \\         the triangles a b c and b a d
                a---e-->b            ->           a   e   b        become d c a and c d b
                 \\     /                          \\  |  /
                  \\   /                            \\ | /
                   \\ /                              \\|/
                    d                                 d
    """
    back = e ^ 2
    bc = left_next(ring, e)
    ca = left_next(ring, bc)
    ad = left_next(ring, back)
    db = left_next(ring, ad)
    org[e >> 1] = org[db >> 1]
    org[back >> 1] = org[ca >> 1]
    link_ring(ring, e, ca)
    link_ring(ring, ca, ad)
    link_ring(ring, ad, e)
    link_ring(ring, back, db)
    link_ring(ring, db, bc)
    link_ring(ring, bc, back)
