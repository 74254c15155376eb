# SPDX-License-Identifier: MIT
"""Straight paths to a target, and what is certain of them."""
from __future__ import annotations

import operator
from typing import NoReturn, Optional

import numpy as np
import numpy.typing as npt

from . import _core as core
from ._common import check_made, not_pickled
from ._errors import NotReadyError
from ._labels import Labels

_UNSAFE, _SAFE, _POSSIBLE = range(3)


class Plan:
    """What `Scene.plan` found: a row for each path, in the order of the directions."""

    __slots__ = ("_core", "_labels", "_with_clearances")
    _core: core.Plan
    _labels: Optional[Labels]
    _with_clearances: bool

    def __init__(self, made_of: core.Plan, labels: Optional[Labels], with_clearances: bool) -> None:
        check_made(made_of, core.Plan, "Scene.plan()")
        self._core = made_of
        self._labels = labels
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
        names = {} if self._labels is None else self._labels.names
        return names.get(label, str(label))

    def __len__(self) -> int:
        return len(self._core)

    def __repr__(self) -> str:
        possible = int(self.possible.sum())
        more = f", {possible} possibly" if possible else ""
        best = self.best
        what = "" if best is None else f"; the best keeps {self.paths['lo'][best]:.4g} mm"
        return f"<voxtact.Plan: {int(self.safe.sum())} of {len(self)} paths are safe{more}{what}>"

    def __reduce__(self) -> NoReturn:
        not_pickled(self)
