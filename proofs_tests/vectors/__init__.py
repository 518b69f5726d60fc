"""Hard cases for every predicate, with their exact signs: data/ for any language, and the script that makes them.

``python -m proofs_tests.vectors`` writes data/ anew, byte for byte the same on every machine: no libm, no random module
and no code of the kernel takes part. See docs/vectors.md.
"""
