"""The command ``durer``: ``python -m durer render model.stl -o picture.png``."""

from __future__ import annotations

import sys

from . import _durer


def main() -> int:
    """Runs the command with the arguments of the process and returns its exit code."""
    return _durer.command(["durer", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
