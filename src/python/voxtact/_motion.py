# SPDX-License-Identifier: MIT
"""Motions between poses, and what scenes answer about them."""
from __future__ import annotations

from typing import Any, Literal, NoReturn, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core as core
from ._common import Kept, check_made, encoded_text, members_of, no_truth, numbers, restored
from ._errors import InvalidArgumentError
from ._mesh import Mesh

#: "screw": about and along one axis. "slerp": the middle of the mesh's box goes straight, and the mesh turns about it.
Interpolation = Literal["screw", "slerp"]

_MEMBERS = ("hit", "possible", "free_until", "end", "touches", "item", "pose", "milliseconds")
_ENDS = np.array(["decided", "grazes", "budget"])


def pose_between(first: npt.ArrayLike, second: npt.ArrayLike, at: npt.ArrayLike, *,
                 interpolation: Interpolation = "screw", mesh: Optional[Mesh] = None) -> npt.NDArray[np.float64]:
    """The pose at a parameter from 0 (the first pose) to 1 (the second) of the motion that `Scene.motion` checks.

    at
        a number, for a (4,4); or (T,), for (T,4,4)
    mesh
        what moves: "slerp" needs the middle of its box

    Refuses parameters outside of 0 to 1, and two poses that no rigid motion joins: another scale, a mirror image.
    """
    parameters = numbers(at, "at")
    if parameters.ndim > 1:
        raise InvalidArgumentError(f"at has the shape {parameters.shape}; a number or (T,) is needed")
    if interpolation == "slerp" and not isinstance(mesh, Mesh):
        raise InvalidArgumentError("slerp needs mesh=, a voxtact.Mesh: the middle of its box goes straight")
    if mesh is not None and not isinstance(mesh, Mesh):
        raise TypeError(f"mesh is a {type(mesh).__name__}; voxtact.read_mesh() makes a voxtact.Mesh of it")
    centre = np.zeros(3) if mesh is None else np.mean(mesh.bounds, axis=0)
    poses = core.poses_between(numbers(first, "first"), numbers(second, "second"),
                               parameters.reshape(-1), encoded_text(interpolation, "interpolation"), centre)
    if parameters.ndim:
        return poses
    only: npt.NDArray[np.float64] = poses[0]
    return only


class Motion:
    """What `Scene.motion` found: a row for each segment, the way from one pose to the next, in order.

    A mesh of N poses has N - 1 of them. Of each the pose at a parameter from 0 to 1 is `pose_between`.
    """

    __slots__ = ("_core",)
    _core: Union[core.Motions, Kept]

    def __init__(self, made_of: core.Motions) -> None:
        check_made(made_of, core.Motions, "Scene.motion()")
        self._core = made_of

    @property
    def hit(self) -> npt.NDArray[np.bool_]:
        """(S,): it certainly touches at some pose on the way."""
        return self._core.hit

    @property
    def possible(self) -> npt.NDArray[np.bool_]:
        """(S,): neither a touch nor that there is none could be shown. Where neither this nor `hit`, all of it is free."""
        return self._core.possible

    @property
    def free_until(self) -> npt.NDArray[np.float64]:
        """(S,): certainly nothing touches from 0 to this parameter; 1: all of the segment is free."""
        return self._core.free_until

    @property
    def touch_at(self) -> npt.NDArray[np.float64]:
        """(S,): a parameter at which it certainly touches, the earliest that was found; NaN where there is none."""
        at: npt.NDArray[np.float64] = self._core.touches["at"]
        return at

    @property
    def touches(self) -> npt.NDArray[np.void]:
        """(S,): the touch of each segment. `triangle` is -1 where there is none, and the rest is then NaN (`label` 0).

        `at`, the parameter; `triangle`, its number in the mesh; `position` (3), LPS, mm, on the triangle and opaque;
        `label` there, 0 without a label map; `world_from_object` (4,4), the pose.
        """
        return self._core.touches

    @property
    def end(self) -> npt.NDArray[np.str_]:
        """Why no more is said.

        "decided": it is free, or it moves no more than the resolution from `free_until` to `touch_at`. "grazes":
        somewhere it is so near that within the resolution neither is shown. "budget": `most_steps`.
        """
        names: npt.NDArray[np.str_] = _ENDS[self._core.end]
        return names

    @property
    def item(self) -> npt.NDArray[np.uint32]:
        """(S,): the number of the mesh in the list that was given; 0 for a single one."""
        return self._core.item

    @property
    def pose(self) -> npt.NDArray[np.uint32]:
        """(S,): the number, among those of its mesh, of the pose that the segment begins with."""
        return self._core.pose

    @property
    def seconds(self) -> float:
        """What the engine took."""
        return self._core.milliseconds / 1000

    def plot(self, ax: Any = None) -> Any:
        """What is free of each segment, with matplotlib; the axes. Touches are red, what is possible is hollow."""
        from ._plot import plot_motion

        return plot_motion(self, ax)

    def __len__(self) -> int:
        return len(self._core)

    def __repr__(self) -> str:
        hits, possible = int(self.hit.sum()), int(self.possible.sum())
        more = f", {possible} possibly" if possible else ""
        first = f"; the first in segment {int(np.argmax(self.hit))}" if hits else ""
        return f"<voxtact.Motion: {hits} of {len(self)} segments touch{more}{first}>"

    def __bool__(self) -> NoReturn:
        no_truth(self, ".hit, or .hit.any()")

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (Motion, {"_core": Kept(len(self), members_of(self._core, _MEMBERS))})
