#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What `scene.touch` costs compared with the C++ call that it makes, in one run: one pose, and 100,000 poses.

usage: python_bench.py [POSES] [--json]

The C++ call is HostEngine::ask() of a touch. For one pose it is the call that Python makes, by its own clock
(BatchAnswer::wallMilliseconds): what is around it is what Python adds. For many, Python calls in pieces; so the engine is
also asked for all of them in one call, in turn with Python, both by the processor time of all threads, without the copy
of the poses that Python makes before. A line says how much more Python takes: the median, and the smallest and largest.
"""
import json
import statistics
import sys
import time

import numpy as np

import voxtact as vx


def poses_around(number, reach):
    generator = np.random.default_rng(1)
    poses = np.tile(np.eye(4), (number, 1, 1))
    poses[:, :3, 3] = generator.uniform(-reach, reach, (number, 3))
    return poses


def one_pose(scene, mesh, pose, times):
    """Seconds of the engine, and what Python adds to them."""
    engine, more = [], []
    for _ in range(times):
        begin = time.perf_counter()
        answer = scene.touch(mesh, pose)
        touches, undecided = answer.touches, answer.undecided
        seconds = time.perf_counter() - begin
        assert touches.shape == undecided.shape
        engine.append(answer.seconds)
        more.append(seconds - answer.seconds)
    return engine, more


def processor_seconds(ask):
    begin = time.process_time()
    ask()
    return time.process_time() - begin


def many_poses(scene, mesh, poses, rounds):
    """Processor seconds of the engine in one call, and of Python."""
    def engine_call(times):
        scene._core.engine_seconds(mesh._core, poses, times)

    def python_call():
        answer = scene.touch(mesh, poses)
        assert answer.touches.shape == answer.undecided.shape

    copy = min(processor_seconds(lambda: engine_call(0)) for _ in range(rounds))
    engine, python = [], []
    for _ in range(rounds):
        engine.append(processor_seconds(lambda: engine_call(1)) - copy)
        python.append(processor_seconds(python_call))
    return engine, python


def measure(number):
    """A dict for each number of threads and of poses, with the numbers of a line."""
    mesh = vx.read_mesh("builtin:scalpel")
    for threads in (1, 0):
        scene = vx.Scene("builtin:head:128", opacity=[(40, 0), (80, 1)], threads=threads)
        name = "one thread" if threads == 1 else "all threads"
        engine, more = one_pose(scene, mesh, poses_around(1, 0)[0], 5000)
        low, middle, high = np.percentile(np.array(more) * 1e6, [5, 50, 95])
        yield {"threads": name, "poses": 1, "engine_us": 1e6 * statistics.median(engine), "more_us": middle,
               "low_us": low, "high_us": high}
        engine, python = many_poses(scene, mesh, poses_around(number, 120), 15)
        more = [100 * (p / e - 1) for e, p in zip(engine, python)]
        yield {"threads": name, "poses": number, "engine_s": statistics.median(engine),
               "more_percent": statistics.median(more), "low_percent": min(more), "high_percent": max(more),
               "of_fastest_percent": 100 * (min(python) / min(engine) - 1)}


def line(row):
    if row["poses"] == 1:
        return (f"{row['threads']}, one pose: the engine {row['engine_us']:.1f} us, Python {row['more_us']:.1f} us more (90 % "
                f"are {row['low_us']:.1f} to {row['high_us']:.1f})")
    return (f"{row['threads']}, {row['poses']} poses: the engine {row['engine_s']:.3f} processor s, Python {row['more_percent']:.1f} % "
            f"more ({row['low_percent']:.1f} to {row['high_percent']:.1f}; of the fastest of each "
            f"{row['of_fastest_percent']:.1f})")


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--json"]
    rows = measure(int(arguments[0]) if arguments else 100_000)
    if "--json" in sys.argv:
        json.dump(list(rows), sys.stdout, indent=1)
        return
    for row in rows:
        print(line(row), flush=True)


if __name__ == "__main__":
    main()
