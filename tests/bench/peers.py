#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Asks voxtact and its peers the same question: does this mesh, at this pose, touch the opaque part of this volume?

The truth is voxtact's certified answer (`voxtact touch`). A pose for which that is only
*possible* is left out. The peers are what people do with a volume when they need an answer for a mesh:

  vtk        an isosurface of the opaque part (vtkFlyingEdges3D) against the mesh (vtkCollisionDetectionFilter, first
             contact); a mesh that is wholly inside the surface cuts it nowhere, so one vertex is looked up as well
  distance   a signed Euclidean distance transform of the opaque voxels (scipy), sampled trilinearly at the vertices of
             the mesh; or, for comparison, at points of its triangles that are half a voxel apart
  vertices   the image itself, sampled trilinearly at the same points: no distance, but nothing to make beforehand
  open3d     the isosurface of `vtk` against the mesh (TriangleMesh.is_intersecting, every triangle against every other of
             the surface cropped to the mesh's box), and one vertex looked up; where there is open3d, for a few poses
  python     voxtact again, through `import voxtact`, all poses in one call; where PYTHONPATH has it
  view, fcl  as `voxtact bench --certified` has them: the paper's view of 512x512 pixels by the host, and FCL, the mesh
             against an octree of the opaque voxels

Poses are at large (`voxtact make poses`), or around the onset of contact: a random pose that touches is moved in a
random direction until it no longer does, found by bisection with the certified answer, and from there by a random
length from 0.75 voxels back to 0.25 voxels on. Rates are pairs per second of CPU time on one thread, all in one run.

open3d's RaycastingScene, which is made for such questions, is not among them: that of Debian 12 (0.16.1) finds no hit,
not even of a ray through a triangle, by cast_rays, count_intersections and test_occlusions alike; so its signed distances
are positive inside, too, and its occupancies 0. Its unsigned distances are right, and say nothing of a mesh that is inside.

Needs the packages of third_party/packages-peers.txt. Usage:
  peers.py VOXTACT [--poses N] [--output FILE]
"""
import argparse
import datetime
import json
import os
import pathlib
import platform
import subprocess
import tempfile
import time

import nibabel
import numpy
import scipy
import scipy.ndimage
import vtk
from vtk.util import numpy_support

VOLUME = "/usr/share/mricron/templates/ch2.nii.gz"
MESH = "builtin:scalpel:3068"
OPACITY = [(40.0, 0.0), (80.0, 1.0)]
THRESHOLD = 0.1
SEED = 1
INSIDE_MM, OUTSIDE_MM = 0.75, 0.25  # the volume's voxels are 1 mm


def isovalue():
    """The value at which the opacity reaches the threshold."""
    (low, _), (high, _) = OPACITY
    return low + THRESHOLD * (high - low)


class Voxtact:
    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        self.opacity = ",".join(f"{value:g}:{alpha:g}" for value, alpha in OPACITY)
        self.mesh = self.folder / "mesh.stl"
        self.run("make", "mesh", MESH, self.mesh)

    def run(self, *arguments, environment=None):
        command = [self.program, *map(str, arguments)]
        return subprocess.run(command, check=True, capture_output=True, text=True, env=environment).stdout

    def random_poses(self, number, seed):
        path = self.folder / "random.txt"
        self.run("make", "poses", "--volume", VOLUME, "--mesh", self.mesh, "--number", number, "--seed", seed,
                 "--output", path)
        return numpy.loadtxt(path).reshape(-1, 4, 4)

    def hits(self, poses):
        """0: certainly none; 1: certainly a contact; 2: undecided."""
        path = self.folder / "poses.txt"
        numpy.savetxt(path, poses.reshape(-1, 16), fmt="%.17g")
        answer = self.run("touch", "--volume", VOLUME, "--mesh", self.mesh, "--opacity", self.opacity, "--opacity-threshold",
                          THRESHOLD, "--poses", path, "--format", "json")
        return numpy.array([("no", "yes", "undecided").index(row["touch"]) for row in json.loads(answer)["rows"]])

    def bench(self, number):
        """Certified, view and FCL by CPU time; the host alone, so that no driver's threads are in it."""
        answer = self.run("bench", "--certified", "--volume", VOLUME, "--mesh", MESH, "--opacity", self.opacity,
                          "--number", number, "--repetitions", 5, "--seed", SEED, "--format", "json", "--progress",
                          "never", environment={**os.environ, "VK_DRIVER_FILES": "/nonexistent"})
        return json.loads(answer)


def onset_poses(voxtact, number):
    generator = numpy.random.default_rng(SEED)
    poses = voxtact.random_poses(4 * number, SEED + 1)
    poses = poses[voxtact.hits(poses) == 1][:number]
    directions = generator.normal(size=(len(poses), 3))
    directions /= numpy.linalg.norm(directions, axis=1, keepdims=True)

    def moved(lengths):
        out = poses.copy()
        out[:, :3, 3] += lengths[:, None] * directions
        return out

    inside, outside = numpy.zeros(len(poses)), numpy.full(len(poses), 1000.0)
    for _ in range(36):
        middle = (inside + outside) / 2
        touches = voxtact.hits(moved(middle)) != 0
        inside, outside = numpy.where(touches, middle, inside), numpy.where(touches, outside, middle)
    return moved(outside + generator.uniform(-INSIDE_MM, OUTSIDE_MM, len(poses)))


class Scene:
    """The volume in LPS, the mesh, and what peers read of both."""

    def __init__(self, stl):
        image = nibabel.load(VOLUME)
        self.voxels = numpy.asanyarray(image.dataobj).astype(numpy.float32)
        self.world_from_index = numpy.diag([-1.0, -1.0, 1.0, 1.0]) @ image.affine
        self.index_from_world = numpy.linalg.inv(self.world_from_index)
        reader = vtk.vtkSTLReader()
        reader.SetFileName(str(stl))
        reader.Update()
        self.mesh = reader.GetOutput()
        self.vertices = numpy_support.vtk_to_numpy(self.mesh.GetPoints().GetData()).astype(float)
        self.triangles = numpy_support.vtk_to_numpy(self.mesh.GetPolys().GetData()).reshape(-1, 4)[:, 1:]

    def surface_points(self, apart):
        """Points of every triangle that are at most so many mm apart, corners included."""
        found = []
        for a, b, c in self.vertices[self.triangles]:
            steps = int(numpy.ceil(max(numpy.linalg.norm(p - q) for p, q in ((a, b), (b, c), (c, a))) / apart))
            for i in range(steps + 1):
                j = numpy.arange(steps + 1 - i)
                found.append(a + (b - a) * (i / steps) + (c - a) * (j[:, None] / steps))
        return numpy.unique(numpy.concatenate(found), axis=0)

    def sample(self, field, points, outside):
        """Trilinear at world points, as voxtact has it: half a voxel round the outermost centres belongs to the image,
        with the values of those centres; `outside` beyond."""
        index = self.index_from_world[:3, :3] @ points.T + self.index_from_world[:3, 3:]
        values = scipy.ndimage.map_coordinates(field, index, order=1, mode="nearest")
        size = numpy.array(field.shape)[:, None]
        return numpy.where(((index >= -0.5) & (index <= size - 0.5)).all(axis=0), values, outside)


def polygons(points, triangles):
    """Arrays as VTK has them."""
    corners = vtk.vtkPoints()
    corners.SetData(numpy_support.numpy_to_vtk(points, deep=True))
    cells = vtk.vtkCellArray()
    rows = numpy.column_stack([numpy.full(len(triangles), 3), triangles]).astype(numpy.int64)
    cells.SetCells(len(triangles), numpy_support.numpy_to_vtkIdTypeArray(rows.ravel(), deep=True))
    out = vtk.vtkPolyData()
    out.SetPoints(corners)
    out.SetPolys(cells)
    return out


def placed(pose, points):
    return points @ pose[:3, :3].T + pose[:3, 3]


class Distance:
    """Negative inside. Up to half a voxel off: the transform knows voxels, and no interpolant between them."""

    def __init__(self, scene, points):
        self.scene, self.points = scene, points
        begin = time.process_time()
        opaque = scene.voxels >= isovalue()
        spacing = numpy.linalg.norm(scene.world_from_index[:3, :3], axis=0)
        self.field = (scipy.ndimage.distance_transform_edt(~opaque, sampling=spacing) -
                      scipy.ndimage.distance_transform_edt(opaque, sampling=spacing)).astype(numpy.float32)
        self.setup_s = time.process_time() - begin

    def hit(self, pose):
        return self.scene.sample(self.field, placed(pose, self.points), 1000.0).min() <= 0


class Vertices:
    """No set-up at all: the image itself, where the points are."""

    def __init__(self, scene, points):
        self.scene, self.points, self.setup_s = scene, points, 0.0

    def hit(self, pose):
        return self.scene.sample(self.scene.voxels, placed(pose, self.points), 0.0).max() >= isovalue()


class Vtk:
    def __init__(self, scene):
        self.scene = scene
        begin = time.process_time()
        # The outermost values go on for half a voxel, and there the surface is closed: what lies beyond is moved onto
        # the box, and the triangles that this flattens are left out.
        padded = numpy.pad(numpy.pad(scene.voxels, 1, mode="edge"), 1)
        image = vtk.vtkImageData()
        image.SetDimensions(padded.shape)
        image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(padded.ravel(order="F"), deep=True))
        contour = vtk.vtkFlyingEdges3D()
        contour.SetInputData(image)
        contour.SetValue(0, isovalue())
        contour.ComputeNormalsOff()
        contour.ComputeGradientsOff()
        contour.ComputeScalarsOff()
        contour.Update()
        points = numpy_support.vtk_to_numpy(contour.GetOutput().GetPoints().GetData()).astype(float) - 2
        points = numpy.clip(points, -0.5, numpy.array(scene.voxels.shape) - 0.5)
        triangles = numpy_support.vtk_to_numpy(contour.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 3)
        a, b, c = (points[triangles[:, corner]] for corner in range(3))
        triangles = triangles[numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1) > 1e-12]
        self.surface = placed(scene.world_from_index, points), triangles
        surface = polygons(*self.surface)
        self.triangles = len(triangles)
        self.pose = vtk.vtkMatrix4x4()
        self.collide = vtk.vtkCollisionDetectionFilter()
        self.collide.SetInputData(0, scene.mesh)
        self.collide.SetInputData(1, surface)
        self.collide.SetMatrix(0, self.pose)
        self.collide.SetMatrix(1, vtk.vtkMatrix4x4())
        self.collide.SetCollisionModeToFirstContact()
        self.collide.GenerateScalarsOff()
        self.cuts(numpy.eye(4))  # builds both trees
        self.setup_s = time.process_time() - begin
        self.cuts(numpy.eye(4))  # VTK 9.1 builds them again; that is not held against it

    def cuts(self, pose):
        self.pose.DeepCopy(pose.ravel())
        self.collide.Modified()
        self.collide.Update()
        return self.collide.GetNumberOfContacts() > 0

    def hit(self, pose):
        corner = placed(pose, self.scene.vertices[:1])
        return self.cuts(pose) or self.scene.sample(self.scene.voxels, corner, 0.0)[0] >= isovalue()


class Open3d:
    """Triangles against triangles. What it does not say, whether the mesh is inside, is looked up as for VTK."""

    most = 40  # poses of each kind: it takes seconds for one

    def __init__(self, scene, surface):
        import open3d

        self.scene, self.library = scene, open3d
        begin = time.process_time()
        self.surface = self.mesh(*surface)
        self.setup_s = time.process_time() - begin

    def mesh(self, points, triangles):
        utility = self.library.utility
        return self.library.geometry.TriangleMesh(utility.Vector3dVector(points), utility.Vector3iVector(triangles))

    def hit(self, pose):
        mesh = self.mesh(placed(pose, self.scene.vertices), self.scene.triangles)
        box = mesh.get_axis_aligned_bounding_box()
        # It keeps triangles all of whose vertices are in the box, and those of the surface are smaller than two voxels.
        near = self.surface.crop(self.library.geometry.AxisAlignedBoundingBox(box.min_bound - 2, box.max_bound + 2))
        corner = placed(pose, self.scene.vertices[:1])
        return mesh.is_intersecting(near) or self.scene.sample(self.scene.voxels, corner, 0.0)[0] >= isovalue()


class Python:
    """The certified answer by `import voxtact`."""

    def __init__(self, stl):
        import voxtact

        begin = time.process_time()
        self.scene = voxtact.Scene(VOLUME, OPACITY, THRESHOLD, threads=1)
        self.mesh = voxtact.read_mesh(stl)
        self.hits(numpy.eye(4))  # looks which bricks are opaque, as after every edit
        self.setup_s = time.process_time() - begin

    def hits(self, poses):
        return self.scene.touch(self.mesh, poses).touches


def ask(engine, poses, truth):
    if hasattr(engine, "hits"):  # milliseconds: as `voxtact bench` has it, the median of five
        times = []
        for _ in range(5):
            begin = time.process_time()
            answers = engine.hits(poses)
            times.append(time.process_time() - begin)
        return judged(answers, poses, truth, float(numpy.median(times)))
    most = getattr(engine, "most", len(poses))
    poses, truth = poses[:most], truth[:most]
    begin = time.process_time()
    answers = numpy.array([bool(engine.hit(pose)) for pose in poses])
    return judged(answers, poses, truth, time.process_time() - begin)


def judged(answers, poses, truth, seconds):
    contacts, misses = truth == 1, truth == 0
    return {"contacts": int(contacts.sum()), "no_contacts": int(misses.sum()),
            "missed": int((contacts & ~answers).sum()), "false": int((misses & answers).sum()),
            "missed_percent": round(100 * float((contacts & ~answers).sum()) / max(1, int(contacts.sum())), 2),
            "false_percent": round(100 * float((misses & answers).sum()) / max(1, int(misses.sum())), 2),
            "pairs_per_cpu_s": round(len(poses) / seconds, 2)}


BENCH_ENGINES = {("cpu", "certified", "yes/no", 1): "certified",
                 ("cpu", "view", "count", None): "view",
                 ("fcl-float", "octree", "yes/no", 1): "fcl"}


def bench_rows(bench):
    for row in bench["rows"]:
        for (engine, projection, question, threads), name in BENCH_ENGINES.items():
            if (row["engine"], row["projection"], row["question"]) == (engine, projection, question) and \
                    threads in (None, row["threads"]):
                yield {"engine": name, "poses": row["poses"], "contacts": row["contacts"],
                       "no_contacts": row["pairs"] - row["contacts"],
                       **{key: row[key] for key in ("missed_percent", "false_percent", "pairs_per_cpu_s")}}


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("voxtact", help="the program")
    parser.add_argument("--poses", type=int, default=1000, help="of each kind")
    parser.add_argument("--output", type=pathlib.Path)
    options = parser.parse_args()

    rows = []
    with tempfile.TemporaryDirectory() as folder:
        voxtact = Voxtact(options.voxtact, folder)
        rows += bench_rows(voxtact.bench(options.poses))
        scene = Scene(voxtact.mesh)
        kinds = {"large": voxtact.random_poses(options.poses, SEED), "onset": onset_poses(voxtact, options.poses)}
        truth = {kind: voxtact.hits(poses) for kind, poses in kinds.items()}
        dense = scene.surface_points(0.5)
        engines = {"vtk": Vtk(scene), "distance": Distance(scene, scene.vertices),
                   "distance, dense": Distance(scene, dense), "vertices": Vertices(scene, scene.vertices),
                   "vertices, dense": Vertices(scene, dense)}
        try:
            engines["python"] = Python(voxtact.mesh)
        except ImportError:
            print("there is no voxtact in PYTHONPATH: no row for Python")
        try:
            engines["open3d"] = Open3d(scene, engines["vtk"].surface)
        except ImportError:
            print("there is no open3d: no row for it")
        for name, engine in engines.items():
            for kind, poses in kinds.items():
                rows.append({"engine": name, "poses": kind, **ask(engine, poses, truth[kind])})
        result = {
            "date": datetime.date.today().isoformat(),
            "machine": {"cpu": processor(), "processors": os.cpu_count(), "system": platform.platform()},
            "versions": {"voxtact": voxtact.run("--version").split("\n")[0], "vtk": vtk.vtkVersion().GetVTKVersion(),
                         "scipy": scipy.__version__, "numpy": numpy.__version__, "python": platform.python_version(),
                         **({"open3d": engines["open3d"].library.__version__} if "open3d" in engines else {})},
            "scene": {"volume": VOLUME, "mesh": MESH, "opacity": OPACITY, "threshold": THRESHOLD,
                      "vertices": len(scene.vertices), "triangles": len(scene.triangles),
                      "surface_triangles": engines["vtk"].triangles,
                      "dense_points": len(dense)},
            "open3d_poses": Open3d.most,
            "undecided": {kind: int((hits == 2).sum()) for kind, hits in truth.items()},
            "setup_cpu_s": {name: round(engine.setup_s, 2) for name, engine in engines.items()},
            "rows": rows,
        }
    text = json.dumps(result, indent=1) + "\n"
    if options.output:
        options.output.write_text(text)
    for row in rows:
        print(f'{row["engine"]:16} {row["poses"]:6} missed {row["missed_percent"]:6.2f} %  '
              f'false {row["false_percent"]:6.2f} %  {row["pairs_per_cpu_s"]:10.0f} pairs per CPU second')
    print("set-up after an edit, CPU seconds:", result["setup_cpu_s"])


if __name__ == "__main__":
    main()
