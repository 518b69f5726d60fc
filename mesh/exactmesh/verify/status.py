"""The status of the plane sweep: the edges that the sweep line meets, from below to above.

A treap (binary search tree by position, heap by random priority) threaded with a list, on flat arrays; nodes
are edges. The order is the caller's: an edge is inserted between its two neighbours. Expected O(log b) an
operation. Reference [Aragon 1989].
"""

from typing import NamedTuple

import numpy as np

from exactkernel.jit import jit
from exactmesh.verify.witness import IndexArray

__all__ = ["NIL", "Status", "empty_status", "insert", "remove"]

NIL = -1


class Status(NamedTuple):
    """The tree and the list.

    Attributes:
        child: intp (b, 2): the subtree below, the subtree above.
        parent, below, above: intp (b,): the parent in the tree, the neighbours in the list.
        priority: intp (b,): a random permutation; a parent's is larger.
        root: intp (1,).
    """

    child: IndexArray
    parent: IndexArray
    below: IndexArray
    above: IndexArray
    priority: IndexArray
    root: IndexArray


def empty_status(size: int) -> Status:
    """Return the empty status for edges 0 .. size - 1."""
    nil = np.full((3, size), NIL, dtype=np.intp)
    priority = np.random.default_rng(0).permutation(size)
    return Status(
        np.full((size, 2), NIL, dtype=np.intp),
        nil[0],
        nil[1],
        nil[2],
        priority,
        np.full(1, NIL, dtype=np.intp),
    )


@jit
def replace_child(status: Status, parent: int, old: int, new: int) -> None:
    """Hang ``new`` (or NIL) where ``old`` hangs below ``parent`` (NIL: the root)."""
    if parent == NIL:
        status.root[0] = new
    else:
        status.child[parent, 0 if status.child[parent, 0] == old else 1] = new
    if new != NIL:
        status.parent[new] = parent


@jit
def rotate_up(status: Status, e: int) -> None:
    """Exchange e with its parent p, keeping the order.

           p            e
          / \\          / \\
         e   C   ->   A   p        (or its mirror image)
        / \\              / \\
       A   B            B   C
    """
    p = status.parent[e]
    side = 0 if status.child[p, 0] == e else 1
    inner = status.child[e, 1 - side]
    replace_child(status, status.parent[p], p, e)
    status.child[p, side] = inner
    if inner != NIL:
        status.parent[inner] = p
    status.child[e, 1 - side] = p
    status.parent[p] = e


@jit
def insert(status: Status, e: int, below: int, above: int) -> None:
    """Insert e between two neighbours of the list (NIL at its ends)."""
    status.below[e] = below
    status.above[e] = above
    if below != NIL:
        status.above[below] = e
    if above != NIL:
        status.below[above] = e
    if below != NIL and status.child[below, 1] == NIL:  # of two neighbours one lies below the other in the tree
        status.child[below, 1] = e
        status.parent[e] = below
    elif above != NIL:
        status.child[above, 0] = e
        status.parent[e] = above
    else:
        status.root[0] = e
    while status.parent[e] != NIL and status.priority[status.parent[e]] < status.priority[e]:
        rotate_up(status, e)


@jit
def remove(status: Status, e: int) -> None:
    """Remove e."""
    below, above = status.below[e], status.above[e]
    if below != NIL:
        status.above[below] = above
    if above != NIL:
        status.below[above] = below
    while True:
        left, right = status.child[e, 0], status.child[e, 1]
        if left == NIL or right == NIL:
            break
        rotate_up(status, left if status.priority[left] > status.priority[right] else right)
    replace_child(status, status.parent[e], e, left if left != NIL else right)
