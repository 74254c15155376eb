#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Distance against VTK's distance to a marching-cubes surface, looked up at the mesh's vertices, in one run.

usage: distance_vtk.py [VOLUME [MESH [POSES]]]

Without a file of a volume the built-in head. What is opaque begins at value 44 (opacity 40:0,80:1); the surface is that of
vtkFlyingEdges3D there, the distance vtkImplicitPolyDataDistance's, negative inside. Poses are drawn until POSES
(100) touch nothing and are at most 50 mm away. One thread. The bounds are voxtact's, to 0.01 mm.
"""
import sys
import time

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

import voxtact as vx

# Not 44, which is opaque nevertheless: where voxels have the surface's very value its triangles are degenerate, and the
# sign of a distance to them is anybody's guess (inside for 63 of 100 poses that touch nothing).
VALUE = 43.99
SEED = 1


def surface_of(volume):
    """The surface in LPS mm, and the seconds that it took, with its locator."""
    # [z, y, x]; a voxel of air around it closes the surface where the image is cut, or it has no inside.
    array = np.pad(np.asarray(volume.array, dtype=np.float32), 1)
    image = vtk.vtkImageData()
    image.SetDimensions(*array.shape[::-1])
    image.GetPointData().SetScalars(numpy_to_vtk(array.reshape(-1), deep=True))
    begin = time.perf_counter()
    edges = vtk.vtkFlyingEdges3D()
    edges.SetInputData(image)
    edges.SetValue(0, VALUE)
    edges.ComputeNormalsOff()
    edges.ComputeGradientsOff()
    edges.Update()
    lps = vx.LPS_FROM_RAS @ volume.affine
    sense = vtk.vtkReverseSense()  # outwards, where the axes mirror
    sense.SetInputConnection(edges.GetOutputPort())
    sense.SetReverseCells(bool(np.linalg.det(lps) < 0))
    sense.Update()
    surface = vtk.vtkPolyData()
    surface.DeepCopy(sense.GetOutput())
    index = vtk_to_numpy(surface.GetPoints().GetData()) - 1
    world = index @ lps[:3, :3].T + lps[:3, 3]
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(world.astype(np.float32), deep=True))
    surface.SetPoints(points)
    distance = vtk.vtkImplicitPolyDataDistance()
    distance.SetInput(surface)
    distance.FunctionValue(*world[0])  # builds its locator
    return surface, distance, time.perf_counter() - begin


def drawn_poses(volume, mesh, number, random):
    """A random turn, and a random vertex of the mesh at a random point of the image's box."""
    lps = vx.LPS_FROM_RAS @ volume.affine
    size = np.array(volume.array.shape[::-1])
    out = np.tile(np.eye(4), (number, 1, 1))
    for pose in out:
        q = random.normal(size=4)
        w, x, y, z = q / np.linalg.norm(q)
        pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
        place = lps @ np.append(random.uniform(-0.1, 1.1, 3) * size, 1)
        vertex = mesh.vertices[random.integers(len(mesh.vertices))]
        pose[:3, 3] = place[:3] - pose[:3, :3] @ vertex
    return out


def near_poses(scene, volume, mesh, number):
    random = np.random.default_rng(SEED)
    poses, lo, hi = [], [], []
    while len(poses) < number:
        drawn = drawn_poses(volume, mesh, 4 * number, random)
        found = scene.distance(mesh, drawn, max=50)
        free = np.isfinite(found.upper) & (found.lower > 0)
        if not free.any():
            sys.exit("distance_vtk: no pose is near without touching")
        poses.extend(drawn[free])
        lo.extend(found.lower[free])
        hi.extend(found.upper[free])
    return np.array(poses[:number]), np.array(lo[:number]), np.array(hi[:number])


def main():
    name = sys.argv[1] if len(sys.argv) > 1 else "builtin:head:128"
    mesh = vx.read_mesh(sys.argv[2] if len(sys.argv) > 2 else "builtin:scalpel")
    number = int(sys.argv[3]) if len(sys.argv) > 3 else 100
    volume = vx.read_volume(name)
    scene = vx.Scene(volume, opacity=[(40, 0), (80, 1)], threads=1)
    poses, lo, hi = near_poses(scene, volume, mesh, number)
    begin = time.perf_counter()
    scene.distance(mesh, poses)
    own = time.perf_counter() - begin

    surface, distance, build = surface_of(volume)
    values = vtk.vtkDoubleArray()
    found, inside = [], 0
    begin = time.perf_counter()
    for pose in poses:
        vertices = np.asarray(mesh.vertices, dtype=float) @ pose[:3, :3].T + pose[:3, 3]
        distance.FunctionValue(numpy_to_vtk(vertices, deep=True), values)
        signed = vtk_to_numpy(values)
        inside += signed.min() < 0
        found.append(np.abs(signed).min())
    theirs = time.perf_counter() - begin

    found = np.array(found)
    print(f"{name}, {len(mesh.faces)} triangles, seed {SEED}: {number} poses that do not touch, up to 50 mm away")
    print(f"voxtact: {number / own:.4g} per second")
    print(f"VTK {vtk.vtkVersion.GetVTKVersion()}: {surface.GetNumberOfCells()} triangles and their locator in "
          f"{1000 * build:.4g} ms; {number / theirs:.4g} per second")
    error = np.where(found > hi, found - hi, np.where(found < lo, found - lo, 0.0))
    print(f"off by {np.median(np.abs(error)):.3g} mm in the median, {error.min():+.3g} to {error.max():+.3g}; too large for "
          f"{100 * np.mean(error > 0):.3g} %, by more than 0.5 mm for {100 * np.mean(error > 0.5):.3g} %; the sign "
          f"says inside for {inside}, where nothing touches")


if __name__ == "__main__":
    main()
