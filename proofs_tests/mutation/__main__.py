"""Mutation testing of the kernel, the verifier and the algorithms.

NUMBA_DISABLE_JIT=1 coverage run -m pytest -p proofs_tests.mutation.contexts --junitxml=times.xml -m "not compiled"
coverage combine
python -m proofs_tests.mutation --times times.xml                 # all: about two hours on two cores
python -m proofs_tests.mutation --times times.xml --sample 200    # what CI does
"""

import os

os.environ |= {"NUMBA_DISABLE_JIT": "1", "HYPOTHESIS_PROFILE": "mutation", "PYTHONDONTWRITEBYTECODE": "1"}

from proofs_tests.mutation.command import main

main()
