"""Batches: one row in, one row out; a failed row has its error in a column, and the batch continues."""

from __future__ import annotations

import hashlib
import time
from typing import Any

from . import _durer
from ._errors import ReadWarning
from ._geometry import region_of
from ._options import threads as count
from ._picture import render
from ._scene import read
from ._wkb import to_wkb_list

#: Columns of a batch that identify a row and its input; all others are options of ``render``.
GIVEN = ("id", "input", "bytes", "name")


def render_batch(batch: Any, **options: Any) -> Any:
    """Renders each row of a ``pyarrow.RecordBatch`` or ``Table`` to a PNG; never raises for a row.

    A row has ``input``, a path, or ``bytes`` with a ``name``, a file name that gives the format if the bytes do not;
    ``id``, by default its number; and any options of ``durer.render`` as columns, which override the keyword arguments.

    Returns a table with ``id``, ``png``, ``width``, ``height``, ``sha256`` (of the PNG), ``seconds``, ``warnings``, ``error``.
    """
    import pyarrow as pa

    rows = [_rendered(number, row, options) for number, row in enumerate(batch.to_pylist())]
    schema = pa.schema(
        [
            ("id", pa.string()),
            ("png", pa.large_binary()),
            ("width", pa.int32()),
            ("height", pa.int32()),
            ("sha256", pa.string()),
            ("seconds", pa.float64()),
            ("warnings", pa.list_(pa.string())),
            ("error", pa.string()),
        ]
    )
    return _like(batch, {name: [row.get(name) for row in rows] for name in schema.names}, schema)


def _like(batch: Any, columns: dict[str, list[Any]], schema: Any) -> Any:
    """Returns columns as the same kind of table as the input."""
    import pyarrow as pa

    kind = pa.Table if isinstance(batch, pa.Table) else pa.RecordBatch
    return kind.from_pydict(columns, schema=schema)


def _rendered(number: int, row: dict[str, Any], options: dict[str, Any]) -> dict[str, Any]:
    import warnings

    start = time.perf_counter()
    out: dict[str, Any] = {"id": str(row.get("id", number) or number)}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ReadWarning)
            data = row.get("bytes")
            source = row.get("input") if data is None else data
            if source is None:
                raise ValueError("the row has neither input nor bytes")
            model = read(source, name=row.get("name"))
        own = {name: value for name, value in row.items() if name not in GIVEN and value is not None}
        picture = render(model, **{**options, **own})
        png = picture.png()
        out.update(png=png, width=picture.width, height=picture.height)
        out.update(sha256=hashlib.sha256(png).hexdigest(), warnings=model.warnings, error=None)
        if picture.unseen:
            out["warnings"] = [*model.warnings, picture.unseen]
    except Exception as error:
        out["error"] = f"{type(error).__name__}: {error}"
    out["seconds"] = time.perf_counter() - start
    return out


def clip_batch(batch: Any, mask: Any, *, geometry: str = "geometry", grid_size: float | None = None) -> Any:
    """Clips the column of WKB of a ``pyarrow.RecordBatch`` or ``Table``; never raises for a row.

    All other columns stay; a column ``error`` is added, and the geometry of a row that failed is null.
    """
    import pyarrow as pa

    names = batch.schema.names
    column = batch.column(names.index(geometry))
    if isinstance(column, pa.ChunkedArray):
        column = column.combine_chunks()
    rows, errors = _durer.clip_wkb(to_wkb_list(column), region_of(mask), grid_size, count(None))
    by_row = dict(errors)
    columns = [pa.array(rows, column.type) if name == geometry else batch.column(i) for i, name in enumerate(names)]
    fields = list(batch.schema)
    columns.append(pa.array([by_row.get(i) for i in range(len(rows))], pa.string()))
    schema = pa.schema([*fields, ("error", pa.string())], metadata=batch.schema.metadata)
    return (pa.Table if isinstance(batch, pa.Table) else pa.RecordBatch).from_arrays(columns, schema=schema)
