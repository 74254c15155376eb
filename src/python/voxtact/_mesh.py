# SPDX-License-Identifier: MIT
"""Meshes: from files, arrays, and other libraries."""
from __future__ import annotations

import os
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _handles as core
from ._common import BUILTIN, Space, array_of, checked_space, encoded, encoded_text, number, numbers
from ._errors import InvalidArgumentError
from ._request import check_affine, columns_of


class Mesh:
    """An immutable triangle mesh in its own coordinates, mm. `read_mesh` creates one."""

    __slots__ = ("_core", "_assumed")
    _core: core.Mesh
    _assumed: bool  # True: the vertices are in LPS by default, not by a statement

    def __init__(self) -> None:
        raise TypeError("voxtact.read_mesh() makes meshes: from a file, (vertices, faces), or a mesh object")

    @classmethod
    def _of(cls, made_of: core.Mesh) -> Mesh:
        made = cls.__new__(cls)
        made._core = made_of
        made._assumed = False
        return made

    @property
    def vertices(self) -> npt.NDArray[np.float64]:
        """(V,3): mm, read-only."""
        return self._core.vertices

    @property
    def faces(self) -> npt.NDArray[np.uint32]:
        """(T,3): vertex indices, read-only. Answers number triangles by row."""
        return self._core.faces

    @property
    def bounds(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Minimum and maximum corner, mm."""
        return self._core.bounds

    def boxes_at(self, poses: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Returns the world bounding boxes at poses (N,4,4) or (4,4): (N,2,3), minimum and maximum corners."""
        columns = columns_of(numbers(poses, "poses"))
        check_affine(columns)
        return self._core.boxes_at(columns)

    @property
    def degenerate(self) -> int:
        """Number of triangles without an area: allowed. Projections to a view never cover them; certified answers
        include them."""
        return self._core.degenerate

    @property
    def deflection(self) -> float:
        """Of a mesh from STEP or IGES: no point of the curved surface is farther from the triangles, mm; else 0.
        `Scene.touch` says no only where that surface does not touch; all other answers are about the triangles."""
        return self._core.deflection

    @property
    def name(self) -> str:
        """Name of the file or source."""
        return self._core.name

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes of the reader: conversions and assumptions."""
        return tuple(self._core.notes)

    def write(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes STL, OBJ or PLY, by the ending."""
        self._core.write(encoded(path))

    def __repr__(self) -> str:
        lo, hi = self.bounds
        size = " x ".join(f"{length:.4g}" for length in hi - lo)
        return f"<voxtact.Mesh {self.name!r}: {len(self.faces)} triangles, {len(self.vertices)} vertices, {size} mm>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _mesh_again, (self.vertices, self.faces, self.name, self.notes, self.deflection)


def _mesh_again(vertices: npt.NDArray[Any], faces: npt.NDArray[Any], name: str, notes: tuple[str, ...],
                deflection: float = 0.0) -> Mesh:
    """What pickle calls."""
    return Mesh._of(core.Mesh.make(vertices, faces, encoded_text(name, "name"),
                                   [encoded_text(note, "a note") for note in notes], deflection))


def _mesh_of_arrays(vertices: Any, faces: Any, space: Space, scale: float, name: str,
                    notes: Optional[list[str]] = None, deflection: float = 0.0) -> Mesh:
    said = [] if notes is None else notes
    places = array_of(vertices, "vertices")
    corners = array_of(faces, "faces")
    if places.ndim != 2 or places.shape[1] != 3 or places.dtype.kind not in "fiu":
        raise InvalidArgumentError(f"vertices are {places.dtype} of shape {places.shape}; numbers of shape (V, 3) are "
                                   "needed")
    if corners.ndim != 2 or corners.shape[1] != 3:
        raise InvalidArgumentError(f"faces have the shape {corners.shape}; triangles are needed: (T, 3)")
    if corners.dtype.kind not in "iu":
        raise InvalidArgumentError(f"faces are {corners.dtype}; whole numbers of vertices are needed")
    if corners.size and (corners.min() < 0 or corners.max() >= len(places)):
        bad = int(np.argmax(((corners < 0) | (corners >= len(places))).any(axis=1)))
        raise InvalidArgumentError(f"face {bad} is {corners[bad].tolist()}; there are {len(places)} vertices, from 0 on")
    if not (np.isfinite(scale) and scale > 0):
        raise InvalidArgumentError(f"scale={scale} must be positive and finite: mm in a unit of the vertices")
    exact = places.astype(np.float64) * scale
    if space == "ras":
        exact[:, :2] *= -1
    within = (np.abs(exact) <= np.finfo(np.float32).max).all(axis=1)
    if not within.all():
        bad = int(np.argmin(within))
        raise InvalidArgumentError(f"vertex {bad} is {places[bad].tolist()}, which no float32 holds")
    return Mesh._of(core.Mesh.make(np.ascontiguousarray(exact), np.ascontiguousarray(corners, dtype=np.uint32), encoded_text(name, "name"),
                                   [encoded_text(note, "a note") for note in said], scale * deflection))


def _of_quads(corners: npt.NDArray[Any], points: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Splits each quad into two triangles, along the diagonal that is inside. Splits a non-planar quad by its largest
    axis-aligned projection."""
    sane = corners.dtype.kind in "iu" and points.dtype.kind in "fiu" and points.shape[1:] == (3,)
    if not sane or not corners.size or corners.min() < 0 or corners.max() >= len(points):
        return corners[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)  # refused with all others
    with np.errstate(invalid="ignore", over="ignore"):
        seen = points[corners].astype(np.float64)
        seen -= seen[:, :1]
        seen = np.ldexp(seen, -np.frexp(np.abs(seen).max(axis=(1, 2)))[1][:, None, None])
        normal = np.abs(np.cross(seen[:, 2], seen[:, 3] - seen[:, 1]))
        axis = normal.argmax(axis=1)
        rows = np.arange(len(corners))[:, None]
        flat = np.stack([seen[rows, [0, 1, 2, 3], (axis[:, None] + k) % 3] for k in (1, 2)], axis=2)

        def turn(a: int, b: int, c: int) -> npt.NDArray[Any]:
            u, v = flat[:, b] - flat[:, a], flat[:, c] - flat[:, a]
            return np.asarray(np.sign(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]))

        first, second = turn(0, 1, 2) * turn(0, 2, 3), turn(1, 2, 3) * turn(1, 3, 0)
        # A quad without area is a line, or has two halves of opposite orientation.
        sides = np.stack([np.cross(seen[:, a], seen[:, b]) for a, b in ((1, 2), (1, 3), (2, 3))], axis=1)
        empty = (normal.max(axis=1) <= 1e-12) & (np.abs(sides).max(axis=(1, 2)) > 1e-12)
    other = first < 0
    crossed = (other & (second < 0)) | empty
    if crossed.any():
        raise InvalidArgumentError(f"the quad of the vertices {corners[np.argmax(crossed)].tolist()} crosses itself or "
                                   "is folded")
    return np.where(other[:, None], corners[:, [1, 2, 3, 1, 3, 0]], corners[:, [0, 1, 2, 0, 2, 3]]).reshape(-1, 3)


def _of_meshio(mesh: Any, space: Space, scale: float) -> Mesh:
    parts: list[npt.NDArray[Any]] = []
    notes: list[str] = []
    for block in mesh.cells:
        cells = np.asarray(block.data)
        if block.type == "triangle":
            parts.append(cells)
        elif block.type == "quad":
            parts.append(_of_quads(cells, np.asarray(mesh.points)))
            notes.append(f"{len(cells)} quads cut into triangles")
        else:
            notes.append(f"{len(cells)} cells of type {block.type} left out")
    if not parts:
        raise InvalidArgumentError("the mesh has no triangles; " + "; ".join(notes))
    return _mesh_of_arrays(mesh.points, np.concatenate(parts), space, scale, "meshio mesh", notes)


def _of_vtk_mesh(mesh: Any, space: Space, scale: float) -> Mesh:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    notes: list[str] = []
    if mesh.GetPoints() is None:  # VTK's own filters crash
        raise InvalidArgumentError("the vtkPolyData has no points")
    if not mesh.NeedToBuildCells():  # otherwise no cell can have been deleted
        whole, mesh = mesh, mesh.NewInstance()
        mesh.ShallowCopy(whole)
        mesh.RemoveDeletedCells()
        if mesh.GetNumberOfCells() != whole.GetNumberOfCells():
            notes.append(f"deleted cells left out: {whole.GetNumberOfCells() - mesh.GetNumberOfCells()}")
    if mesh.GetNumberOfStrips() or (np.diff(vtk_to_numpy(mesh.GetPolys().GetOffsetsArray())) != 3).any():
        from vtkmodules.vtkFiltersCore import vtkTriangleFilter

        cut = vtkTriangleFilter()
        cut.SetInputData(mesh)
        cut.PassVertsOff()
        cut.PassLinesOff()
        cut.Update()
        mesh = cut.GetOutput()
        notes.append("polygons and strips cut into triangles by VTK")
    if not mesh.GetNumberOfPolys():
        raise InvalidArgumentError("the vtkPolyData has no polygons")
    if mesh.GetNumberOfVerts() or mesh.GetNumberOfLines():
        notes.append("points and lines left out")
    faces = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return _mesh_of_arrays(vtk_to_numpy(mesh.GetPoints().GetData()), faces, space, scale, "vtkPolyData", notes)


def read_mesh(source: Any, *, space: Optional[Space] = None, scale: float = 1.0, deflection: float = 0.01) -> Mesh:
    """Reads a mesh from a file, arrays, or a mesh of another library.

    source
        - a path: STL, OBJ, PLY, OFF, VTK, glTF or GLB; STEP or IGES if the program voxtact-step is in the folder of
          the library or of Python; ``"builtin:scalpel"`` and the other names of the program's builtins
        - ``(vertices, faces)``: (V,3) numbers and (T,3) whole numbers
        - a trimesh (`.vertices`, `.faces`), a meshio mesh (triangles and quads), or a vtkPolyData

    space: of the vertices, "lps" unless it is said. "ras" negates x and y; what comes out is always LPS. An array with
    `affine` is "ras" unless it is said: where both meet in a scene and neither was said, a warning asks for it.
    scale: millimetres in a unit of the vertices; 1000 for metres.
    deflection: of the triangulation of STEP and IGES, mm. `Mesh.deflection` is the proven bound.

    Vertices are float64; `Mesh.notes` reports a loss above 0.0001 by single precision. Raises FileError, FormatError,
    and InvalidArgumentError, which names the vertex or face.
    """
    scale = number(scale, "scale")
    deflection = number(deflection, "deflection")
    if deflection == 0:
        raise InvalidArgumentError("deflection=0.0 is not above 0 mm")
    assumed = space is None
    space = checked_space(space or "lps", "space")
    if isinstance(source, Mesh):
        if space != "lps" or scale != 1.0:
            return _mesh_of_arrays(source.vertices, source.faces, space, scale, source.name, deflection=source.deflection)
        return source
    if isinstance(source, (str, bytes, os.PathLike)):
        if isinstance(source, str) and source.startswith(BUILTIN):
            mesh = Mesh._of(core.Mesh.builtin(encoded_text(source[len(BUILTIN):], "the name of the builtin")))
            return read_mesh(mesh, space=space, scale=scale)
        return Mesh._of(core.Mesh.read(encoded(source), space == "ras", scale, deflection))
    if isinstance(source, (tuple, list)) and len(source) == 2:
        mesh = _mesh_of_arrays(source[0], source[1], space, scale, "arrays")
        mesh._assumed = assumed
        return mesh
    if hasattr(source, "vertices") and hasattr(source, "faces"):
        return _mesh_of_arrays(source.vertices, source.faces, space, scale, "trimesh")
    if hasattr(source, "points") and hasattr(source, "cells"):
        return _of_meshio(source, space, scale)
    if hasattr(source, "GetPolys") and hasattr(source, "GetPoints"):
        return _of_vtk_mesh(source, space, scale)
    raise TypeError(f"no mesh can be made of a {type(source).__module__}.{type(source).__qualname__}: give a path, "
                    "(vertices, faces), or a mesh of trimesh, meshio or VTK")
