#!/usr/bin/env python3
"""Kills `durer batch` at random moments, and checks that what it makes after --resume is what an undisturbed run makes.

    prove.py DURER SAMPLES FOLDER [--rows 10000] [--kills 50] [--jobs 2] [--seed 1] [--kinds 3] [--disk]

--kinds 1 renders cubes only, for builds without optimization. FOLDER is created; it must not exist. --disk also fills a small disk, which needs the right to mount a tmpfs. Linux only.
Prints a line per check and ends with 0 if all hold.
"""

import argparse
import hashlib
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

CUBE = """\
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"""
COMMAND = ["--", "render", "--size", "32"]


def check(holds, what):
    print(("ok    " if holds else "WRONG ") + what, flush=True)
    if not holds:
        check.wrong += 1


check.wrong = 0


def manifest(folder, samples, rows, kinds):
    (folder / "cube.obj").write_text(CUBE)
    models = [folder / "cube.obj", samples / "bracket.stl", samples / "crate.glb"][:kinds]
    lines = ["id,input,azimuth,elevation"]
    for i in range(rows):
        lines.append(f"{i % 100:02}/row-{i},{models[i % kinds]},{i % 360},{i * 7 % 120 - 60}")
    (folder / "rows.csv").write_text("\n".join(lines) + "\n")


def start(args, out, *options):
    line = [args.durer, "batch", args.folder / "rows.csv", "-o", out, "--jobs", str(args.jobs), *options, *COMMAND]
    return subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def finish(process):
    _, printed = process.communicate()
    return process.returncode, printed


def outputs(out):
    found = {}
    for path in out.rglob("*"):
        if path.is_file() and path.parts[len(out.parts)] != ".durer":
            found[str(path.relative_to(out))] = hashlib.sha256(path.read_bytes()).hexdigest()
    return found


def entries(out):
    found = []
    for path in sorted((out / ".durer").glob("shard-*.jsonl")):
        for line in path.read_bytes().split(b"\n"):
            try:
                found.append(json.loads(line))
            except ValueError:
                pass
    return found


def children(pid):
    try:
        listed = [pathlib.Path(f"/proc/{pid}/task/{t}/children").read_text() for t in os.listdir(f"/proc/{pid}/task")]
        return [int(child) for child in " ".join(listed).split()]
    except OSError:
        return []


def kill(pid, number=signal.SIGKILL):
    try:
        os.kill(pid, number)
    except ProcessLookupError:
        pass


def tear(out, chance):
    """Cuts the last line of a journal, or begins another one."""
    path = out / ".durer/shard-0-of-1.jsonl"
    content = path.read_bytes() if path.exists() else b""
    if len(content) < 100:
        return 0
    if chance.random() < 0.5:
        path.write_bytes(content[: -chance.randrange(1, 60)])
        return 1
    path.write_bytes(content + b'{"id":"00/row-0","key":"12')
    return 0


def disturbed(args, out, seconds, chance):
    """Runs all rows with kills; returns how many there were of each kind, and lines that were torn away."""
    counts = {"worker": 0, "parent": 0, "term": 0}
    torn, refused, slowest, process = 0, 0, 0.0, start(args, out)
    pause = seconds / args.kills * 0.7
    while sum(counts.values()) < args.kills:
        time.sleep(chance.uniform(0.1, 1.9) * pause)
        if process.poll() is not None:
            break
        kind = chance.choices(["worker", "parent", "term"], [5, 4, 1])[0]
        if kind == "worker":
            workers = children(process.pid)
            if not workers:
                continue
            kill(chance.choice(workers))
            counts[kind] += 1
            continue
        if refused < 3:
            code, printed = finish(start(args, out, "--resume"))
            refused += code == 1 and "another process works on shard 0/1" in printed
        workers, begun = children(process.pid), time.monotonic()
        kill(process.pid, signal.SIGTERM if kind == "term" else signal.SIGKILL)
        code, printed = finish(process)
        counts[kind] += 1
        if kind == "term":
            slowest = max(slowest, time.monotonic() - begun)
            if code != 3:
                check(False, f"SIGTERM ends with {code}, not 3: {printed}")
        else:
            torn += tear(out, chance)
        process = start(args, out, "--resume")
    code, printed = finish(process)
    check(refused == 3, f"a second process on a shard is refused ({refused} of 3 times)")
    check(slowest < 25, f"SIGTERM ends the run in time ({slowest:.2f} s at most)")
    for _ in range(3):
        if code == 0:
            break
        code, printed = finish(start(args, out, "--resume"))
    check(code == 0, f"the last run ends with 0: {printed.strip()}")
    return counts, torn


def compare(args, out, expected, most_again, what):
    found = outputs(out)
    check(found.keys() == expected.keys(), f"{what}: {len(found)} outputs are there, no other files")
    wrong = [name for name in expected if found.get(name) != expected[name]]
    check(not wrong, f"{what}: all bytes are those of the undisturbed run {wrong[:3] or ''}")
    done = [entry["id"] for entry in entries(out) if entry["status"] == "done"]
    again = len(done) - len(set(done))
    check(len(set(done)) == args.rows, f"{what}: each row is noted as done")
    check(again <= most_again, f"{what}: {again} rows were noted as done twice; at most {most_again} were in flight")
    left = [path for path in (out / ".durer").iterdir() if path.suffix not in (".jsonl", ".lock")]
    check(not left, f"{what}: no temporary files are left")
    counted = {e["id"]: e["sha256"] for e in entries(out) if e["status"] == "done"}
    names = {e["id"]: e["output"] for e in entries(out)}
    check(all(found.get(names[i]) == counted[i] for i in counted), f"{what}: the journal has the hashes of the files")


def full_disk(args, expected):
    disk = args.folder / "disk"
    disk.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={args.rows}k", "none", disk], check=True)
    try:
        code, printed = finish(start(args, disk / "out"))
        check(code in (1, 3) and "No space left" in printed, f"full disk: ends with {code}, and says why")
        part = outputs(disk / "out")
        check(all(expected[n] == h for n, h in part.items()), f"full disk: the {len(part)} files that are there are whole")
        subprocess.run(["mount", "-o", "remount,size=1g", disk], check=True)
        code, printed = finish(start(args, disk / "out", "--resume"))
        check(code == 0, f"full disk: with room again the run ends with 0: {printed.strip()}")
        compare(args, disk / "out", expected, 2 * args.jobs, "full disk")
    finally:
        subprocess.run(["umount", disk], check=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("durer", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("samples", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("folder", type=lambda p: pathlib.Path(p).resolve())
    for name, default in [("rows", 10000), ("kills", 50), ("jobs", 2), ("seed", 1), ("kinds", 3)]:
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument("--disk", action="store_true")
    args = parser.parse_args()
    chance = random.Random(args.seed)
    args.folder.mkdir(parents=True)
    manifest(args.folder, args.samples, args.rows, args.kinds)

    begun = time.monotonic()
    code, printed = finish(start(args, args.folder / "base"))
    seconds = time.monotonic() - begun
    check(code == 0, f"undisturbed: {printed.strip()}")
    expected = outputs(args.folder / "base")
    check(len(expected) == args.rows, f"undisturbed: {len(expected)} outputs")
    begun = time.monotonic()
    code, printed = finish(start(args, args.folder / "base", "--resume"))
    check(code == 0 and f"{args.rows} done before" in printed, f"resumed at the end: {printed.strip()}")

    counts, torn = disturbed(args, args.folder / "out", seconds, chance)
    killed = ", ".join(f"{count} of {kind}" for kind, count in counts.items())
    check(sum(counts.values()) == args.kills, f"kills: {killed}; {torn} lines of the journal torn away")
    # With a parent go the rows of all its workers, and a torn line is a row, too.
    compare(args, args.folder / "out", expected, counts["parent"] * args.jobs + torn, "disturbed")
    if args.disk:
        full_disk(args, expected)
    shutil.rmtree(args.folder)
    print("all checks hold" if check.wrong == 0 else f"{check.wrong} checks do not hold")
    sys.exit(check.wrong > 0)


main()
