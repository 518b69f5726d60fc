"""Where targets run under libFuzzer, which ends its process: each in a fork of one that has imported everything.

``python -m proofs_tests.fuzzing.nursery`` reads lines of JSON: a target, the folder of findings, a file for what is
said, arguments of libFuzzer; and prints a line when the fork has ended. The command starts it.
"""

import json
import os
import sys
from pathlib import Path
from typing import NoReturn

#: What is watched for new lines: ours, and meshio.
WATCHED = ("exactmesh", "exactkernel", "meshio", "proofs_tests.fuzzing")


def fuzz(name: str, folder: Path, arguments: list[str]) -> NoReturn:
    """Fuzz one target until libFuzzer has enough of it; each new breach of the law is minimised and written."""
    import atheris  # type: ignore[import-not-found, unused-ignore]  # an extra that few have
    from proofs_tests.fuzzing.findings import known, written
    from proofs_tests.fuzzing.judging import judged
    from proofs_tests.fuzzing.minimising import minimised
    from proofs_tests.fuzzing.targets import target_named

    target, found = target_named(name), known(folder, name)

    def one_input(data: bytes) -> None:
        breach = judged(target, data)
        if breach is None or breach.signature in found:
            return
        found.add(breach.signature)
        signature = breach.signature

        def is_as_bad(other: bytes) -> bool:
            again = judged(target, other)
            return again is not None and again.signature == signature

        smallest = minimised(data, is_as_bad, 20 if breach.kind == "Hang" else 1500)
        path = written(folder, name, smallest, judged(target, smallest) or breach)
        print(f"FINDING {path}: {breach.signature}: {breach.message}", file=sys.stderr, flush=True)

    atheris.Setup([name, *arguments], one_input)
    atheris.Fuzz()
    os._exit(0)


def main() -> None:
    """Import everything once, watched, and fork for each line."""
    import atheris

    with atheris.instrument_imports(include=list(WATCHED)):
        from proofs_tests.fuzzing.targets import TARGETS

        for target in TARGETS.values():
            target.seeds()  # which imports what the readers import
    print("ready", flush=True)
    for line in sys.stdin:
        name, folder, log, arguments = json.loads(line)
        child = os.fork()
        if child == 0:
            said = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
            for stream, file in ((0, os.open(os.devnull, os.O_RDONLY)), (1, said), (2, said)):
                os.dup2(file, stream)
            fuzz(name, Path(folder), arguments)
        os.waitpid(child, 0)
        print("done", flush=True)


if __name__ == "__main__":
    main()
