# SPDX-License-Identifier: MIT
"""Volumes, label maps, meshes and devices of the library as Python objects. Sizes and boxes are x, y, z; arrays of
voxels are z, y, x."""
from __future__ import annotations

import _thread
from collections.abc import Callable, Sequence
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._errors import InvalidArgumentError
from ._library import (
    NULL,
    CData,
    check,
    copied,
    doubles,
    ffi,
    lib,
    made,
    made_with,
    matrix_of,
    pointer,
    read_only,
    refuse,
    shown,
    struct,
    text_of,
    texts_of,
    vector,
)
from ._turns import guarded

_TYPES = tuple(np.dtype(name) for name in (np.uint8, np.int16, np.uint16, np.float32))  # indexed by vxt_scalar_type
METHODS: tuple[str, ...] = tuple(text_of(lib.vxt_method_name(number)) for number in range(lib.VXT_METHOD_CPU + 1))


def _decoded(text: bytes) -> str:
    return text.decode("utf-8", "surrogateescape")


class Volume:
    """An immutable image. `view` is a vxt_volume_view, whose memory `_owner` keeps."""

    __slots__ = ("view", "array", "name", "notes", "range", "_owner")
    array: npt.NDArray[Any]
    range: tuple[float, float]

    def __init__(self, view: CData, owner: Any, name: str, notes: list[str]) -> None:
        self.view = view
        self._owner = owner
        self.name = name
        self.notes = notes
        found = ffi.new("vxt_range*")
        guarded(lambda: check(lib.vxt_check_volume(view, found)))
        self.range = (found.lo, found.hi)

    @classmethod
    def _of(cls, data: CData) -> Volume:
        view = struct("volume_view")
        check(lib.vxt_volume_data_view(data, view))
        volume = cls(view, data, text_of(lib.vxt_volume_data_name(data)),
                     texts_of(lambda index: lib.vxt_volume_data_note(data, index)))
        volume.array = read_only(shown(view.voxels, tuple(view.grid.size)[::-1], _TYPES[view.type], data))
        return volume

    @classmethod
    def read(cls, path: bytes, frame: Optional[int], series: bytes, resample: bool) -> Volume:
        kept = ffi.new("char[]", series)
        options = struct("volume_read_options", choose_frame=frame is not None, frame=frame or 0, series=kept,
                         resample=resample)
        return cls._of(guarded(made, "volume_data", lib.vxt_read_volume, path, options))

    @classmethod
    def builtin(cls, name: bytes) -> Volume:
        return cls._of(guarded(made, "volume_data", lib.vxt_builtin_volume, name))

    @classmethod
    def wrap(cls, array: npt.NDArray[Any], spacing: npt.NDArray[np.float64], origin: npt.NDArray[np.float64],
             direction: npt.NDArray[np.float64], name: bytes, notes: Sequence[bytes]) -> Volume:
        """Wraps an array in C order, without a copy."""
        grid = {"spacing": vector(spacing, "spacing"), "origin": vector(origin, "origin"), "size": list(reversed(array.shape)),
                "direction": [float(number) for number in direction.T.reshape(-1)]}
        kept = pointer("char", array.reshape(-1).view(np.uint8))
        view = struct("volume_view", voxels=kept, bytes=array.nbytes, grid=grid, type=_TYPES.index(array.dtype))
        said = [_decoded(note) for note in notes]
        volume = cls(view, kept, _decoded(name), said)
        volume.array = read_only(array.view())
        note = text_of(lib.vxt_grid_note(volume.grid))
        if note and note not in said:
            said.append(note)
        return volume

    @property
    def grid(self) -> CData:
        return ffi.addressof(self.view, "grid")

    @property
    def spacing(self) -> npt.NDArray[np.float64]:
        return copied(self.view.grid.spacing, (3,))

    @property
    def origin(self) -> npt.NDArray[np.float64]:
        return copied(self.view.grid.origin, (3,))

    @property
    def direction(self) -> npt.NDArray[np.float64]:
        return copied(self.view.grid.direction, (3, 3)).T.copy()

    def shear(self) -> tuple[float, float]:
        """Returns the shear, degrees, and the maximum for a file."""
        degrees = ffi.new("double[2]")
        check(lib.vxt_grid_shear(self.grid, degrees, degrees + 1))
        return degrees[0], degrees[1]

    @property
    def world_from_index(self) -> npt.NDArray[np.float64]:
        found = ffi.new("double[16]")
        check(lib.vxt_world_from_index(self.grid, found))
        return matrix_of(found)

    @property
    def box(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Returns the minimum and maximum corner of the world bounding box."""
        space, box = ffi.new("double[16]"), ffi.new("vxt_box*", {"hi": [1, 1, 1]})
        check(lib.vxt_world_from_texture(self.grid, space))
        check(lib.vxt_transform_box(space, box, box))
        return copied(box.lo, (3,)), copied(box.hi, (3,))

    @property
    def type(self) -> str:
        return text_of(lib.vxt_scalar_type_name(self.view.type))

    @property
    def size(self) -> list[int]:
        return list(self.view.grid.size)

    def write(self, path: bytes) -> None:
        guarded(lambda: check(lib.vxt_write_volume(path, self.view)))


class Labels:
    """A label map."""

    __slots__ = ("handle", "values")

    def __init__(self, volume: Volume) -> None:
        self.handle = guarded(made, "labels", lib.vxt_labels_create, volume.view)
        count = ffi.new("size_t*")
        found = lib.vxt_labels_values(self.handle, count)
        self.values: npt.NDArray[np.int32] = read_only(shown(found, (count[0],), np.int32, self.handle))

    def on(self, grid: CData) -> CData:
        """Returns the vxt_labels on a volume's grid, of which the map's own may be a part; else the map as it is."""
        own, place = ffi.new("vxt_grid*"), ffi.new("vxt_labels**")
        check(lib.vxt_labels_grid(self.handle, own))
        if list(own.size) == list(grid.size) or guarded(lib.vxt_labels_on_grid, self.handle, ffi.addressof(grid), place):
            return self.handle
        return ffi.gc(place[0], lib.vxt_labels_destroy)

    def at(self, points: npt.NDArray[np.float64]) -> npt.NDArray[np.int32]:
        if points.ndim != 2 or points.shape[1] != 3:
            refuse("points have the wrong shape; (N,3) is needed")
        found = np.empty(len(points), np.int32)
        check(lib.vxt_labels_at_points(self.handle, pointer("double", doubles(points)), len(points), pointer("int32_t", found)))
        return found

    def along(self, start: npt.NDArray[np.float64], end: npt.NDArray[np.float64]) -> npt.NDArray[np.int32]:
        line = vector(start, "start"), vector(end, "end")
        found, count = np.empty(len(self.values), np.int32), ffi.new("size_t*")
        guarded(lambda: check(lib.vxt_labels_along(self.handle, *line, pointer("int32_t", found), len(found), count)))
        return found[:count[0]].copy()


class Mesh:
    """An immutable mesh. `view` is a vxt_mesh_view."""

    __slots__ = ("view", "vertices", "faces", "name", "notes", "facts", "triangles", "_on_host", "_filled", "__weakref__")

    def __init__(self, vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.uint32], name: str, notes: list[str],
                 deflection: float = 0.0) -> None:
        self.vertices = read_only(vertices)
        self.faces = read_only(faces)
        self.name = name
        self.notes = notes
        self.view = struct("mesh_view", positions=pointer("double", vertices), vertex_count=len(vertices),
                           indices=pointer("uint32_t", faces), triangle_count=len(faces), deflection=deflection)
        self.facts = ffi.new("vxt_mesh_facts*")
        guarded(lambda: check(lib.vxt_check_mesh(self.view, self.facts)))
        self.triangles = len(faces)
        self._on_host: dict[str, CData] = {}
        self._filled: dict[str, tuple[Mesh, float]] = {}

    @classmethod
    def _of(cls, data: CData) -> Mesh:
        view = struct("mesh_view")
        check(lib.vxt_mesh_data_view(data, view))
        return cls(shown(view.positions, (view.vertex_count, 3), np.float64, data),
                   shown(view.indices, (view.triangle_count, 3), np.uint32, data), text_of(lib.vxt_mesh_data_name(data)),
                   texts_of(lambda index: lib.vxt_mesh_data_note(data, index)), view.deflection)

    @classmethod
    def read(cls, path: bytes, ras: bool, scale: float, deflection: float) -> Mesh:
        if scale == 0:
            refuse(f"scale={scale} must be positive and finite: mm in a unit of the vertices")
        return cls._of(guarded(made, "mesh_data", lib.vxt_read_mesh, path, 
                              struct("mesh_read_options", ras=ras, scale=scale, deflection=deflection)))

    @classmethod
    def builtin(cls, name: bytes) -> Mesh:
        return cls._of(guarded(made, "mesh_data", lib.vxt_builtin_mesh, name))

    @classmethod
    def make(cls, vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.uint32], name: bytes,
             notes: Sequence[bytes], deflection: float) -> Mesh:
        """Of copies of the arrays."""
        mesh = cls(np.array(vertices, np.float64, order="C"), np.array(faces, np.uint32, order="C"), _decoded(name),
                   [_decoded(note) for note in notes], deflection)
        note = text_of(lib.vxt_mesh_note(mesh.facts))
        if note and note not in mesh.notes:
            mesh.notes.append(note)
        return mesh

    @property
    def bounds(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        return copied(self.facts.bounds.lo, (3,)), copied(self.facts.bounds.hi, (3,))

    @property
    def degenerate(self) -> int:
        return int(self.facts.degenerate)

    @property
    def deflection(self) -> float:
        return float(self.view.deflection)

    @property
    def on_host(self) -> CData:
        """The vxt_host_mesh, created on first access."""
        kept = self._on_host.get("mesh")
        # If two threads create one, both use the first.
        return kept or self._on_host.setdefault("mesh", guarded(made, "host_mesh", lib.vxt_host_mesh_create, self.view))

    def filled(self) -> tuple[Mesh, float]:
        """Returns the mesh with its holes filled, and the area added; triangles keep their indices."""
        kept = self._filled.get("mesh")
        if kept is None:
            area = ffi.new("double*")
            place = ffi.new("vxt_mesh_data**")
            guarded(lambda: check(lib.vxt_mesh_fill_holes(self.view, place, area)))
            data = ffi.gc(place[0], lib.vxt_mesh_data_destroy)
            view = struct("mesh_view")
            check(lib.vxt_mesh_data_view(data, view))
            closed = Mesh(shown(view.positions, (view.vertex_count, 3), np.float64, data),
                          shown(view.indices, (view.triangle_count, 3), np.uint32, data), self.name, list(self.notes), view.deflection)
            kept = self._filled.setdefault("mesh", (closed, float(area[0])))
        return kept

    def boxes_at(self, columns: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """(N,2,3): world boxes at poses in column-major order."""
        boxes = np.empty((len(columns), 2, 3))
        check(lib.vxt_boxes_at(pointer("double", columns), len(columns), ffi.addressof(self.facts, "bounds"),
                               ffi.cast("vxt_box*", pointer("double", boxes))))
        return boxes

    def write(self, path: bytes) -> None:
        guarded(lambda: check(lib.vxt_write_mesh(path, self.view)))


# Devices

_Facts = tuple[int, str, str, str, str]


def _facts_of(facts: CData) -> _Facts:
    version = facts.api_version  # layout of VK_MAKE_API_VERSION
    return (facts.index, text_of(facts.name), text_of(facts.type), text_of(facts.driver),
            f"{version >> 22 & 0x7f}.{version >> 12 & 0x3ff}.{version & 0xfff}")


class Device:
    """A device that the library owns."""

    __slots__ = ("handle", "facts", "_submitting")

    def __init__(self, handle: CData) -> None:
        self.handle = handle
        facts = struct("device_facts")
        check(lib.vxt_device_get_facts(handle, facts))
        self.facts = _facts_of(facts)
        self._submitting = _thread.allocate_lock()

    @staticmethod
    def every() -> list[_Facts]:
        count, facts = ffi.new("uint32_t*"), struct("device_facts")
        check(guarded(lib.vxt_device_count, count))

        def described(index: int) -> _Facts:
            check(guarded(lib.vxt_device_describe, index, facts))
            return _facts_of(facts)

        return [described(index) for index in range(count[0])]

    @classmethod
    def open(cls, wanted: bytes) -> Device:
        try:
            return cls(guarded(made_with, (), "device", lib.vxt_device_open, wanted))
        except InvalidArgumentError as error:  # the error names this argument
            raise InvalidArgumentError(str(error).replace("device '", "device='", 1)) from None

    @property
    def queue(self) -> CData:
        """Returns the vxt_queue; refuses a child of the process that opened the device."""
        queue = struct("queue")
        check(lib.vxt_device_queue(self.handle, queue))
        return queue

    @property
    def context(self) -> CData:
        context = lib.vxt_device_context(self.handle)
        if context == NULL:
            _ = self.queue  # the error states the reason
        return context

    def make(self, kind: str, create: Callable[..., int], *arguments: Any) -> CData:
        """Creates an object on the device, which outlives it."""
        return made_with((self.handle,), kind, create, *arguments)

    def submit(self, record: Callable[..., int], *arguments: Any) -> None:
        """Records by `record(OBJECT, commands, ...)`, submits and waits."""
        commands = ffi.new("VkCommandBuffer*")
        with self._submitting:
            check(lib.vxt_device_begin(self.handle, commands))
            check(record(arguments[0], commands[0], *arguments[1:]))
            check(lib.vxt_device_submit(self.handle))

    def _report(self, create: Callable[..., int], *arguments: Any) -> list[tuple[str, bool, bool, str]]:
        report, view = guarded(made, "report", create, self.context, *arguments), struct("report_view")
        check(lib.vxt_report_get(report, view))
        return [(METHODS[one.method], bool(one.available), bool(one.trusted), text_of(one.text))
                for one in view.methods[0:view.method_count]]

    @property
    def methods(self) -> dict[str, Optional[str]]:
        return {method: None if available else text for method, available, _, text in self._report(lib.vxt_context_methods)}

    @property
    def default_method(self) -> str:
        name: str = METHODS[lib.vxt_context_default_method(self.context)]
        return name

    def self_test(self) -> list[tuple[str, bool, bool, str]]:
        return self._report(lib.vxt_self_test, self.queue)
