"""Dask: pictures of the rows of a data frame, partition by partition, errors as a column."""

from __future__ import annotations

from typing import Any

from .batch import render_batch

#: Columns of the result with their types in pandas.
COLUMNS = {
    "id": "object",
    "png": "object",
    "width": "float64",
    "height": "float64",
    "sha256": "object",
    "seconds": "float64",
    "warnings": "object",
    "error": "object",
}


def _partition(frame: Any, options: dict[str, Any]) -> Any:
    import pandas
    import pyarrow

    rows = render_batch(pyarrow.Table.from_pandas(frame, preserve_index=False), **options).to_pylist()
    made = pandas.DataFrame(rows, columns=list(COLUMNS), index=frame.index)
    return made.astype({name: kind for name, kind in COLUMNS.items() if kind != "object"})


def render(frame: Any, **options: Any) -> Any:
    """Renders each row of a ``dask.dataframe``; see ``durer.batch.render_batch`` for its columns."""
    return frame.map_partitions(_partition, {"threads": 1, **options}, meta=COLUMNS)
