"""Fixtures of all tests."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[3]
SAMPLES = ROOT / "samples"


@pytest.fixture
def samples() -> Path:
    """The folder of models and maps of the repository."""
    return SAMPLES


@pytest.fixture
def cube() -> tuple[np.ndarray, np.ndarray]:
    """The unit cube, twelve triangles facing outwards."""
    vertices = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=np.float64)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = [[q[0], q[i], q[i + 1]] for q in quads for i in (1, 2)]
    return vertices, np.array(faces, dtype=np.int64)


@pytest.fixture
def command() -> list[str]:
    """The command to compare with: the one in DURER, or the one of the package."""
    import sys

    given = os.environ.get("DURER")
    return [given] if given else [sys.executable, "-m", "durer"]
