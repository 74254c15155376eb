#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Overlap against VTK's boolean filters: the volume of an isosurface intersected with the mesh, in one run.

usage: overlap_vtk.py [--poses FILE] [--number N] [--limit SECONDS] VOLUME MESH VALUE

Values >= VALUE are opaque. Choose a VALUE that no voxel has: else triangles of the isosurface are degenerate, and the
boolean filters fail more often. The poses are the first N of FILE; without FILE, N random poses with the mesh inside the
image and an overlap > 0.

Per pose, VTK contours the part of the image in the mesh's box (vtkFlyingEdges3D), intersects the surface with the mesh
(each filter of FILTERS) and measures the result (vtkMassProperties). Each filter runs in a child process with a limit
of CPU time. The bounds are voxtact's, to 1 mm^3. Times are CPU time; both sides use one thread.
"""
import argparse
import multiprocessing
import resource
import signal
import time

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

import voxtact as vx

FILTERS = ("vtkLoopBooleanPolyDataFilter", "vtkBooleanOperationPolyDataFilter")
SEED = 1
MARGIN = 2  # voxels around the mesh's box
# Filters do not merge the points of their pieces. Without the merge, each piece would count as open.
MERGED_MM = 1e-4
WRONG = 0.05  # share of the bound: a larger error is a failure
WAIT = 10  # times the limit: a child that waits does not use its CPU time
FORK = multiprocessing.get_context("fork")


def poly_data(points, triangles):
    cells = vtk.vtkCellArray()
    rows = np.insert(np.asarray(triangles, dtype=np.int64), 0, 3, axis=1)
    cells.SetCells(len(rows), numpy_to_vtkIdTypeArray(rows.ravel(), deep=True))
    corners = vtk.vtkPoints()
    corners.SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=float), deep=True))
    out = vtk.vtkPolyData()
    out.SetPoints(corners)
    out.SetPolys(cells)
    return out


def surface_in_box(volume, value, vertices):
    """The closed isosurface in the box of `vertices`, in LPS mm, outwards."""
    lps = vx.LPS_FROM_RAS @ volume.affine
    index = (vertices - lps[:3, 3]) @ np.linalg.inv(lps[:3, :3]).T
    lo = np.maximum(np.floor(index.min(axis=0)).astype(int) - MARGIN, 0)
    hi = np.maximum(np.ceil(index.max(axis=0)).astype(int) + MARGIN + 1, lo)
    part = np.asarray(volume.array[lo[2]:hi[2], lo[1]:hi[1], lo[0]:hi[0]], dtype=np.float32)
    array = np.pad(part, 1, constant_values=value - 1000)  # closes the surface where the image is cut
    image = vtk.vtkImageData()
    image.SetDimensions(*array.shape[::-1])
    image.GetPointData().SetScalars(numpy_to_vtk(array.reshape(-1), deep=True))
    edges = vtk.vtkFlyingEdges3D()
    edges.SetInputData(image)
    edges.SetValue(0, value)
    edges.ComputeNormalsOff()
    edges.ComputeGradientsOff()
    edges.Update()
    found = edges.GetOutput()
    if found.GetNumberOfCells() == 0:
        return poly_data(np.zeros((0, 3)), np.zeros((0, 3)))
    points = vtk_to_numpy(found.GetPoints().GetData()).astype(float) + lo - 1
    triangles = vtk_to_numpy(found.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    if np.linalg.det(lps) < 0:
        triangles = triangles[:, ::-1]
    return poly_data(points @ lps[:3, :3].T + lps[:3, 3], triangles)


def count_edges(data, kind):
    edges = vtk.vtkFeatureEdges()
    edges.SetInputData(data)
    for other in ("Boundary", "NonManifold", "Feature", "Manifold"):
        getattr(edges, f"Set{other}Edges")(other == kind)
    edges.Update()
    return edges.GetOutput().GetNumberOfCells()


def intersect(volume, value, mesh, pose, name):
    """The volume of the intersection and how it was found."""
    vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_OFF)
    messages = vtk.vtkStringOutputWindow()  # counts the errors of the filters inside a filter, too
    vtk.vtkOutputWindow.SetInstance(messages)
    begin = time.process_time()
    vertices = np.asarray(mesh.vertices, dtype=float) @ pose[:3, :3].T + pose[:3, 3]
    surface = surface_in_box(volume, value, vertices)
    boolean = getattr(vtk, name)()
    boolean.SetOperationToIntersection()
    if name == "vtkLoopBooleanPolyDataFilter":
        boolean.SetNoIntersectionOutput(0)  # nothing; the default is the whole isosurface
    boolean.SetInputData(0, surface)
    boolean.SetInputData(1, poly_data(vertices, mesh.faces))
    boolean.Update()
    result = boolean.GetOutput()
    mm3 = 0.0
    if result.GetNumberOfCells() > 0:
        mass = vtk.vtkMassProperties()
        mass.SetInputData(result)
        mass.Update()
        mm3 = mass.GetVolume()
    seconds = time.process_time() - begin
    merge = vtk.vtkCleanPolyData()
    merge.SetInputData(result)
    merge.ToleranceIsAbsoluteOn()
    merge.SetAbsoluteTolerance(MERGED_MM)
    merge.Update()
    return {"mm3": mm3, "seconds": seconds, "surface": surface.GetNumberOfCells(), "cells": result.GetNumberOfCells(),
            "errors": messages.GetOutput().count("ERROR:"), "open": count_edges(merge.GetOutput(), "Boundary"),
            "crossed": count_edges(merge.GetOutput(), "NonManifold")}


def in_child(limit, work, *arguments):
    """What `work` returns in a child process; or {"failed": REASON}. `limit`: whole seconds of CPU time."""
    here, there = FORK.Pipe(duplex=False)

    def answer():
        here.close()
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 1))
        try:
            there.send(work(*arguments))
        except Exception as error:  # pylint: disable=broad-except
            there.send({"failed": "exception", "text": repr(error)})

    child = FORK.Process(target=answer)
    child.start()
    there.close()
    try:
        found = here.recv() if here.poll(WAIT * limit) else {"failed": "time limit"}
    except EOFError:
        child.join()
        found = {"failed": "time limit" if child.exitcode == -signal.SIGXCPU else "crash"}
    child.kill()
    child.join()
    return found


def random_pose(volume, mesh, random):
    """A random rotation, and the middle of the mesh's box at a random point of the image."""
    pose = np.eye(4)
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    pose[:3, :3] = turn * np.sign(np.linalg.det(turn))
    lps = vx.LPS_FROM_RAS @ volume.affine
    at = lps @ np.append(random.uniform(0, 1, 3) * (np.array(volume.array.shape[::-1]) - 1), 1)
    vertices = np.asarray(mesh.vertices, dtype=float)
    pose[:3, 3] = at[:3] - turn * np.sign(np.linalg.det(turn)) @ (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    index = (vertices @ pose[:3, :3].T + pose[:3, 3] - lps[:3, 3]) @ np.linalg.inv(lps[:3, :3]).T
    return pose, bool((index >= 0).all() and (index <= np.array(volume.array.shape[::-1]) - 1).all())


def random_poses(scene, volume, mesh, number):
    random = np.random.default_rng(SEED)
    poses = []
    for _ in range(1000 * number):
        pose, is_inside = random_pose(volume, mesh, random)
        if is_inside and scene.overlap(mesh, pose).lower[0] > 0:
            poses.append(pose)
            if len(poses) == number:
                return np.array(poses)
    raise SystemExit("overlap_vtk: too few poses have the mesh inside the image and an overlap > 0")


def report(name, results, lo, hi, whole, limit):
    number = len(results)
    done = np.array(["failed" not in result for result in results])

    def column(key):
        return np.array([result[key] for result in results if "failed" not in result])

    reasons = [result["failed"] for result in results if "failed" in result]
    seconds = np.array([result.get("seconds", limit) for result in results])
    print(f"{name}: {number / seconds.sum():.3g} poses per CPU second; {np.median(seconds):.3g} s in the median, at most "
          f"{seconds.max():.3g} s")
    print("  failures: " + ", ".join(f"{reasons.count(reason)} {reason}" for reason in ("exception", "crash", "time limit")) +
          f" ({limit:g} s)")
    if not done.any():
        return
    lo, hi, found, empty = lo[done], hi[done], column("mm3"), column("cells") == 0
    error = np.where(found > hi, found - hi, np.where(found < lo, found - lo, 0.0))
    wrong = (found < (1 - WRONG) * lo) | (found > (1 + WRONG) * hi)
    print(f"  of {len(found)} results: {(column('errors') > 0).sum()} with errors of VTK, {(empty & (lo > 0)).sum()} empty "
          f"where the overlap is > 0, {(column('open') > 0).sum()} open, {(column('crossed') > 0).sum()} non-manifold, "
          f"{wrong.sum()} wrong by more than {100 * WRONG:g} %")
    print(f"  edges with one triangle {np.median(column('open')):g} in the median, edges with more than two "
          f"{np.median(column('crossed')):g}; isosurface in the box {np.median(column('surface')):g} triangles")
    share = 100 * error / whole
    print(f"  outside the bounds by {np.median(np.abs(share)):.3g} % of the mesh in the median, {share.min():+.3g} to "
          f"{share.max():+.3g} %; outside for {(error != 0).sum()}, too small for {(error < 0).sum()}")
    if wrong.any():
        print("  wrong (pose, mm^3, bounds): " + "; ".join(
            f"{np.flatnonzero(done)[i]}, {found[i]:.4g}, {lo[i]:.4g} to {hi[i]:.4g}" for i in np.flatnonzero(wrong)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("volume")
    parser.add_argument("mesh")
    parser.add_argument("value", type=float)
    parser.add_argument("--poses")
    parser.add_argument("--number", type=int, default=10)
    parser.add_argument("--limit", type=int, default=300, help="seconds of CPU time per pose and filter; default: 300")
    wish = parser.parse_args()
    volume, mesh = vx.read_volume(wish.volume), vx.read_mesh(wish.mesh)
    scene = vx.Scene(volume, opacity=[(wish.value, 0), (wish.value, 1)], threads=1)
    if wish.poses:
        poses = np.loadtxt(wish.poses).reshape(-1, 4, 4)[:wish.number]
    else:
        poses = random_poses(scene, volume, mesh, wish.number)
        scene = vx.Scene(volume, opacity=[(wish.value, 0), (wish.value, 1)], threads=1)
    times = []
    for _ in range(2):
        begin = time.process_time()
        truth = scene.overlap(mesh, poses)
        times.append(time.process_time() - begin)
    whole = truth.solid_upper[0]
    print(f"{wish.volume}, opaque from {wish.value:g} on; {wish.mesh}, {len(mesh.faces)} triangles, {whole:.4g} mm^3; "
          f"{len(poses)} poses, overlap {truth.lower.min():.4g} to {truth.upper.max():.4g} mm^3")
    print(f"voxtact: {len(poses) / times[0]:.3g} poses per CPU second in a new scene, then {len(poses) / times[1]:.3g}; bounds "
          f"at most {np.max(truth.upper - truth.lower):.3g} mm^3 apart")
    print(f"VTK {vtk.vtkVersion.GetVTKVersion()}, isosurface of the mesh's box in each pose:")
    for name in FILTERS:
        results = [in_child(wish.limit, intersect, volume, wish.value, mesh, pose, name) for pose in poses]
        report(name, results, truth.lower, truth.upper, whole, wish.limit)


if __name__ == "__main__":
    main()
