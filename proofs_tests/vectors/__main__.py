"""``python -m proofs_tests.vectors``: write data/ anew."""

from proofs_tests.vectors.files import DATA, text_of
from proofs_tests.vectors.predicates import PREDICATES

if __name__ == "__main__":
    DATA.mkdir(exist_ok=True)
    for p in PREDICATES:
        text = text_of(p)
        (DATA / f"{p.name}.txt").write_text(text, encoding="ascii", newline="\n")
        print(f"{p.name}: {sum(not line.startswith('#') for line in text.splitlines())} cases, {len(text)} bytes")
