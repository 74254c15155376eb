# SPDX-License-Identifier: MIT
"""What scenes are asked in addition to whether meshes touch: how near, how much, on the way."""
from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Literal, Optional, Union

from . import _core as core
from ._answer import Answer, Area, Clearance
from ._arguments import Poses, Progress, asked, pairs_in, segments_in, told
from ._common import encoded_text, listed, number, whole_number
from ._errors import InvalidArgumentError
from ._labels import Labels
from ._mesh import Mesh
from ._motion import Interpolation, Motion
from ._track import Tracker

#: of the touch, voxels
RESOLUTION = 1 / 64
INFINITE = float("inf")
#: labels that a warning lists
_MOST_NAMED = 10


def _check_method(method: str, what: str) -> None:
    if method not in ("cpu", "compute"):
        raise InvalidArgumentError(f"method is {method!r}; {what} by 'cpu' or by 'compute'")


class Measuring:
    """A scene's questions about distances, areas and motions."""

    __slots__ = ()
    _core: core.Scene
    _labels: Optional[Labels]

    def clearance(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *,
                  tolerance: float = core.DEFAULT_TOLERANCE, maximum: float = INFINITE,
                  labels: Union[None, Literal[True], Sequence[Union[int, str]]] = None, labels_at_any_opacity: bool = False,
                  most_steps: int = core.DEFAULT_MOST_STEPS, method: Literal["cpu", "compute"] = "cpu",
                  progress: Progress = None) -> Clearance:
        """How many mm are left between the mesh's surface and what is opaque: certified bounds for each pose.

        tolerance
            mm, from 1e-6 on: how near to each other the bounds are brought
        maximum
            mm: what is farther is not measured; `lo` is then the maximum, and `hi` infinite
        labels
            measures to the opaque part of each of these labels, by number or name, instead (True: all but 0): a column for each. The
            scene's label map must be on its volume's grid. Clearances to a label that no voxel has are infinite; that is warned of
        labels_at_any_opacity
            to all of each label, be it opaque or not
        most_steps
            a pose that takes more is left with the bounds that it has
        method
            "cpu": the host engine measures, also for scenes on a device; "compute": that device does, in single precision and without
            `most_steps`; its closest points are no farther apart than `hi`
        """
        _check_method(method, "a clearance is measured")
        by_device = method == "compute"
        if by_device and most_steps != core.DEFAULT_MOST_STEPS:
            raise InvalidArgumentError("most_steps is about the host's search: leave it out, or method='compute'")
        wanted = self._wanted_labels(labels, "clearances to")
        if wanted is None and labels_at_any_opacity:
            raise InvalidArgumentError("labels_at_any_opacity is about labels: give labels=, too")
        steps = whole_number(most_steps, "most_steps", 1)
        meshes, matrices = asked(mesh, poses)
        with told(progress, pairs_in(meshes, matrices)) as tell:
            if by_device:
                return Clearance(self._core.clearance_by_device(meshes, matrices, number(tolerance, "tolerance"), number(maximum, "maximum"),
                                                                wanted, bool(labels_at_any_opacity), tell))
            return Clearance(self._core.clearance(meshes, matrices, number(tolerance, "tolerance"), number(maximum, "maximum"), steps, wanted,
                                                  bool(labels_at_any_opacity), tell))

    def area(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *,
             tolerance: float = core.DEFAULT_AREA_TOLERANCE,
             labels: Union[None, Literal[True], Sequence[Union[int, str]]] = None, triangles: bool = False,
             most_steps: int = core.DEFAULT_AREA_STEPS, progress: Progress = None) -> Area:
        """How many mm^2 of the mesh's surface are in what is opaque: certified bounds for each pose.

        tolerance
            mm^2, from 1e-9 on: how near to each other the bounds are brought
        labels
            measures in the opaque part of each of these labels, by number or name, instead (True: all but 0): a column for each. The
            scene's label map must be on its volume's grid. Areas in a label that no voxel has are 0; that is warned of
        triangles
            what each triangle has of it, too: `Area.triangles`. Not with labels
        most_steps
            a pose, or a label of one, that takes more is left with the bounds that it has

        The host engine measures, also for scenes on a device.
        """
        if triangles and labels is not None:
            raise InvalidArgumentError("areas are measured in labels or of triangles, not both at once")
        wanted = self._wanted_labels(labels, "areas in")
        steps = whole_number(most_steps, "most_steps", 1)
        meshes, matrices = asked(mesh, poses)
        with told(progress, pairs_in(meshes, matrices)) as tell:
            return Area(self._core.area(meshes, matrices, number(tolerance, "tolerance"), steps, wanted, bool(triangles), tell))

    def within(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *, margin: float,
               method: Literal["cpu", "compute"] = "cpu", progress: Progress = None) -> Answer:
        """Whether something opaque is within `margin` mm of the mesh's surface: an `Answer` with `hit` and `possible`.

        Faster than `clearance`. A margin of 0 is the touch. The host engine measures, also for scenes on a device;
        with `method="compute"` that device does, where `possible` is a little more frequent.
        """
        _check_method(method, "a margin is decided")
        meshes, matrices = asked(mesh, poses)
        with told(progress, pairs_in(meshes, matrices)) as tell:
            return Answer(self._core.within(meshes, matrices, number(margin, "margin"), method == "compute", tell), None)

    def around(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *, distance: float,
               angle: float, method: Literal["cpu", "compute"] = "cpu", progress: Progress = None) -> Answer:
        """Whether poses are safe that may be off: an `Answer` with `hit` and `possible`.

        Of each pose: whether anything touches at *some* pose that is turned by no more than `angle` degrees (0 to 180)
        about any axis through the object's origin, and then moved by no more than `distance` mm in any direction. Where
        neither `hit` nor `possible`, nothing does at any of them. The host engine decides, also for scenes on a device;
        with `method="compute"` that device does, where `possible` is a little more frequent.
        """
        _check_method(method, "a pose tolerance is decided")
        meshes, matrices = asked(mesh, poses)
        with told(progress, pairs_in(meshes, matrices)) as tell:
            return Answer(self._core.around(meshes, matrices, number(distance, "distance"), number(angle, "angle"),
                                             method == "compute", tell), None)

    def tracker(self, mesh: Mesh, *, maximum: float = INFINITE, resolution: float = RESOLUTION,
                most_steps: int = core.DEFAULT_TRACKER_STEPS) -> Tracker:
        """A `Tracker` of a mesh that moves by little from call to call, as under a hand.

        maximum
            mm: farther than this is never looked
        resolution
            of the touch, voxels, as in `detect`
        most_steps
            of one search: then the bounds are what they are

        The host engine answers, also for scenes on a device.
        """
        if not isinstance(mesh, Mesh):
            raise TypeError(f"mesh is a {type(mesh).__name__}; voxtact.read_mesh() makes a voxtact.Mesh of it")
        steps = whole_number(most_steps, "most_steps", 1)
        return Tracker(core.Tracker(self._core, mesh._core, number(maximum, "maximum"), number(resolution, "resolution"), steps), mesh)

    def motion(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *,
               interpolation: Interpolation = "screw", resolution: float = core.DEFAULT_MOTION_RESOLUTION,
               most_steps: int = core.DEFAULT_MOTION_STEPS, method: Literal["cpu", "compute"] = "cpu",
               progress: Progress = None) -> Motion:
        """Whether anything touches on the way from each pose to the next, and where first: a `Motion`.

        Nothing is sampled: what is called free is free at all poses of the way.

        mesh, poses
            a mesh at poses, (N,4,4), N at least 2; or a list of (mesh, poses) alone
        interpolation
            "screw": about and along one axis. "slerp": the middle of the mesh's box goes straight, and the mesh turns
            about it. Both by no more than half a turn, at constant speed; near half a turn rounding may decide which way round
        resolution
            mm, from 1e-6 on: how far the mesh moves at most from the end of what is free to a touch
        most_steps
            a segment that takes more is left with what is known
        method
            "cpu": the host engine checks, also for scenes on a device; "compute": that device does, in single precision and without
            `most_steps`: a touch is found to some hundredths of a voxel
        progress
            is told of segments
        """
        _check_method(method, "a motion is checked")
        if method == "compute" and most_steps != core.DEFAULT_MOTION_STEPS:
            raise InvalidArgumentError("most_steps is about the host's search: leave it out, or method='compute'")
        steps = whole_number(most_steps, "most_steps", 1)
        meshes, matrices = asked(mesh, poses)
        with told(progress, segments_in(meshes, matrices)) as tell:
            return Motion(self._core.motion(meshes, matrices, encoded_text(interpolation, "interpolation"), number(resolution, "resolution"), steps,
                                            method == "compute", tell))

    def _wanted_labels(self, labels: Union[None, Literal[True], Sequence[Union[int, str]]], what: str) -> Optional[list[int]]:
        if labels is None:
            return None
        if self._labels is None:
            raise InvalidArgumentError(f"{what} labels need a scene with labels=")
        every = [int(label) for label in self._labels.values if label != 0]
        wanted = every if labels is True else [self._labels._number(label, "a label") for label in listed(labels, "labels")]
        if absent := sorted(set(wanted).difference(every, (0,))):
            outcome = "infinite" if what == "clearances to" else "0"
            more = f" and {len(absent) - _MOST_NAMED} more" if len(absent) > _MOST_NAMED else ""
            warnings.warn(f"labels: no voxel of the label map has the label{'s' if len(absent) > 1 else ''} "
                          f"{', '.join(map(str, absent[:_MOST_NAMED]))}{more}; {what} {'them' if len(absent) > 1 else 'it'} are {outcome}",
                          stacklevel=3)
        return wanted
