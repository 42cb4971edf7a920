"""Runs the adaptors of Ray, Dask and Spark on their engines, and compares each row with one rendered locally.

    unshare -rn sh -c 'ip link set lo up && python engines.py ray dask spark'

A network namespace with nothing but loopback keeps engines that listen on all addresses to this machine. Ray gets two nodes, and a
process of its actors is killed by SIGKILL while rows are rendered; `--rows 50000 --kill 0 ray` measures. CPU time is given beside
seconds, because it does not depend on what else a machine does: of all processes of an engine and of this one.
"""

from __future__ import annotations

import argparse
import os
import signal
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pyarrow as pa

from durer.batch import render_batch

SAMPLES = Path(__file__).resolve().parents[2] / "samples"
OPTIONS: dict[str, Any] = {"size": (64, 64), "samples": 4}


def table(rows: int) -> pa.Table:
    """Returns models with a camera each; every 97th is broken, every 101st is missing."""
    models = [str(SAMPLES / name) for name in ("bracket.stl", "crate.glb", "glass.glb")]
    inputs = [models[i % len(models)] for i in range(rows)]
    data: list[bytes | None] = [None] * rows
    for i in range(0, rows, 97):
        data[i] = b"v 0 0 0\nv 1 one 0\n"
    for i in range(50, rows, 101):
        inputs[i] = str(SAMPLES / "missing.obj")
    return pa.table(
        {
            "id": [f"{i:06}" for i in range(rows)],
            "input": inputs,
            "bytes": pa.array(data, pa.binary()),
            "name": ["a.obj" if d else None for d in data],
            "azimuth": [float(i % 360) for i in range(rows)],
        }
    )


def outcomes(rows: list[dict[str, Any]]) -> dict[str, tuple[str | None, str | None]]:
    """Returns the hash of each row's picture and its error, after checking that the picture has this hash."""
    import hashlib

    for row in rows:
        assert row["png"] is None or hashlib.sha256(row["png"]).hexdigest() == row["sha256"], row["id"]
    found = {row["id"]: (row["sha256"] or None, row["error"] or None) for row in rows}
    assert len(found) == len(rows), "a row is there twice"
    return found


def killer(name: str, after: float, times: int, done: threading.Event, killed: list[int]) -> threading.Thread:
    """Starts a thread that kills processes whose title contains a name."""

    def run() -> None:
        time.sleep(after)
        while len(killed) < times and not done.is_set():
            for folder in Path("/proc").iterdir():
                try:
                    title = (folder / "cmdline").read_bytes().decode(errors="replace") if folder.name.isdigit() else ""
                except OSError:
                    continue
                # Ray gives actors titles of this kind; idle workers have others.
                if name in title and int(folder.name) != os.getpid():
                    os.kill(int(folder.name), signal.SIGKILL)
                    killed.append(int(folder.name))
                    break
            done.wait(1.0)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    return thread


def spent() -> float:
    """Returns the CPU time of this process and of all its descendants, with that of those which have ended, in seconds."""
    stats = {}
    for folder in Path("/proc").iterdir():
        try:
            fields = (folder / "stat").read_text().rpartition(")")[2].split() if folder.name.isdigit() else []
        except OSError:
            continue
        if fields:
            stats[int(folder.name)] = (int(fields[1]), sum(int(ticks) for ticks in fields[11:15]))
    own = os.getpid()

    def descends(pid: int) -> bool:
        while pid in stats and pid != own:
            pid = stats[pid][0]
        return pid == own

    return sum(ticks for pid, (_, ticks) in stats.items() if descends(pid)) / os.sysconf("SC_CLK_TCK")


def on_ray(given: pa.Table, kill: int) -> tuple[list[dict[str, Any]], str]:
    import ray
    import ray.data
    from ray.cluster_utils import Cluster

    import durer.ray

    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "object_store_memory": 256 << 20})
    cluster.add_node(num_cpus=1, object_store_memory=256 << 20)
    ray.init(address=cluster.address, log_to_driver=False)
    try:
        nodes = sum(node["Alive"] for node in ray.nodes())
        ray.data.DataContext.get_current().enable_progress_bars = False
        dataset = ray.data.from_arrow(given).repartition(16)
        done, killed = threading.Event(), list[int]()
        if kill:
            killer("ray::MapWorker", 2.0, kill, done, killed)
        start, before = time.perf_counter(), spent()
        rows = durer.ray.render(dataset, batch_size=32, concurrency=(1, 2), **OPTIONS).take_all()
        seconds, cpu = time.perf_counter() - start, spent() - before
        done.set()
        how = f"{nodes} nodes, {len(killed)} actors killed, {seconds:.1f} s with the start of actors"
        return rows, f"{how}, {cpu:.1f} s of CPU time, {len(rows) / cpu:.0f} rows for each"
    finally:
        ray.shutdown()
        cluster.shutdown()


def on_dask(given: pa.Table, kill: int) -> tuple[list[dict[str, Any]], str]:
    import dask
    import dask.dataframe as dd
    from dask.distributed import Client, LocalCluster

    import durer.dask

    dask.config.set({"dataframe.convert-string": False})
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        frame = dd.from_pandas(given.to_pandas(), npartitions=16)
        done, killed = threading.Event(), list[int]()
        if kill:
            pids = list(client.run(os.getpid).values())
            timer = threading.Timer(2.0, lambda: (killed.append(pids[0]), os.kill(pids[0], signal.SIGKILL)))
            timer.start()
        start = time.perf_counter()
        made = durer.dask.render(frame, **OPTIONS).compute()
        seconds = time.perf_counter() - start
        done.set()
    rows = made.astype(object).where(made.notna(), None).to_dict("records")
    return rows, f"2 workers, {len(killed)} killed, {seconds:.1f} s"


def on_spark(given: pa.Table, kill: int) -> tuple[list[dict[str, Any]], str]:
    from pyspark.sql import SparkSession

    import durer.spark

    # Otherwise workers run the first Python on the path.
    os.environ["PYSPARK_PYTHON"] = sys.executable
    session = (
        SparkSession.builder.master("local[2]")
        .config("spark.ui.enabled", "false")
        .config("spark.driver.host", "127.0.0.1")
        .config("spark.driver.bindAddress", "127.0.0.1")
        .config("spark.sql.execution.arrow.maxRecordsPerBatch", "32")
        .getOrCreate()
    )
    try:
        schema = "id string, input string, bytes binary, name string, azimuth double"
        frame = session.createDataFrame([tuple(row.values()) for row in given.to_pylist()], schema).repartition(16)
        start = time.perf_counter()
        rows = [row.asDict() for row in durer.spark.render(frame, **OPTIONS).collect()]
        for row in rows:
            row["png"] = None if row["png"] is None else bytes(row["png"])
        return rows, f"local[2], {time.perf_counter() - start:.1f} s"
    finally:
        session.stop()


ENGINES = {"ray": on_ray, "dask": on_dask, "spark": on_spark}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("engines", nargs="+", choices=ENGINES)
    parser.add_argument("--rows", type=int, default=600)
    parser.add_argument("--kill", type=int, default=1, help="processes to kill (Ray, Dask)")
    arguments = parser.parse_args()
    given = table(arguments.rows)
    # Workers import the package from where this process has it.
    start, before = time.perf_counter(), spent()
    made = render_batch(given, threads=1, **OPTIONS).to_pylist()
    seconds, cpu = time.perf_counter() - start, spent() - before
    local = outcomes(made)
    failed = sum(error is not None for _, error in local.values())
    how = f"{seconds:.1f} s on one thread, {cpu:.1f} s of CPU time, {len(made) / cpu:.0f} rows for each"
    print(f"here: {arguments.rows} rows, {failed} of them failed, {how}", flush=True)
    for name in arguments.engines:
        rows, how = ENGINES[name](given, arguments.kill)
        found = outcomes(rows)
        assert found == local, [(i, found.get(i), local[i]) for i in local if found.get(i) != local[i]][:3]
        print(f"{name}: all rows as here; {how}", flush=True)


if __name__ == "__main__":
    main()
