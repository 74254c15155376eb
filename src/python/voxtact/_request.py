# SPDX-License-Identifier: MIT
"""Requests of scenes: meshes at poses, counting options, and opacity, in the library's form."""
from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._common import encoded_text
from ._handles import METHODS, Mesh, Volume
from ._library import FACTS, NULL, CData, check, doubles, ffi, lib, matrix, named, pointer, refuse, shape_text, struct, text_of

PROJECTIONS: tuple[str, ...] = tuple(text_of(lib.vxt_projection_name(number)) for number in range(lib.VXT_PROJECTION_CERTIFIED + 1))
_FILTERS = tuple(text_of(lib.vxt_filter_name(number)) for number in range(lib.VXT_FILTER_EXACT + 1))
_BOUNDARIES = tuple(text_of(lib.vxt_boundary_name(number)) for number in range(lib.VXT_BOUNDARY_CLAMP + 1))
_OUTPUTS = {"triangles": lib.VXT_OUTPUT_TRIANGLES, "contacts": lib.VXT_OUTPUT_CONTACTS, "bounds": lib.VXT_OUTPUT_BOUNDS,
            "labels": lib.VXT_OUTPUT_LABELS}
_LAST_ROW = np.array([0.0, 0.0, 0.0, 1.0])
_PIXELS = 512
_DISTANCE_COST = 16


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


class HostQuestion:
    """A question of the host engine by its name.

    `arguments`: name, settings and their number, for vxt_ask(); `cost`: factor of the duration of a plain touch
    """

    __slots__ = ("name", "arguments", "cost", "max_contacts", "uses_view", "view", "_kept")

    def __init__(self, name: str, settings: dict[str, Any]) -> None:
        """settings: numbers, truth values, texts and lists of numbers; None is not given."""
        self.name = name
        self.uses_view = name == "count"
        self.view: CData = None
        self._kept: list[CData] = [ffi.new("char[]", encoded_text(name, "question"))]
        given = [self._setting(setting, value) for setting, value in settings.items() if value is not None]
        self.arguments = (self._kept[0], ffi.new("vxt_setting[]", given), len(given))
        self.cost = _DISTANCE_COST * (1 + sum(len(value) for value in settings.values() if isinstance(value, list)))
        self.max_contacts: Optional[int] = settings.get("max_contacts")

    def _setting(self, name: str, value: Any) -> dict[str, Any]:
        kind, made = "number", value
        if isinstance(value, str):
            kind, made = "text", ffi.new("char[]", encoded_text(value, name))
        elif isinstance(value, list):
            fact = FACTS.get((self.name, name))
            kind, element = ("labels", "int32_t") if fact is not None and fact.kind == "labels" else ("numbers", "double")
            made = ffi.new(f"{element}[]", value or 1)  # an empty list has a pointer, too
        self._kept += [ffi.new("char[]", encoded_text(name, "setting")), made]
        return {"name": self._kept[-2], kind: made, "count": len(value) if isinstance(value, list) else 0}

    def view_on(self, grid: CData) -> CData:
        """Returns the camera of projections that use one; the default is from above."""
        if self.uses_view and self.view is None:
            view = ffi.new("vxt_view*")
            check(lib.vxt_framing_view(grid, _PIXELS, _PIXELS, view))
            self.view = view
        return self.view if self.uses_view else NULL


class TouchQuestion(HostQuestion):
    """A touch question."""

    __slots__ = ("is_plain", "count_options")

    def __init__(self, settings: dict[str, Any]) -> None:
        super().__init__("touch", settings)
        #: a device has it, too, by the options of a count
        self.is_plain = not settings.keys() - {"resolution"}
        self.cost = 1 if self.is_plain else _DISTANCE_COST
        self.count_options: dict[str, Any] = {"stop_at_first": True, **settings}


class Question(HostQuestion):
    """A count question of the host engine or of a device. Options that are not given are None."""

    __slots__ = ("options", "projection", "is_certified", "method", "filter", "boundary", "outputs", "max_depth", "samples_per_voxel",
                 "resolution", "stop_at_first", "overestimate", "counters", "key")
    max_contacts: int

    def __init__(self, options: dict[str, Any]) -> None:
        get = options.get
        self.options = options
        self.projection = named(get("projection", "certified"), "projection", PROJECTIONS)
        self.method = named(options["method"], "method", METHODS) if "method" in options else None
        self.filter = named(options["filter"], "filter", _FILTERS) if "filter" in options else None
        self.boundary = named(get("boundary", "auto"), "boundary", _BOUNDARIES)
        self.outputs = sum(bit for name, bit in _OUTPUTS.items() if get(name))
        self.max_depth, self.samples_per_voxel, self.resolution = get("max_depth"), get("samples_per_voxel"), get("resolution")
        self.stop_at_first, self.overestimate = bool(get("stop_at_first")), bool(get("overestimate"))
        self.counters = bool(get("counters"))
        self.is_certified = self.projection == lib.VXT_PROJECTION_CERTIFIED
        room = get("max_contacts", 2**20)
        of_host = {name: value for name, value in options.items() if ("count", name) in FACTS}
        super().__init__("count", {**of_host, "projection": PROJECTIONS[self.projection], "max_contacts": max(room, 1)})
        self.max_contacts = room
        self.uses_view = bool(lib.vxt_projection_uses_view(self.projection))
        self._check()
        if "view" in options:
            given, width, height = options["view"]
            self.view = ffi.new("vxt_view*", {"clip_from_world": matrix(given, "clip_from_world"), "width": width, "height": height})
        self.key = tuple((name, value) for name, value in options.items() if name != "view")

    def _check(self) -> None:
        """Refuses what is not of the projection."""
        name = PROJECTIONS[self.projection]
        if self.max_depth is not None and not (math.isfinite(self.max_depth) and self.max_depth > 0):
            refuse(f"max_depth is {self.max_depth}; it must be positive and finite")  # only for contacts
        if self.samples_per_voxel is not None and name != "dominant-axis":
            refuse(f"samples_per_voxel is for projection='dominant-axis', not for '{name}'")
        if "view" in self.options and not self.uses_view:
            refuse(f"view is for projection='view' and 'two-view', not for '{name}'")
        if self.resolution is not None and not self.is_certified:
            refuse(f"resolution is for projection='certified', not for '{name}'")
        if self.boundary == lib.VXT_BOUNDARY_CLAMP and self.is_certified:
            refuse("boundary='clamp' is not for projection='certified', which always tests the range")

    def again(self, output: str) -> Question:
        """Returns the same question with one output."""
        kept = {name: value for name, value in self.options.items() if name not in _OUTPUTS and name != "stop_at_first"}
        return Question({**kept, output: True})


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
