# SPDX-License-Identifier: MIT
"""What the tests of the Python package share. ctest gives VOXTACT_PROGRAM and PYTHONPATH."""
import csv
import os
import pathlib
import subprocess

import numpy as np
import pytest

import voxtact as vx

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ["VOXTACT_PROGRAM"]


def program(*arguments, cwd):
    """Runs the program; its rows, where it prints a table."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return list(csv.DictReader(done.stdout.splitlines()))


def placed(*points):
    """Poses that move to points."""
    poses = np.tile(np.eye(4), (len(points), 1, 1))
    poses[:, :3, 3] = points
    return poses


def random_poses(number, seed, reach=90.0):
    """Rotated anyhow, and moved within a cube."""
    generator = np.random.default_rng(seed)
    poses = np.tile(np.eye(4), (number, 1, 1))
    for pose in poses:
        turn, _ = np.linalg.qr(generator.normal(size=(3, 3)))
        pose[:3, :3] = turn * np.sign(np.linalg.det(turn))
        pose[:3, 3] = generator.uniform(-reach, reach, 3)
    return poses


def cube(size=2.0):
    """A closed cube around the origin."""
    corners = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], dtype=np.float32) * size / 2
    faces = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2],
             [2, 4, 6], [1, 3, 5], [3, 7, 5]]
    return vx.read_mesh((corners, np.array(faces)), space="lps")


def half_space(dtype=np.uint8, shape=(8, 10, 12), value=200):
    """`value` where x is at most 5, else 0; voxels of 1 mm, the first at the origin."""
    voxels = np.zeros(shape, dtype=dtype)
    voxels[:, :, :6] = value
    return voxels


#: Of a grid that is oblique and flipped.
TURN = np.array([[0.96, -0.28, 0], [0.28, 0.96, 0], [0, 0, -1]])


def oblique(spacing=(0.7, 1.1, 2.3), origin=(-20.0, 11.0, 5.0)):
    """An affine: anisotropic, turned and flipped."""
    affine = np.eye(4)
    affine[:3, :3] = TURN * np.array(spacing)
    affine[:3, 3] = origin
    return affine


def noise(dtype=np.int16, shape=(14, 18, 22), seed=2):
    """Voxels from 0 to 199."""
    return np.random.default_rng(seed).integers(0, 200, shape).astype(dtype)


def answers(volume):
    """Counts that tell one volume from another."""
    scene = vx.Scene(volume, opacity=[(90, 0), (110, 1)])
    return scene.count(cube(5), random_poses(80, 21, reach=25)).count


@pytest.fixture(scope="session")
def head():
    return vx.read_volume("builtin:head:30")


@pytest.fixture(scope="session")
def knife():
    return vx.read_mesh("builtin:scalpel:300")


@pytest.fixture
def scene(head):
    return vx.Scene(head, opacity=[(40, 0), (80, 1)])


@pytest.fixture(scope="session")
def device():
    """A Vulkan device; without one the test fails, unless VOXTACT_REQUIRE_DEVICE is off."""
    try:
        return vx.Device()
    except vx.UnsupportedError as error:
        if os.environ.get("VOXTACT_REQUIRE_DEVICE", "1") in ("0", "OFF"):
            pytest.skip(str(error))
        raise
