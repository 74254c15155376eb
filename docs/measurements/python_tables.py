#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Measures the two tables of docs/python.md and writes them into it: tests/bench/python_bench.py and peers.py.

Needs the packages of third_party/debian-packages-peers.txt, and an idle machine. Usage:
  python_tables.py BUILD [--poses N]     BUILD: a build folder with the program and the Python package; N of each kind
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "python.md"
PEERS = {"python": "`scene.detect(…, yes_no=True)`",
         "certified": "the same in C++, `voxtact bench`",
         "vtk": "VTK {vtk}, isosurface and `vtkCollisionDetectionFilter`",
         "open3d": "Open3D {open3d}, the same isosurface and `TriangleMesh.is_intersecting`, {most} poses of each",
         "distance": "distance transform at the vertices (SciPy {scipy})",
         "distance, dense": "… at points half a voxel apart",
         "vertices, dense": "the image itself at points half a voxel apart"}


def rounded(value):
    """Three digits; of what is less than one, one."""
    if value < 1:
        return f"{value:.1g}"
    digits = max(0, len(str(int(value))) - 3)
    return f"{round(value, -digits):,.0f}"


def percent(value):
    return f"{value:.1f}".removesuffix(".0")


def signed(value):
    return f"{value:.1f}".replace("-", "−")


def bench_table(rows):
    yield "| | the engine | Python adds |"
    yield "| --- | --- | --- |"
    for row in sorted(rows, key=lambda row: row["poses"]):
        if row["poses"] == 1:
            yield (f"| one pose, {row['threads']} | {row['engine_us']:.1f} µs | {row['more_us']:.1f} µs (90 % of 5,000: "
                   f"{row['low_us']:.1f} to {row['high_us']:.1f}) |")
        else:
            yield (f"| {row['poses']:,} poses, {row['threads']} | {row['engine_s']:.2f} s of processors | {signed(row['more_percent'])} % "
                   f"(median of 15; {signed(row['low_percent'])} to {signed(row['high_percent'])}) |")


def peers_table(result):
    yield "| | onset: missed % | false % | pairs/s | large: missed % | false % | pairs/s | made first |"
    yield "| --- | --- | --- | --- | --- | --- | --- | --- |"
    rows = {(row["engine"], row["poses"]): row for row in result["rows"]}
    for engine, name in PEERS.items():
        if (engine, "onset") not in rows:
            print(f"no row for {engine}: it is not installed")
            continue
        cells = [name.format(**result["versions"], most=result["open3d_poses"])]
        for kind in ("onset", "large"):
            row = rows[engine, kind]
            cells += [percent(row["missed_percent"]), percent(row["false_percent"]), rounded(row["pairs_per_cpu_s"])]
        first = result["setup_cpu_s"].get("python" if engine == "certified" else engine, 0)
        cells.append(f"{first:.1f} s" if first else "nothing")
        yield "| " + " | ".join(cells) + " |"


def replaced(text, name, lines):
    """The table after the mark of that name is these lines."""
    mark = f"<!-- table: {name} -->\n"
    begin = text.index(mark) + len(mark)
    end = text.index("\n\n", begin)
    return text[:begin] + "\n".join(lines) + text[end:]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--poses", type=int, default=300)
    options = parser.parse_args()
    paths = [str(options.build.resolve() / "python"), os.environ.get("PYTHONPATH", "")]
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))}
    bench = json.loads(subprocess.run([sys.executable, ROOT / "tests/bench/python_bench.py", "--json"], env=env,
                                      check=True, stdout=subprocess.PIPE).stdout)
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "peers.json"
        subprocess.run([sys.executable, ROOT / "docs/measurements/peers.py", options.build.resolve() / "voxtact", "--poses",
                        str(options.poses), "--output", output], env=env, check=True)
        peers = json.loads(output.read_text())
    text = replaced(PAGE.read_text(), "bench", bench_table(bench))
    PAGE.write_text(replaced(text, "peers", peers_table(peers)))
    print(f"{PAGE} has both tables of {peers['date']}, {peers['machine']['cpu']}, {peers['machine']['processors']} processors")


if __name__ == "__main__":
    main()
