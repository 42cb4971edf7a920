"""Spark: pictures of the rows of a data frame by ``mapInArrow``, errors as a column."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from .batch import render_batch

#: Columns of the result, as Spark writes schemas.
SCHEMA = (
    "id string, png binary, width int, height int, sha256 string, seconds double, "
    "warnings array<string>, error string"
)


class _Renderer:
    def __init__(self, options: dict[str, Any]) -> None:
        self.options = options

    def __call__(self, batches: Iterable[Any]) -> Iterator[Any]:
        import pyarrow as pa

        for batch in batches:
            made = render_batch(batch, **self.options)
            # Spark's binary has offsets of 32 bits.
            png = made.column(1).cast(pa.binary())
            columns = [png if name == "png" else made.column(i) for i, name in enumerate(made.schema.names)]
            yield pa.RecordBatch.from_arrays(columns, names=made.schema.names)


def render(frame: Any, **options: Any) -> Any:
    """Renders each row of a ``pyspark.sql.DataFrame``; see ``durer.batch.render_batch`` for its columns."""
    return frame.mapInArrow(_Renderer({"threads": 1, **options}), SCHEMA)
