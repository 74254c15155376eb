# SPDX-License-Identifier: MIT
# %% [markdown]
# # Many processes, with Dask
#
# A million poses over the workers of a Dask cluster: here two processes of this machine, elsewhere the one whose
# scheduler you name. A task has 100,000 poses. A smaller one would cost more to send than to answer.
#
# `dask_poses.py 20000` takes fewer poses, `dask_poses.py tcp://scheduler:8786` another cluster. Debian has Dask as
# python3-dask and python3-distributed.

# %%
import functools
import sys
import time

import numpy as np
from dask.distributed import Client, LocalCluster

import voxtact as vx

PER_TASK = 100_000


# %% [markdown]
# Scenes cannot be sent. Each worker makes its own, once, and keeps it; on one thread, since there are as many workers as
# processors. A task has the number of its first pose and makes the poses itself; poses of a file would be read there:
# what is sent is small.

# %%
@functools.lru_cache(maxsize=1)
def scene_and_mesh():
    return vx.Scene("builtin:head:128", opacity=[(40, 0), (80, 1)], threads=1), vx.read_mesh("builtin:scalpel:3068")


def poses_of(first, number):
    """At random places, turned about z; the same ones whoever asks."""
    places = np.random.default_rng(1)
    places.bit_generator.advance(4 * first)
    numbers = places.random((number, 4))
    angle = 2 * np.pi * numbers[:, 3]
    poses = np.tile(np.eye(4), (number, 1, 1))
    poses[:, 0, 0] = poses[:, 1, 1] = np.cos(angle)
    poses[:, 1, 0], poses[:, 0, 1] = np.sin(angle), -np.sin(angle)
    poses[:, :3, 3] = 240 * numbers[:, :3] - 120
    return poses


def answer(first, number):
    """One byte per pose: 1, it touches; 2, rounding leaves it open; 0."""
    scene, mesh = scene_and_mesh()
    found = scene.touch(mesh, poses_of(first, number))
    return np.where(found.undecided, 2, found.touches).astype(np.uint8)


# %%
def main(words):
    number = next((int(word) for word in words if word.isdigit()), 1_000_000)
    address = next((word for word in words if "://" in word), None)
    # A short run has two tasks nevertheless.
    size = min(PER_TASK, -(-number // 2))
    cluster = address or LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with Client(cluster) as client:
        begin = time.perf_counter()
        tasks = [client.submit(answer, first, min(size, number - first)) for first in range(0, number, size)]
        parts = client.gather(tasks)
        seconds = time.perf_counter() - begin
        workers = len(client.scheduler_info()["workers"])
    if address is None:
        cluster.close()
    together = np.concatenate(parts)
    print(f"{number} poses in {len(tasks)} tasks by {workers} workers, {seconds:.1f} s: {int((together == 1).sum())} touch")
    # Byte for byte what one process says, of a few tasks at least.
    alone = answer(0, min(number, 2 * size))
    assert together[: len(alone)].tobytes() == alone.tobytes()


# Workers are new processes, which read this file too.
if __name__ == "__main__":
    main(sys.argv[1:])
