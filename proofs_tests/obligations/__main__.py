"""python -m proofs_tests.obligations > docs/obligations.md."""

from proofs_tests.obligations.markers import collect, table

print(table(collect()), end="")
