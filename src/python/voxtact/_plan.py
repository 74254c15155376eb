# SPDX-License-Identifier: MIT
"""Straight paths to a target, and what is certain of them."""
from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import Any, NoReturn, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core as core
from ._arguments import Opacity, pair
from ._common import Kept, check_made, listed, members_of, no_truth, number, numbers, restored, whole_number
from ._errors import InvalidArgumentError, NotReadyError
from ._labels import Labels
from ._mesh import Mesh

_MEMBERS = ("paths", "triangles", "safe", "triangle_clearance", "area", "safe_area", "no_surface", "on_border", "too_long",
            "too_oblique", "milliseconds")
_UNSAFE, _SAFE, _POSSIBLE = range(3)


def plan_options(labels: Optional[Labels], *, avoid: Sequence[Union[int, str]], avoid_opacity: Opacity, avoid_volume: Any,
                 needle: Optional[tuple[float, float]], mesh: Optional[Mesh], tip: Optional[npt.ArrayLike],
                 axis: Optional[npt.ArrayLike], entries: int, entry_label: Union[None, int, str],
                 entry_radius: Optional[float], border_entries: bool, margin: float, max_length: Optional[float],
                 max_angle: Optional[float], tolerance: float, maximum: float, most_steps: int,
                 triangle_clearances: bool) -> dict[str, Any]:
    """What `Scene.plan` asks the compiled part for; `labels` are the scene's."""
    avoided = listed(avoid, "avoid")
    if not avoided and avoid_opacity is None:
        raise InvalidArgumentError("avoid, avoid_opacity: one of them must say what is not to be touched")
    if avoid_volume is not None and avoid_opacity is None:
        raise InvalidArgumentError("avoid_volume needs avoid_opacity=: what of it is not to be touched")
    if labels is None and (avoided or entry_label is not None):
        raise InvalidArgumentError("plans that are about labels need a scene with labels=")
    if entry_label is not None and entry_radius is not None:
        raise InvalidArgumentError("entry_label and entry_radius both say where entries are; leave out one of them")
    if mesh is None and (tip is not None or axis is not None):
        raise InvalidArgumentError("tip and axis are of a mesh: give mesh=, too")
    if mesh is not None and (needle is not None or tip is None or axis is None):
        raise InvalidArgumentError("a mesh comes with tip= and axis=, and without needle=")
    wish: dict[str, Any] = {"entries": whole_number(entries, "entries", 1, core.MOST_ENTRIES),
                               "margin": number(margin, "margin"),
                               "tolerance": number(tolerance, "tolerance"), "maximum": number(maximum, "maximum"),
                               "most_steps": whole_number(most_steps, "most_steps", 1)}
    if triangle_clearances:
        wish["triangle_clearances"] = True
    if labels is not None:
        wish["avoid"] = [labels._number(label, "a label of avoid") for label in avoided]
    if entry_label is not None and labels is not None:
        wish["entry_label"] = labels._number(entry_label, "entry_label")
    wish["border_entries"] = bool(border_entries)
    if needle is not None:
        wish["needle"] = pair(needle, "needle")
    given = {"entry_radius": entry_radius, "max_length": max_length, "max_angle": max_angle}
    wish.update({name: number(value, name) for name, value in given.items() if value is not None})
    if mesh is not None and tip is not None and axis is not None:
        if not isinstance(mesh, Mesh):
            raise TypeError(f"mesh is a {type(mesh).__name__}; voxtact.read_mesh() makes a voxtact.Mesh of it")
        wish.update(mesh=mesh._core, tip=numbers(tip, "tip"), axis=numbers(axis, "axis"))
    return wish


class Plan:
    """What `Scene.plan` found: a row for each path, in the order of the directions."""

    __slots__ = ("_core", "_names", "_with_clearances")
    _core: Union[core.Plan, Kept]
    _names: dict[int, str]
    _with_clearances: bool

    def __init__(self, made_of: core.Plan, labels: Optional[Labels], with_clearances: bool) -> None:
        check_made(made_of, core.Plan, "Scene.plan()")
        self._core = made_of
        self._names = {} if labels is None else labels.names
        self._with_clearances = with_clearances

    @property
    def safe(self) -> npt.NDArray[np.bool_]:
        """(N,): it certainly keeps more than the margin from all that is to be avoided, all the way."""
        found: npt.NDArray[np.bool_] = self.paths["safety"] == _SAFE
        return found

    @property
    def possible(self) -> npt.NDArray[np.bool_]:
        """(N,): neither that nor the contrary could be shown."""
        found: npt.NDArray[np.bool_] = self.paths["safety"] == _POSSIBLE
        return found

    @property
    def clearance(self) -> npt.NDArray[np.float64]:
        """(N,2): how near each comes on its way is between these, mm; 0 where it touches, infinite beyond `maximum`."""
        return np.stack([self.paths["lo"], self.paths["hi"]], axis=1)

    @property
    def entries(self) -> npt.NDArray[np.float64]:
        """(N,3): where each begins, LPS, mm."""
        at: npt.NDArray[np.float64] = self.paths["position"]
        return at

    @property
    def paths(self) -> npt.NDArray[np.void]:
        """(N,): all that is known of each.

        `entry`, the number of its direction; `position` (3) of the entry, LPS, mm; `length`, mm; `angle`, degrees to the
        normal of the entries' surface, NaN where it has none; `safety`, 0 unsafe, 1 safe, 2 possible; `lo`, `hi`, `end`
        as in `Clearance`; `obstacle`, 0 labels, 1 what is opaque, -1 nothing within the maximum; `label` of what is
        nearest; `nearest` (3), a point of it; `on_path` (3), the nearest of the needle's axis or of the mesh.
        """
        return self._core.paths

    @property
    def best(self) -> Optional[int]:
        """The row of the safe path with the largest clearance, of several the shortest; None: no path is safe."""
        rows = np.flatnonzero(self.safe)
        if not rows.size:
            return None
        order = np.lexsort((self.paths["length"][rows], -self.paths["lo"][rows]))
        return int(rows[order[0]])

    @property
    def triangles(self) -> npt.NDArray[np.uint32]:
        """(T,3): rows of neighbouring paths, outward counter-clockwise: the surface that the entries are on."""
        return self._core.triangles

    @property
    def triangle_safe(self) -> npt.NDArray[np.bool_]:
        """(T,): *every* path from anywhere in the triangle is safe. Never so for a mesh, whose paths alone are decided."""
        return self._core.safe

    @property
    def triangle_clearance(self) -> npt.NDArray[np.float64]:
        """(T,): *every* path from anywhere in the triangle certainly keeps at least so much, mm, up to `maximum`.

        NotReadyError where the plan was made without triangle_clearances=True.
        """
        if not self._with_clearances:
            raise NotReadyError("the plan was made without triangle_clearances=True; plan again with it")
        return self._core.triangle_clearance

    @property
    def area(self) -> float:
        """Of all triangles, mm²."""
        return self._core.area

    @property
    def safe_area(self) -> float:
        """Of the safe ones, mm²."""
        return self._core.safe_area

    @property
    def left_out(self) -> dict[str, int]:
        """How many of the directions have no path, and why: "no_surface", "on_border", "too_long",
        "too_oblique"."""
        of = self._core
        return {"no_surface": of.no_surface, "on_border": of.on_border, "too_long": of.too_long, "too_oblique": of.too_oblique}

    @property
    def seconds(self) -> float:
        """What the engine took."""
        return self._core.milliseconds / 1000

    def nearest_name(self, row: int) -> str:
        """What a path comes nearest to: a label's name or number, "opaque", or "" where there is nothing."""
        path = self.paths[range(len(self))[operator.index(row)]]
        if path["obstacle"] < 0:
            return ""
        if path["obstacle"] == 1:
            return "opaque"
        label = int(path["label"])
        return self._names.get(label, str(label))

    def __len__(self) -> int:
        return len(self._core)

    def __repr__(self) -> str:
        possible = int(self.possible.sum())
        more = f", {possible} possibly" if possible else ""
        best = self.best
        what = "" if best is None else f"; the best keeps {self.paths['lo'][best]:.4g} mm"
        return f"<voxtact.Plan: {int(self.safe.sum())} of {len(self)} paths are safe{more}{what}>"

    def __bool__(self) -> NoReturn:
        no_truth(self, ".safe, or .safe.any()")

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (Plan, {"_core": Kept(len(self), members_of(self._core, _MEMBERS)), "_names": dict(self._names),
                                 "_with_clearances": self._with_clearances})
