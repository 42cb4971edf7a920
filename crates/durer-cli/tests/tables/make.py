"""Makes rows.parquet, a manifest as pandas and pyarrow write them: dictionaries, lists, gaps in every way, two row groups.

    python make.py
"""

import pyarrow as pa
import pyarrow.parquet as pq

ROWS = {
    "id": ["angle", "eye", "lights", "gone"],
    "input": pa.array(["cube.obj"] * 3 + ["gone.obj"]).dictionary_encode(),
    # Integers with gaps, as pandas has them.
    "size": pa.array([8.0, float("nan"), 12.0, 8.0]),
    "azimuth": pa.array([30.5, None, float("nan"), 0.1], pa.float32()),
    "eye": pa.array([None, [4.0, 3.5, 5.0], None, None], pa.list_(pa.float64())),
    "light": pa.array([None, None, ["ambient:white:0.2", "directional:-1,-2,-1:red"], None]),
    "grid": [True, False, None, None],
    "aa": pa.array([1, 1, 4, 1], pa.uint8()),
    "background": pa.array([b"black", None, b"", None], pa.binary()),
}

pq.write_table(pa.table(ROWS), "rows.parquet", row_group_size=3, compression="zstd")
