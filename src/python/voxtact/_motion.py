# SPDX-License-Identifier: MIT
"""Motions between poses, and their answers."""
from __future__ import annotations

from typing import Any, Literal, NoReturn, Optional

import numpy as np
import numpy.typing as npt

from ._common import check_made, no_truth, numbers, restored
from ._engine import poses_between
from ._errors import InvalidArgumentError
from ._handles import Labels
from ._mesh import Mesh
from ._tables import UNDECIDED, YES, Tables

#: "screw": along and about one axis. "slerp": the centre of the mesh's box moves straight; the mesh rotates about it.
Interpolation = Literal["screw", "slerp"]

_ENDS = np.array(["decided", "grazes", "budget"])
_TOUCH = np.dtype([("at", np.float64), ("triangle", np.int64), ("position", np.float64, 3), ("label", np.int32),
                   ("world_from_object", np.float64, (4, 4))], align=True)


def pose_between(first: npt.ArrayLike, second: npt.ArrayLike, at: npt.ArrayLike, *,
                 interpolation: Interpolation = "screw", mesh: Optional[Mesh] = None) -> npt.NDArray[np.float64]:
    """Returns the pose at a parameter from 0 (the first pose) to 1 (the second) of the motion that `Scene.motion` checks.

    at
        a number, which returns (4,4); or (T,), which returns (T,4,4)
    mesh
        the moving mesh: "slerp" needs the centre of its box

    Refuses parameters outside 0 to 1, and two poses without a rigid motion between them: another scale, a mirror image.
    """
    parameters = numbers(at, "at")
    if parameters.ndim > 1:
        raise InvalidArgumentError(f"at has the shape {parameters.shape}; a number or (T,) is needed")
    if interpolation == "slerp" and not isinstance(mesh, Mesh):
        raise InvalidArgumentError("slerp needs mesh=, a voxtact.Mesh: the middle of its box goes straight")
    if mesh is not None and not isinstance(mesh, Mesh):
        raise TypeError(f"mesh is a {type(mesh).__name__}; voxtact.read_mesh() makes a voxtact.Mesh of it")
    centre = np.zeros(3) if mesh is None else np.mean(mesh.bounds, axis=0)
    poses = poses_between(numbers(first, "first"), numbers(second, "second"), parameters.reshape(-1), interpolation, centre)
    if parameters.ndim:
        return poses
    only: npt.NDArray[np.float64] = poses[0]
    return only


class Motion:
    """The answer of `Scene.motion`: a row for each segment from one pose to the next, in order.

    A mesh with N poses has N - 1 segments. `pose_between` returns the pose at a parameter from 0 to 1.
    """

    __slots__ = ("_tables", "_labels", "_impacts")
    _tables: Tables
    _labels: Optional[Labels]
    _impacts: Optional[npt.NDArray[np.void]]

    def __init__(self, made_of: Tables, labels: Optional[Labels]) -> None:
        check_made(made_of, Tables, "Scene.motion()")
        self._tables = made_of
        self._labels = labels
        self._impacts = None

    @property
    def touches(self) -> npt.NDArray[np.bool_]:
        """(S,): the mesh certainly touches on the way."""
        return self._tables.touch_is(YES)

    @property
    def undecided(self) -> npt.NDArray[np.bool_]:
        """(S,): undecided. Neither `touches` nor `undecided`: collision-free."""
        return self._tables.touch_is(UNDECIDED)

    @property
    def toi_lower(self) -> npt.NDArray[np.float64]:
        """(S,): collision-free from 0 to this parameter; 1: the whole segment."""
        return np.asarray(self._tables.rows("segments")["toi_lower"])

    @property
    def toi_upper(self) -> npt.NDArray[np.float64]:
        """(S,): certainly touching at this parameter, the earliest found; NaN: none."""
        return np.asarray(self._tables.rows("segments")["toi_upper"])

    @property
    def impacts(self) -> npt.NDArray[np.void]:
        """(S,): the touch at `toi_upper`. Without one `triangle` is -1, `label` 0 and the rest NaN.

        `at`, the parameter; `triangle`, its index in the mesh; `position` (3), LPS, mm, on the triangle and opaque;
        `label` there, 0 without a label map; `world_from_object` (4,4), the pose.
        """
        if self._impacts is None:
            rows, hit = self._tables.rows("segments"), self.touches
            found = np.zeros(len(rows), _TOUCH)
            found["at"] = rows["toi_upper"]
            found["triangle"] = np.where(hit, rows["triangle"].astype(np.int64), -1)
            found["position"] = np.where(hit[:, None], rows["point"], np.nan)
            poses = rows["world_from_object"].reshape(-1, 4, 4).transpose(0, 2, 1)
            found["world_from_object"] = np.where(hit[:, None, None], poses, np.nan)
            if self._labels is not None:
                found["label"][hit] = self._labels.at(rows["point"][hit])
            self._impacts = found
        return self._impacts

    @property
    def end(self) -> npt.NDArray[np.str_]:
        """Why the search ended.

        "decided": collision-free, or the mesh moves at most the resolution from `toi_lower` to `toi_upper`. "grazes":
        too near to decide within the resolution. "budget": `max_steps`.
        """
        names: npt.NDArray[np.str_] = _ENDS[self._tables.rows("segments")["end"]]
        return names

    @property
    def item(self) -> npt.NDArray[np.uint32]:
        """(S,): index of the mesh in the given list; 0 for a single mesh."""
        return self._tables.item()

    @property
    def pose(self) -> npt.NDArray[np.uint32]:
        """(S,): index, among those of its mesh, of the segment's first pose."""
        return self._tables.pose()

    @property
    def seconds(self) -> float:
        """Duration in the engine."""
        return self._tables.milliseconds / 1000

    def plot(self, ax: Any = None) -> Any:
        """Plots the collision-free part of each segment with matplotlib; returns the axes. Red: touches; hollow: undecided."""
        from ._plot import plot_motion

        return plot_motion(self, ax)

    def __len__(self) -> int:
        return len(self._tables)

    def __repr__(self) -> str:
        hits, undecided = int(self.touches.sum()), int(self.undecided.sum())
        more = f", {undecided} undecided" if undecided else ""
        first = f"; the first in segment {int(np.argmax(self.touches))}" if hits else ""
        return f"<voxtact.Motion: {hits} of {len(self)} segments touch{more}{first}>"

    def __bool__(self) -> NoReturn:
        no_truth(self, ".touches, or .touches.any()")

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (Motion, {"_tables": self._tables, "_labels": None, "_impacts": self.impacts})
