"""How an obligation is discharged: a fixed vocabulary."""

from enum import StrEnum

__all__ = ["Method"]


class Method(StrEnum):
    """What is done to see that a statement holds, from proof to sample.

    ``CALCULUS`` to ``EXHAUSTIVE`` are proofs, for all numbers or for all inputs of a format or a set of states;
    ``ENUMERATION`` is all cases of small sizes, of which there are infinitely many larger ones; the rest are tests.
    """

    CALCULUS = "calculus"
    GAPPA = "Gappa and Coq"
    SYMBOLIC = "symbolic"
    EXHAUSTIVE = "exhaustive"
    ENUMERATION = "enumeration"
    PROPERTY = "property-based"
    MACHINE = "stateful machine"
    NAMED = "named cases"
    DIFFERENTIAL = "differential"
    ABLATION = "ablation"
    CORRUPTION = "corruption"
    MUTATION = "mutation"
    BITS = "bit for bit"
    MACHINE_CODE = "machine code"
    FUZZING = "fuzzing"
