"""The notebook of the documentation runs and gives the outputs that it shows."""

from __future__ import annotations

from typing import Any

import pytest

from conftest import ROOT

FOLDER = ROOT / "docs" / "notebooks"


def shown(cell: Any) -> list[Any]:
    """Returns the texts that a cell prints, and the kinds of its outputs."""
    out = []
    for output in cell.outputs:
        out.append(output.text if output.output_type == "stream" else sorted(output.data))
    return out


@pytest.mark.parametrize("name", sorted(path.name for path in FOLDER.glob("*.ipynb")))
def test_notebook(name):
    nbformat = pytest.importorskip("nbformat")
    preprocessors = pytest.importorskip("nbconvert.preprocessors")
    pytest.importorskip("ipykernel")
    written = nbformat.read(FOLDER / name, as_version=4)
    nbformat.validate(written)
    codes = [cell for cell in written.cells if cell.cell_type == "code"]
    wanted = [shown(cell) for cell in codes]
    # A cell that fails is an error with its traceback.
    preprocessors.ExecutePreprocessor(timeout=120, kernel_name="python3").preprocess(written, {"metadata": {"path": FOLDER}})
    found = [shown(cell) for cell in codes]
    assert len(found) >= 5 and all(found)
    # A notebook may be kept without outputs.
    assert not any(wanted) or found == wanted


def test_the_notebook_is_small():
    for path in FOLDER.glob("*.ipynb"):
        assert path.stat().st_size < 250_000, path.name
