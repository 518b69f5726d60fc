"""One target under libFuzzer, which ends the process that it runs in: started by the command, in a process of its own.

``python -m proofs_tests.fuzzing.child TARGET FOLDER ARGUMENTS...``; the arguments are libFuzzer's.
"""

import sys
from pathlib import Path
from typing import NoReturn

#: What is watched for new lines: ours, and meshio.
WATCHED = ("exactmesh", "exactkernel", "meshio", "proofs_tests.fuzzing")


def main(name: str, folder: Path, arguments: list[str]) -> NoReturn:
    """Fuzz one target until libFuzzer has enough of it; each new breach of the law is minimised and written."""
    import atheris  # type: ignore[import-not-found, unused-ignore]  # an extra that few have

    with atheris.instrument_imports(include=list(WATCHED)):
        from proofs_tests.fuzzing.findings import known, written
        from proofs_tests.fuzzing.judging import judged
        from proofs_tests.fuzzing.minimising import minimised
        from proofs_tests.fuzzing.targets import target_named

        target = target_named(name)
        target.seeds()  # which imports what the readers import
    found = known(folder, name)

    def one_input(data: bytes) -> None:
        breach = judged(target, data)
        if breach is None or breach.signature in found:
            return
        found.add(breach.signature)
        tries = 20 if breach.kind == "Hang" else 1500
        signature = breach.signature

        def is_as_bad(other: bytes) -> bool:
            again = judged(target, other)
            return again is not None and again.signature == signature

        smallest = minimised(data, is_as_bad, tries)
        path = written(folder, name, smallest, judged(target, smallest) or breach)
        print(f"FINDING {path}: {breach.signature}: {breach.message}", file=sys.stderr, flush=True)

    atheris.Setup([sys.argv[0], *arguments], one_input)
    atheris.Fuzz()
    raise SystemExit(0)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), sys.argv[3:])
