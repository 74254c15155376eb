# SPDX-License-Identifier: MIT
"""Meshes from arrays and from the objects of other libraries."""
import pickle

import numpy as np
import pytest

import voxtact as vx
from conftest import cube, half_space, program

TRIANGLES = np.array([[0, 1, 2], [1, 3, 2]])
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [1, 2, 3.5]])


def test_arrays():
    mesh = vx.read_mesh((CORNERS, TRIANGLES))
    assert mesh.vertices.dtype == np.float64 and mesh.faces.dtype == np.uint32 and mesh.notes == ()
    np.testing.assert_array_equal(mesh.vertices, CORNERS)
    np.testing.assert_array_equal(mesh.faces, TRIANGLES)
    assert not mesh.vertices.flags.writeable and not mesh.faces.flags.writeable
    np.testing.assert_array_equal(mesh.bounds, [[0, 0, 0], [1, 2, 3.5]])
    np.testing.assert_array_equal(vx.read_mesh((CORNERS.tolist(), TRIANGLES.tolist())).faces, TRIANGLES)
    np.testing.assert_array_equal(vx.read_mesh((np.asfortranarray(CORNERS), TRIANGLES[::-1])).faces, TRIANGLES[::-1])
    for given in (CORNERS + 0.1, (CORNERS + 0.1).astype(np.float32), CORNERS + 4500000.2):
        mesh = vx.read_mesh((given, TRIANGLES))
        assert mesh.notes == ()
        np.testing.assert_array_equal(mesh.vertices, given)
    assert "rounded by up to 0.00" in vx.read_mesh((CORNERS * 100000.1, TRIANGLES)).notes[0]


def test_far_from_the_origin():
    """Map coordinates, which no float32 holds: the distance is that of the vertices as they are given."""
    corners = np.array([[500008.9, 4649781.2, 1005.2], [500008.9, 4649784.2, 1005.2], [500008.9, 4649781.2, 1008.2]])
    pose = np.eye(4)
    pose[:3, 3] = -500000, -4649776, -1000
    voxels = np.zeros((20, 20, 20), dtype=np.uint8)
    voxels[10:] = 100
    volume = vx.read_volume(voxels, affine=np.eye(4), space="lps")
    scene = vx.Scene(volume, opacity=[(0, 0), (100, 1)], threshold=0.1)
    found = scene.distance(vx.read_mesh((corners, [[0, 1, 2]])), pose)
    assert found.lower[0] <= 0.2 <= found.upper[0] and found.upper[0] - found.lower[0] <= 1e-3


def test_space_and_scale():
    mesh = vx.read_mesh((CORNERS, TRIANGLES), space="ras", scale=1000)
    np.testing.assert_array_equal(mesh.vertices, CORNERS * [-1000, -1000, 1000])
    np.testing.assert_array_equal(vx.read_mesh(mesh, space="ras", scale=0.001).vertices, CORNERS)
    assert vx.read_mesh(mesh) is mesh


@pytest.mark.parametrize("vertices, faces, text", [
    (CORNERS, [[0, 1, 4]], r"face 0 is \[0, 1, 4\]; there are 4 vertices"),
    (CORNERS, [[0, 1, 2], [0, -1, 2]], "face 1"),
    (CORNERS, TRIANGLES.astype(float), "float64"),
    (CORNERS, [[0, 1, 2, 3]], r"\(T, 3\)"),
    (CORNERS[:, :2], TRIANGLES, r"\(V, 3\)"),
    (CORNERS, np.empty((0, 3), dtype=int), "triangle"),
    (CORNERS * np.nan, TRIANGLES, "vertex 0"),
    (CORNERS * 1e300, TRIANGLES, "no float32 holds"),
    (np.array([["a"] * 3] * 4), TRIANGLES, "vertices are"),
])
def test_what_is_wrong_is_named(vertices, faces, text):
    with pytest.raises(vx.InvalidArgumentError, match=text):
        vx.read_mesh((vertices, faces))


def test_wrong_options_and_things():
    for scale in (0, -1, np.nan, np.inf):
        with pytest.raises(vx.InvalidArgumentError, match="scale"):
            vx.read_mesh((CORNERS, TRIANGLES), scale=scale)
    with pytest.raises(vx.InvalidArgumentError, match="space"):
        vx.read_mesh((CORNERS, TRIANGLES), space="lpi")
    for thing in (3, object(), None, (1, 2, 3)):
        with pytest.raises(TypeError, match="no mesh can be made"):
            vx.read_mesh(thing)
    with pytest.raises(vx.FileError, match="nowhere.stl"):
        vx.read_mesh("nowhere.stl")


def test_files(tmp_path, knife):
    for ending in ("stl", "obj", "ply"):
        knife.write(tmp_path / f"mesh.{ending}")
        again = vx.read_mesh(tmp_path / f"mesh.{ending}")
        assert len(again.faces) == len(knife.faces)
    program("make", "mesh", "builtin:scalpel:300", tmp_path / "theirs.stl", cwd=tmp_path)
    np.testing.assert_array_equal(vx.read_mesh(tmp_path / "theirs.stl").vertices, vx.read_mesh(tmp_path / "mesh.stl").vertices)


def test_curved_surfaces(tmp_path):
    """Triangles that stand for one, as those of STEP do: what is within their deflection is no *no*."""
    scene = vx.Scene(vx.read_volume(half_space(), axes="zyx", affine=np.eye(4), space="lps"), opacity=[(99, 0), (101, 1)])
    flat = vx.read_mesh((CORNERS[:, [2, 0, 1]] + [5.8, 3, 3], TRIANGLES[:1]))
    for deflection, undecided in ((0, False), (0.2, False), (0.4, True)):
        # As pickle makes it.
        make, (vertices, faces, name, notes, _) = flat.__reduce__()
        mesh = pickle.loads(pickle.dumps(make(vertices, faces, name, notes, deflection)))
        assert mesh.deflection == deflection
        answer = scene.touch(mesh, np.eye(4))
        assert (answer.touches.any(), answer.undecided.any()) == (False, undecided)
        assert scene.touch([(mesh, np.eye(4))]).undecided.any() == undecided
        assert vx.read_mesh(mesh, scale=2).deflection == 2 * deflection
    (tmp_path / "m.step").write_text("ISO-10303-21;\nEND-ISO-10303-21;\n")
    with pytest.raises(vx.FormatError, match="voxtact-step|OpenCASCADE|Parsing"):
        vx.read_mesh(tmp_path / "m.step")
    with pytest.raises(vx.InvalidArgumentError, match="the deflection -1 mm is not a number from 1e-06 mm on"):
        vx.read_mesh(tmp_path / "m.step", deflection=-1)
    with pytest.raises(vx.InvalidArgumentError, match="deflection"):
        vx.read_mesh(tmp_path / "m.step", deflection=0)


def test_trimesh():
    class Trimesh:  # what its meshes have
        vertices, faces = CORNERS, TRIANGLES

    np.testing.assert_array_equal(vx.read_mesh(Trimesh()).vertices, CORNERS)


def test_meshio(tmp_path):
    meshio = pytest.importorskip("meshio")
    mesh = meshio.Mesh(CORNERS, [("triangle", TRIANGLES), ("quad", [[0, 1, 3, 2]]), ("line", [[0, 1]])])
    read = vx.read_mesh(mesh)
    np.testing.assert_array_equal(read.faces, [[0, 1, 2], [1, 3, 2], [0, 1, 3], [0, 3, 2]])
    assert read.notes == ("1 quads cut into triangles", "1 cells of type line left out")
    with pytest.raises(vx.InvalidArgumentError, match="no triangles; 1 cells of type line"):
        vx.read_mesh(meshio.Mesh(CORNERS, [("line", [[0, 1]])]))
    cube(3).write(tmp_path / "cube.stl")
    theirs, ours = vx.read_mesh(meshio.read(tmp_path / "cube.stl")), vx.read_mesh(tmp_path / "cube.stl")
    np.testing.assert_array_equal(theirs.vertices[theirs.faces], ours.vertices[ours.faces])


def test_vtk(tmp_path):
    pytest.importorskip("vtkmodules.vtkIOGeometry")
    from vtkmodules.vtkFiltersSources import vtkCubeSource
    from vtkmodules.vtkIOGeometry import vtkSTLReader

    cube(3).write(tmp_path / "cube.stl")
    reader = vtkSTLReader()
    reader.SetFileName(str(tmp_path / "cube.stl"))
    reader.Update()
    theirs, ours = vx.read_mesh(reader.GetOutput()), vx.read_mesh(tmp_path / "cube.stl")
    np.testing.assert_array_equal(theirs.vertices[theirs.faces], ours.vertices[ours.faces])
    source = vtkCubeSource()  # of quads
    source.Update()
    mesh = vx.read_mesh(source.GetOutput())
    assert len(mesh.faces) == 12 and "cut into triangles" in mesh.notes[0]


def test_deleted_cells_of_vtk():
    pytest.importorskip("vtkmodules.vtkFiltersSources")
    from vtkmodules.vtkFiltersSources import vtkSphereSource

    source = vtkSphereSource()
    source.Update()
    ball = source.GetOutput()
    whole = vx.read_mesh(ball)
    ball.BuildCells()
    ball.DeleteCell(3)
    mesh = vx.read_mesh(ball)
    np.testing.assert_array_equal(mesh.faces, np.delete(whole.faces, 3, axis=0))
    assert "deleted cells left out: 1" in mesh.notes
    assert ball.GetNumberOfCells() == len(whole.faces)  # theirs is as it was


def meshio_of(points, quads):
    meshio = pytest.importorskip("meshio")
    return meshio.Mesh(np.array(points, dtype=float), [("quad", np.array(quads))])


def area_of(mesh):
    a, b, c = (mesh.vertices[mesh.faces[:, corner]].astype(float) for corner in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


@pytest.mark.parametrize("first", range(4))
@pytest.mark.parametrize("turned", [1, -1])
@pytest.mark.parametrize("up", range(3))
@pytest.mark.parametrize("size", [0.001, 1e-200, 1e200])
def test_quads_with_a_notch(first, turned, up, size):
    notched = np.roll([[20, 0, 4], [5, 5, 4], [0, 20, 4], [0, 0, 4]], first, axis=0)[::turned]
    quad = np.roll(notched, up, axis=1)
    square = [[0, 0, 0], [2, 0, 2], [2, 1, 2], [0, 1, 0]]
    mesh = vx.read_mesh(meshio_of(np.array([*quad, *square]) * size, [[0, 1, 2, 3], [4, 5, 6, 7]]), scale=1 / size)
    assert area_of(mesh) == pytest.approx(100 + 8**0.5)
    edges = np.diff(mesh.vertices[mesh.faces[:2]], axis=1)
    assert (np.cross(edges[:, 0], edges[:, 1])[:, (2 + up) % 3] * turned > 0).all()


def test_quads_that_cannot_be_cut():
    for end in (1, 1.3):  # of two triangles of the same size, and not
        points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [end, 1, 0], [2, 0, 0], [2, 1, 0]]
        with pytest.raises(vx.InvalidArgumentError, match=r"vertices \[0, 1, 2, 3\] crosses itself"):
            vx.read_mesh(meshio_of(points, [[1, 4, 5, 3], [0, 1, 2, 3]]))
    with pytest.raises(vx.InvalidArgumentError, match="vertex 0 is"):
        vx.read_mesh(meshio_of([[np.inf, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]]))
    line = vx.read_mesh(meshio_of([[0, 0, 0], [1, 1, 1], [2, 2, 2], [3, 3, 3]], [[0, 1, 2, 3]]))
    assert area_of(line) == 0
    with pytest.raises(vx.InvalidArgumentError, match="there are 3 vertices"):
        vx.read_mesh(meshio_of(np.zeros((3, 3)), [[0, 1, 2, 3]]))


def test_vtk_without_points():
    vtk = pytest.importorskip("vtkmodules.vtkCommonDataModel")
    quads = vtk.vtkCellArray()
    quads.InsertNextCell(4, [0, 1, 2, 3])
    of_quads = vtk.vtkPolyData()
    of_quads.SetPolys(quads)
    for mesh in (vtk.vtkPolyData(), of_quads):
        with pytest.raises(vx.InvalidArgumentError, match="no points"):
            vx.read_mesh(mesh)
