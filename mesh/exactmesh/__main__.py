"""``python -m exactmesh`` is the command ``exactmesh``."""

from exactmesh.cli import main

if __name__ == "__main__":
    main()
