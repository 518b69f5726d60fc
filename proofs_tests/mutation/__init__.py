"""Mutation testing: X1, the tests can fail. See ``python -m proofs_tests.mutation --help`` and docs/mutation.md."""
