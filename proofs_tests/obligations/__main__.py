"""python -m proofs_tests.obligations > docs/obligations.md."""

from proofs_tests.obligations.markers import collect
from proofs_tests.obligations.measured import load
from proofs_tests.obligations.page import page

print(page(collect(), load()), end="")
