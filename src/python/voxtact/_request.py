# SPDX-License-Identifier: MIT
"""Requests of scenes: meshes at poses, counting options, and opacity, in the library's form."""
from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._handles import METHODS, Mesh, Volume
from ._library import NULL, CData, check, doubles, ffi, lib, matrix, named, not_zero, pointer, refuse, shape_text, struct, text_of

PROJECTIONS: tuple[str, ...] = tuple(text_of(lib.vxt_projection_name(number)) for number in range(lib.VXT_PROJECTION_CERTIFIED + 1))
_FILTERS = tuple(text_of(lib.vxt_filter_name(number)) for number in range(lib.VXT_FILTER_EXACT + 1))
_BOUNDARIES = tuple(text_of(lib.vxt_boundary_name(number)) for number in range(lib.VXT_BOUNDARY_CLAMP + 1))
_CERTIFIED: int = lib.VXT_PROJECTION_CERTIFIED
_OUTPUTS = {"triangles": lib.VXT_OUTPUT_TRIANGLES, "contacts": lib.VXT_OUTPUT_CONTACTS, "bounds": lib.VXT_OUTPUT_BOUNDS,
            "labels": lib.VXT_OUTPUT_LABELS}
_LAST_ROW = np.array([0.0, 0.0, 0.0, 1.0])
_PIXELS = 512


def columns_of(poses: npt.NDArray[np.float64], what: str = "poses") -> npt.NDArray[np.float64]:
    """Returns a column-major copy, (N,4,4), of poses (4,4) or (N,4,4)."""
    if poses.ndim == 2 and poses.shape == (4, 4):
        return poses.T.copy().reshape(1, 4, 4)
    if poses.ndim != 3 or poses.shape[1:] != (4, 4):
        refuse(f"{what} have the shape {shape_text(poses)}; (4,4) or (N,4,4) is needed, row by row")
    return np.array(poses.transpose(0, 2, 1), order="C")


def check_affine(columns: npt.NDArray[np.float64], which: str = "") -> None:
    """Refuses poses that are not finite or not affine; names the first."""
    if math.isfinite(columns.sum()) and (columns[:, :, 3] == _LAST_ROW).all():
        return
    fine = np.isfinite(columns).all(axis=(1, 2)) & (columns[:, :, 3] == _LAST_ROW).all(axis=1)
    if fine.all():
        return
    bad = int(np.argmin(fine))
    if lib.vxt_check_affine(pointer("double", columns[bad])):
        refuse(text_of(lib.vxt_last_error(NULL)).replace("b_from_a", f"{which}pose {bad}", 1))


class Item:
    """A mesh at poses, copied, so later changes of the arrays do not matter."""

    __slots__ = ("mesh", "columns", "first", "first_segment", "data")

    def __init__(self, mesh: Mesh, columns: npt.NDArray[np.float64], first: int, first_segment: int) -> None:
        self.mesh = mesh
        self.columns = columns
        self.first = first
        self.first_segment = first_segment
        self.data = ffi.from_buffer("double[]", columns)


class Request:
    """Meshes at poses: the pairs of the items in order."""

    __slots__ = ("of", "pairs", "segments", "max_triangles")

    def __init__(self, meshes: Any, poses: Any) -> None:
        self.pairs = self.segments = 0
        self.of: list[Item] = []
        if isinstance(meshes, Mesh):
            self._add(meshes, columns_of(poses))
        else:
            for mesh, those in meshes:
                self._add(mesh, columns_of(those))
        self.max_triangles = max([1, *(item.mesh.triangles for item in self.of)])
        if self.pairs != 1:
            self.check()

    def _add(self, mesh: Mesh, columns: npt.NDArray[np.float64]) -> None:
        self.of.append(Item(mesh, columns, self.pairs, self.segments))
        self.pairs += len(columns)
        self.segments += max(len(columns) - 1, 0)

    def check(self) -> None:
        """Refuses an invalid pose before any work, because a later piece would count from its own first pose."""
        for number, item in enumerate(self.of):
            check_affine(item.columns, f"item {number}, " if number else "")

    def part(self, first: int, count: int) -> Iterator[tuple[Mesh, CData, int]]:
        """Returns, for each item, the mesh and the poses among `count` pairs from `first` on."""
        for item in self.of:
            begin, end = max(first, item.first), min(first + count, item.first + len(item.columns))
            if begin < end:
                yield item.mesh, item.data + 16 * (begin - item.first), end - begin

    def part_of_segments(self, first: int, count: int) -> Iterator[tuple[Mesh, CData, int]]:
        """Like `part`, for segments, each with both poses."""
        for item in self.of:
            begin, end = max(first, item.first_segment), min(first + count, item.first_segment + len(item.columns) - 1)
            if begin < end:
                yield item.mesh, item.data + 16 * (begin - item.first_segment), end - begin + 1

    def lengths(self, of_segments: bool = False) -> list[int]:
        """Returns the number of pairs, or segments, of each item."""
        return [max(len(item.columns) - of_segments, 0) for item in self.of]


class TouchQuestion:
    """A touch question: `touch` is its vxt_touch."""

    __slots__ = ("touch", "is_plain", "count_options")

    def __init__(self, margin: float = 0, distance: float = 0, angle: float = 0, witness: bool = False, resolution: float = 0,
                 max_steps: int = 0, solid: bool = False) -> None:
        self.touch = struct("touch", margin=margin, uncertainty_distance=distance, uncertainty_angle=angle, witness=witness,
                            solid=solid, resolution=resolution, max_steps=max_steps)
        #: a device has it, too, by the options of a count
        self.is_plain = margin == distance == angle == max_steps == 0 and not witness and not solid
        self.count_options: dict[str, Any] = {"stop_at_first": True, **({"resolution": resolution} if resolution else {})}


class Question:
    """A count question: `count` is the vxt_count of the host engine."""

    __slots__ = ("count", "projection", "method", "filter", "boundary", "outputs", "max_depth", "samples_per_voxel",
                 "resolution", "stop_at_first", "overestimate", "counters", "max_contacts", "view", "key")

    def __init__(self, options: dict[str, Any]) -> None:
        get = options.get
        self.projection = named(get("projection", "certified"), "projection", PROJECTIONS)
        self.method = named(options["method"], "method", METHODS) if "method" in options else None
        self.filter = named(options["filter"], "filter", _FILTERS) if "filter" in options else None
        self.boundary = named(get("boundary", "auto"), "boundary", _BOUNDARIES)
        self.outputs = sum(bit for name, bit in _OUTPUTS.items() if get(name))
        self.max_depth = get("max_depth", 0.0)
        self.samples_per_voxel = get("samples_per_voxel", 0)
        self.resolution = get("resolution", 0.0)
        self.stop_at_first = bool(get("stop_at_first"))
        self.overestimate = bool(get("overestimate"))
        self.counters = bool(get("counters"))
        self.max_contacts = get("max_contacts", 2**20)
        self.view: CData = None
        if "max_depth" in options and not (math.isfinite(self.max_depth) and self.max_depth > 0):
            refuse(f"max_depth is {self.max_depth}; it must be positive and finite")  # only for contacts
        if "view" in options:
            given, width, height = options["view"]
            self.view = ffi.new("vxt_view*", {"clip_from_world": matrix(given, "clip_from_world"), "width": width, "height": height})
        self._refuse_what_is_not_of_the_projection(options)
        self.count = struct("count", projection=self.projection, boundary=self.boundary, outputs=self.outputs,
                            stop_at_first=self.stop_at_first, max_depth=self.max_depth, resolution=self.resolution,
                            samples_per_voxel=self.samples_per_voxel, max_contacts=max(self.max_contacts, 1))
        self.key = (self.projection, self.method, self.filter, self.boundary, self.outputs, self.max_depth, self.samples_per_voxel,
                    self.resolution, self.stop_at_first, self.overestimate, self.counters, self.max_contacts)

    def _refuse_what_is_not_of_the_projection(self, options: dict[str, Any]) -> None:
        name = PROJECTIONS[self.projection]
        if "samples_per_voxel" in options and name != "dominant-axis":
            refuse(f"samples_per_voxel is for projection='dominant-axis', not for '{name}'")
        if "view" in options and not self.uses_view:
            refuse(f"view is for projection='view' and 'two-view', not for '{name}'")
        if "resolution" in options:
            if not self.is_certified:
                refuse(f"resolution is for projection='certified', not for '{name}'")
            not_zero(self.resolution, "count", "resolution")
        if self.boundary == lib.VXT_BOUNDARY_CLAMP and self.is_certified:
            refuse("boundary='clamp' is not for projection='certified', which always tests the range")

    @property
    def is_certified(self) -> bool:
        return bool(self.projection == _CERTIFIED)

    @property
    def uses_view(self) -> bool:
        return bool(lib.vxt_projection_uses_view(self.projection))

    def again(self, output: str) -> Question:
        """Returns the same question with one output."""
        options: dict[str, Any] = {output: True, "projection": PROJECTIONS[self.projection],
                                   "boundary": _BOUNDARIES[self.boundary]}
        if self.method is not None:
            options["method"] = METHODS[self.method]
        if self.filter is not None:
            options["filter"] = _FILTERS[self.filter]
        for name in ("max_depth", "samples_per_voxel", "resolution"):
            if getattr(self, name):
                options[name] = getattr(self, name)
        options.update(overestimate=self.overestimate, counters=self.counters, max_contacts=self.max_contacts)
        question = Question(options)
        question.view = self.view
        return question

    def view_on(self, grid: CData) -> CData:
        """Returns the camera of projections that use one; the default is from above."""
        if not self.uses_view:
            return NULL
        if self.view is None:
            view = ffi.new("vxt_view*")
            check(lib.vxt_framing_view(grid, _PIXELS, _PIXELS, view))
            self.view = view
        return self.view


class Opacity:
    """Points, and the domain and size of the table: `desc` is the vxt_transfer_function_desc."""

    __slots__ = ("points", "domain", "table_size", "desc")

    def __init__(self, volume: Volume, points: Optional[npt.NDArray[np.float64]], domain: Optional[tuple[float, float]],
                 table_size: int) -> None:
        self.domain = domain if domain is not None else _domain_of(volume)
        if points is None:
            points = np.array([[self.domain[0], 0.0], [self.domain[1], 1.0]])
        if points.ndim != 2 or points.shape[1] != 2:
            refuse(f"opacity has the shape {shape_text(points)}; (N,2) is needed: value and opacity")
        self.points = np.array(doubles(points))
        self.table_size = table_size
        lo, hi = self.domain
        if lo == hi == 0:  # selects the range of the points
            refuse(f"the domain {lo:g}:{hi:g} is empty; the first value must be less than the second")
        self.desc = struct("transfer_function_desc", points=ffi.cast("vxt_control_point*", pointer("double", self.points)),
                           point_count=len(self.points), domain={"lo": lo, "hi": hi}, table_size=table_size)

    def facts(self, volume: Volume, threshold: float) -> tuple[bool, bool]:
        """Returns whether some values are opaque, and whether some of the volume's are. Errors in the points are raised
        elsewhere."""
        found, values = ffi.new("vxt_opacity_facts*"), ffi.new("vxt_range*", volume.range)
        if lib.vxt_check_opacity(self.desc, values, threshold, found):
            return True, True
        return bool(found.reaches), bool(found.any)


def _domain_of(volume: Volume) -> tuple[float, float]:
    """Returns 0 to 255 for uint8, else the volume's values, widened if there is one value: as in the program."""
    if volume.view.type == lib.VXT_SCALAR_UINT8:
        return 0.0, 255.0
    lo, hi = volume.range
    half = 0.0 if lo < hi else max(0.5, abs(lo) * 1e-6)
    return lo - half, hi + half
