"""How a compiled predicate says sign and stage in one small integer: stage * 4 + sign + 1."""

from exactkernel.types import Sign, Stage

__all__ = ["DECODED", "DOUBLE_DOUBLE", "EXPANSION", "FILTER", "GRID", "RATIONAL"]

# The code of ZERO at each stage; the sign is added to it.
FILTER = int(Stage.FILTER) * 4 + 1
GRID = int(Stage.GRID) * 4 + 1
DOUBLE_DOUBLE = int(Stage.DOUBLE_DOUBLE) * 4 + 1
EXPANSION = int(Stage.EXPANSION) * 4 + 1
RATIONAL = int(Stage.RATIONAL) * 4 + 1

#: From the code to what the public predicates return (index 3 of each stage is never used).
DECODED: tuple[tuple[Sign, Stage], ...] = tuple(
    (Sign(min(code & 3, 2) - 1), Stage(code >> 2)) for code in range(4 * len(Stage))
)
