"""``python -m exactmesh`` is the command ``exactmesh``."""

import sys

from exactmesh.cli import main

if __name__ == "__main__":
    sys.exit(main())
