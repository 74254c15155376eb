# SPDX-License-Identifier: MIT
"""Straight paths to a target, with certified distances."""
from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import Any, NoReturn, Optional, Union

import numpy as np
import numpy.typing as npt

from ._arguments import Opacity, pair
from ._common import check_made, listed, no_truth, number, numbers, restored, whole_number
from ._errors import InvalidArgumentError, NotReadyError
from ._labels import Labels
from ._library import lib, not_zero, vector
from ._mesh import Mesh
from ._tables import Tables

_PATH = np.dtype([("entry", np.uint32), ("position", np.float64, 3), ("length", np.float64), ("angle", np.float64),
                  ("safety", np.uint8), ("lower", np.float64), ("upper", np.float64), ("end", np.uint8), ("obstacle", np.int32),
                  ("label", np.int32), ("nearest", np.float64, 3), ("on_path", np.float64, 3)], align=True)
_UNSAFE, _SAFE, _UNDECIDED = range(3)


def plan_options(labels: Optional[Labels], *, avoid: Sequence[Union[int, str]], avoid_opacity: Opacity, avoid_volume: Any,
                 needle: Optional[tuple[float, float]], mesh: Optional[Mesh], tip: Optional[npt.ArrayLike],
                 axis: Optional[npt.ArrayLike], entries: int, entry_label: Union[None, int, str],
                 entry_radius: Optional[float], border_entries: bool, margin: float, max_length: Optional[float],
                 max_angle: Optional[float], tolerance: float, max: float, max_steps: int,
                 triangle_distances: bool) -> dict[str, Any]:
    """Returns the members of vxt_plan, and `avoid`. `labels`: of the scene."""
    avoided = listed(avoid, "avoid")
    if not avoided and avoid_opacity is None:
        raise InvalidArgumentError("avoid, avoid_opacity: give at least one of them, which says what to avoid")
    if avoid_volume is not None and avoid_opacity is None:
        raise InvalidArgumentError("avoid_volume needs avoid_opacity=, which says what to avoid in it")
    if labels is None and (avoided or entry_label is not None):
        raise InvalidArgumentError("plans that are about labels need a scene with labels=")
    if entry_label is not None and entry_radius is not None:
        raise InvalidArgumentError("entry_label and entry_radius both say where entries are; leave out one of them")
    if mesh is None and (tip is not None or axis is not None):
        raise InvalidArgumentError("tip and axis are of a mesh: give mesh=, too")
    if mesh is not None and (needle is not None or tip is None or axis is None):
        raise InvalidArgumentError("a mesh comes with tip= and axis=, and without needle=")
    wish: dict[str, Any] = {"entries": whole_number(entries, "entries", 1, lib.VXT_MAX_ENTRIES),
                            "margin": number(margin, "margin"),
                            "tolerance": not_zero(number(tolerance, "tolerance"), "plan", "tolerance"),
                            "max": not_zero(number(max, "max"), "plan", "max"),
                            "max_steps": whole_number(max_steps, "max_steps", 1), "border_entries": bool(border_entries),
                            "triangle_distances": bool(triangle_distances), "avoid": [], "entry_by_label": entry_label is not None}
    if labels is not None:
        wish["avoid"] = [labels._number(label, "a label of avoid") for label in avoided]
    if entry_label is not None and labels is not None:
        wish["entry_label"] = labels._number(entry_label, "entry_label")
    if needle is not None:
        wish["needle_diameter"], wish["needle_length"] = pair(needle, "needle")
        if not wish["needle_diameter"] or not wish["needle_length"]:
            raise InvalidArgumentError(f"needle is {needle!r}; its diameter and its length must be above 0 mm")
    if entry_radius is not None:
        wish["entry_radius"] = number(entry_radius, "entry_radius")
        if not wish["entry_radius"]:
            raise InvalidArgumentError("the entry radius 0 mm is not a number above 0.001 mm")
    if max_length is not None:
        wish["max_length"] = not_zero(number(max_length, "max_length"), "plan", "max_length")
    if max_angle is not None:
        wish.update(max_angle=number(max_angle, "max_angle"), limit_angle=1)
    if mesh is not None and tip is not None and axis is not None:
        if not isinstance(mesh, Mesh):
            raise TypeError(f"mesh is a {type(mesh).__name__}; voxtact.read_mesh() makes a voxtact.Mesh of it")
        held = vector(numbers(axis, "axis"), "axis")
        if not any(held):
            raise InvalidArgumentError("axis is 0,0,0; it must point from the tip to the handle of the instrument")
        wish.update(mesh=mesh._core.on_host, mesh_tip=vector(numbers(tip, "tip"), "tip"), mesh_axis=held)
    return wish


def _paths_of(rows: npt.NDArray[np.void], first: int) -> npt.NDArray[np.void]:
    """Converts the rows of paths. first: kind of the first obstacle, 0 labels, 1 the opaque region."""
    found = np.zeros(len(rows), _PATH)
    none = rows["near"] == 0
    for name, column in (("entry", "entry"), ("position", "position"), ("length", "length"), ("angle", "angle"),
                         ("safety", "safe"), ("lower", "lower"), ("upper", "upper"), ("end", "end")):
        found[name] = rows[column]
    found["obstacle"] = np.where(none, -1, rows["obstacle"].astype(np.int32) + first)
    found["label"] = np.where(none, 0, rows["label"])
    for name in ("nearest", "on_path"):
        found[name] = np.where(none[:, None], np.nan, rows[name])
    return found


class Plan:
    """The answer of `Scene.plan`: a row for each path, in the order of the directions."""

    __slots__ = ("_tables", "_paths", "_names", "_with_distances")
    _tables: Tables
    _paths: npt.NDArray[np.void]
    _names: dict[int, str]
    _with_distances: bool

    def __init__(self, made_of: Tables, labels: Optional[Labels], avoids_labels: bool, with_distances: bool) -> None:
        check_made(made_of, Tables, "Scene.plan()")
        self._tables = made_of
        self._paths = _paths_of(made_of.rows("paths"), 0 if avoids_labels else 1)
        self._names = {} if labels is None else labels.names
        self._with_distances = with_distances

    @property
    def safe(self) -> npt.NDArray[np.bool_]:
        """(N,): the path certainly keeps the margin from all obstacles."""
        found: npt.NDArray[np.bool_] = self.paths["safety"] == _SAFE
        return found

    @property
    def undecided(self) -> npt.NDArray[np.bool_]:
        """(N,): the path is undecided."""
        found: npt.NDArray[np.bool_] = self.paths["safety"] == _UNDECIDED
        return found

    @property
    def distance(self) -> npt.NDArray[np.float64]:
        """(N,2): lower and upper bound of the distance of each path, mm; 0 if it touches, infinite beyond `max`."""
        return np.stack([self.paths["lower"], self.paths["upper"]], axis=1)

    @property
    def entries(self) -> npt.NDArray[np.float64]:
        """(N,3): the entry points, LPS, mm."""
        at: npt.NDArray[np.float64] = self.paths["position"]
        return at

    @property
    def paths(self) -> npt.NDArray[np.void]:
        """(N,): the rows of all paths.

        `entry`, the index of its direction; `position` (3) of the entry, LPS, mm; `length`, mm; `angle`, degrees to the
        normal of the entry surface, NaN without a normal; `safety`, 0 unsafe, 1 safe, 2 undecided; `lower`, `upper`,
        `end` as in `Distance`; `obstacle`, 0 labels, 1 the opaque region, -1 none within `max`; `nearest` (3), the
        nearest point of the obstacle, and its `label`; `on_path` (3), the nearest point of the needle's axis or of the
        mesh.
        """
        return self._paths

    @property
    def best(self) -> Optional[int]:
        """The index of the safe path with the largest distance; of equal ones the shortest; None: no path is safe."""
        rows = np.flatnonzero(self.safe)
        if not rows.size:
            return None
        order = np.lexsort((self.paths["length"][rows], -self.paths["lower"][rows]))
        return int(rows[order[0]])

    @property
    def triangles(self) -> npt.NDArray[np.uint32]:
        """(T,3): indices of neighbouring paths, outward counter-clockwise: the triangles of the entry surface."""
        return np.asarray(self._tables.rows("triangles")["paths"])

    @property
    def triangle_safe(self) -> npt.NDArray[np.bool_]:
        """(T,): *every* path from any point of the triangle is safe. Always False for a mesh, whose paths are decided
        one by one."""
        found: npt.NDArray[np.bool_] = self._tables.rows("triangles")["safe"] == 1
        return found

    @property
    def triangle_distance(self) -> npt.NDArray[np.float64]:
        """(T,): lower bound of the distance of *every* path from the triangle, mm, up to `max`.

        NotReadyError without triangle_distances=True.
        """
        if not self._with_distances:
            raise NotReadyError("the plan was made without triangle_distances=True; plan again with it")
        return np.asarray(self._tables.rows("triangles")["distance"])

    @property
    def area(self) -> float:
        """Area of all triangles, mm²."""
        return self._tables.total("area")

    @property
    def safe_area(self) -> float:
        """Area of the safe triangles, mm²."""
        return self._tables.total("safe_area")

    @property
    def left_out(self) -> dict[str, int]:
        """Number of directions without a path, by reason: "no_surface", "on_border", "too_long", "too_oblique"."""
        return {name: int(self._tables.total(name)) for name in ("no_surface", "on_border", "too_long", "too_oblique")}

    @property
    def seconds(self) -> float:
        """Duration in the engine."""
        return self._tables.milliseconds / 1000

    def nearest_name(self, row: int) -> str:
        """Returns the nearest obstacle of a path: a label's name or number, "opaque", or "" for none."""
        path = self.paths[range(len(self))[operator.index(row)]]
        if path["obstacle"] < 0:
            return ""
        if path["obstacle"] == 1:
            return "opaque"
        label = int(path["label"])
        return self._names.get(label, str(label))

    def __len__(self) -> int:
        return len(self._paths)

    def __repr__(self) -> str:
        undecided = int(self.undecided.sum())
        more = f", {undecided} undecided" if undecided else ""
        best = self.best
        what = "" if best is None else f"; the best keeps {self.paths['lower'][best]:.4g} mm"
        return f"<voxtact.Plan: {int(self.safe.sum())} of {len(self)} paths are safe{more}{what}>"

    def __bool__(self) -> NoReturn:
        no_truth(self, ".safe, or .safe.any()")

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (Plan, {"_tables": self._tables, "_paths": self._paths, "_names": dict(self._names),
                                 "_with_distances": self._with_distances})
