"""How long a compiled run may be: Ctrl-C waits for its end."""

import math

from exactkernel.context import Context

__all__ = ["chunk_size"]

_SLOWDOWN_BITS = 7  # a rational predicate takes about as long as a hundred others


def chunk_size(k: Context, usual: int) -> int:
    """Return how many items to take between two looks at Ctrl-C: fewer where every predicate may be rational."""
    return usual if k.incircle_bound < math.inf else usual >> _SLOWDOWN_BITS
