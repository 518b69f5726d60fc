"""Record what the ``triangle`` package returns: keys in their order, shapes and types; run where it is installed.

python -m proofs_tests.drop_in.record_contract
"""

import json
from pathlib import Path

import numpy as np
from proofs_tests.drop_in.inputs import INPUTS, calls

RECORD = Path(__file__).parent / "contract.json"


def contract() -> dict[str, dict[str, str]]:
    """Return for each input and switches ``key:type:shape ...``; of refined meshes the rows are not counted."""
    import triangle

    found: dict[str, dict[str, str]] = {}
    for name, (plain, refined) in calls().items():
        content = {key: np.array(rows) for key, rows in INPUTS[name].items()}
        found[name] = {o: told(triangle.triangulate(content, o), o in refined) for o in (*plain, *refined)}
    return found


def told(result: dict[str, np.ndarray[tuple[int, ...], np.dtype[np.generic]]], refined: bool) -> str:
    """Return keys, types and shapes in one line."""
    rows = {key: "*" if refined and key not in ("holes", "regions") else str(len(a)) for key, a in result.items()}
    return " ".join(f"{key}:{a.dtype}:{rows[key]}x{a.shape[1]}" for key, a in result.items())


if __name__ == "__main__":
    RECORD.write_text(json.dumps(contract(), indent=0) + "\n", encoding="utf-8")
