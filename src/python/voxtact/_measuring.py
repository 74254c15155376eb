# SPDX-License-Identifier: MIT
"""Questions that only the host engine answers: distance, area, overlap, motion."""
from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, Literal, Optional, Union

import numpy.typing as npt

from . import _core as core
from ._answer import Area, Distance, Overlap
from ._arguments import Poses, Progress, asked, pairs_in, segments_in, told
from ._common import encoded_text, listed, number, numbers, whole_number
from ._errors import InvalidArgumentError
from ._labels import Labels
from ._mesh import Mesh
from ._motion import Interpolation, Motion
from ._track import Tracker
from ._volume import Volume

#: voxels: resolution of the touch
RESOLUTION = 1 / 64
INFINITE = float("inf")
#: maximum number of labels in a warning
_MAX_NAMED = 10


def _filled(meshes: Any) -> Any:
    """Returns the meshes with their holes filled; warns about the added area."""
    single = isinstance(meshes, core.Mesh)
    closed: list[Any] = []
    for mesh, poses in [(meshes, None)] if single else meshes:
        one, area = mesh.filled()
        if area > 0:
            warnings.warn(f"{mesh.name}: holes filled, area added: {area:.4g} mm²", stacklevel=3)
        closed.append((one, poses))
    return closed[0][0] if single else closed


class Measuring:
    """Questions of a scene about distances, areas, overlaps and motions."""

    __slots__ = ()
    _core: core.Scene
    _volume: Volume
    _labels: Optional[Labels]

    def distance(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *,
                  tolerance: float = core.DEFAULT_TOLERANCE, max: float = INFINITE,
                  labels: Union[None, Literal[True], Sequence[Union[int, str]]] = None, any_opacity: bool = False,
                  solid: bool = False, max_steps: int = core.DEFAULT_DISTANCE_STEPS, progress: Progress = None) -> Distance:
        """Measures the distance from the mesh's surface to the opaque region, mm: certified bounds for each pose.

        tolerance
            mm: stops when upper - lower is at most this
        max
            mm: stops when lower reaches this; `upper` is then infinite
        labels
            measures to the opaque part of each of these labels, by number or name (True: all but 0): a column for each.
            The scene's label map must be on its volume's grid. The distance to a label without voxels is infinite; a
            warning says so
        any_opacity
            measures to all of each label, opaque or not
        solid
            measures from the inside of the mesh, too: an enclosed opaque region is at distance 0. The mesh must be closed;
            not with labels
        max_steps
            iteration limit per pose

        The host engine measures, also for scenes on a device.
        """
        wanted = self._wanted_labels(labels, "distances to")
        if wanted is None and any_opacity:
            raise InvalidArgumentError("any_opacity is about labels: give labels=, too")
        steps = whole_number(max_steps, "max_steps", 1)
        meshes, matrices = asked(mesh, poses, self._volume)
        with told(progress, pairs_in(meshes, matrices)) as tell:
            return Distance(self._core.distance(meshes, matrices, number(tolerance, "tolerance"), number(max, "max"), steps, wanted,
                                                  bool(any_opacity), bool(solid), tell), wanted)

    def area(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *,
             tolerance: float = core.DEFAULT_AREA_TOLERANCE,
             labels: Union[None, Literal[True], Sequence[Union[int, str]]] = None, triangles: bool = False,
             max_steps: int = core.DEFAULT_AREA_STEPS, progress: Progress = None) -> Area:
        """Measures the area of the mesh's surface that is opaque, mm^2: certified bounds for each pose.

        tolerance
            mm^2: stops when upper - lower is at most this
        labels
            measures in the opaque part of each of these labels, by number or name (True: all but 0): a column for each.
            The scene's label map must be on its volume's grid. The area in a label without voxels is 0; a warning says so
        triangles
            measures each triangle, too: `Area.triangles`. Not with labels
        max_steps
            iteration limit per pose, and per label

        The host engine measures, also for scenes on a device.
        """
        if triangles and labels is not None:
            raise InvalidArgumentError("areas are measured in labels or of triangles, not both at once")
        wanted = self._wanted_labels(labels, "areas in")
        steps = whole_number(max_steps, "max_steps", 1)
        meshes, matrices = asked(mesh, poses, self._volume)
        with told(progress, pairs_in(meshes, matrices)) as tell:
            return Area(self._core.area(meshes, matrices, number(tolerance, "tolerance"), steps, wanted, bool(triangles), tell), wanted,
                        bool(triangles))

    def overlap(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *,
                tolerance: Optional[float] = core.DEFAULT_OVERLAP_TOLERANCE, bands: Optional[npt.ArrayLike] = None,
                labels: Union[None, Literal[True], Sequence[Union[int, str]]] = None, fill_holes: bool = False,
                max_steps: Optional[int] = None, progress: Progress = None) -> Overlap:
        """Measures the opaque volume inside the closed mesh, mm^3: an `Overlap` with certified bounds for each pose.

        tolerance
            mm^3: stops when upper - lower is at most this; None: the default
        bands
            ascending values, at most 64: measures the volume of each band: values below the first limit, between two
            limits, and from the last limit on, opaque or not: a column for each band
        labels
            measures the opaque part of each of these labels, by number or name (True: all but 0): a column for each. The
            scene's label map must be on its volume's grid
        fill_holes
            fills the holes of the mesh, each by a fan; a warning states the added area
        max_steps
            iteration limit per sum; None: the default

        A mesh with holes raises InvalidArgumentError. The host engine answers, also for scenes on a device.
        """
        if bands is not None and labels is not None:
            raise InvalidArgumentError("an overlap has bands= or labels=, not both")
        limits: Optional[list[float]] = None
        if bands is not None:
            given = numbers(bands, "bands")
            if given.ndim != 1 or not given.size:
                raise InvalidArgumentError(f"bands have the shape {given.shape}; (B,) is needed, with at least one value")
            limits = given.tolist()
        wanted = self._wanted_labels(labels, "overlaps with")
        steps = 0 if max_steps is None else whole_number(max_steps, "max_steps", 1)
        size = None if tolerance is None else number(tolerance, "tolerance")
        meshes, matrices = asked(mesh, poses, self._volume)
        if fill_holes:
            meshes = _filled(meshes)
        with told(progress, pairs_in(meshes, matrices)) as tell:
            return Overlap(self._core.overlap(meshes, matrices, size, steps, limits, wanted, tell), wanted, limits)

    def tracker(self, mesh: Mesh, *, max: float = INFINITE, resolution: float = RESOLUTION,
                max_steps: int = core.DEFAULT_TRACKER_STEPS) -> Tracker:
        """Creates a `Tracker` for a mesh that moves in small steps, as in haptics.

        max
            mm: search radius
        resolution
            voxels, as in `touch`
        max_steps
            iteration limit per search

        The host engine answers, also for scenes on a device.
        """
        if not isinstance(mesh, Mesh):
            raise TypeError(f"mesh is a {type(mesh).__name__}; voxtact.read_mesh() makes a voxtact.Mesh of it")
        steps = whole_number(max_steps, "max_steps", 1)
        return Tracker(core.Tracker(self._core, mesh._core, number(max, "max"), number(resolution, "resolution"), steps), mesh)

    def motion(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *,
               interpolation: Interpolation = "screw", resolution: float = core.DEFAULT_MOTION_RESOLUTION,
               max_steps: int = core.DEFAULT_MOTION_STEPS, progress: Progress = None) -> Motion:
        """Checks the motion from each pose to the next, and finds the first touch: a `Motion`.

        Continuous collision detection, without sampling: a collision-free segment is free at all of its poses.

        mesh, poses
            a mesh at poses, (N,4,4), N at least 2; or a list of (mesh, poses) alone
        interpolation
            "screw": along and about one axis. "slerp": the centre of the mesh's box moves straight, and the mesh rotates
            about it. Both by at most half a turn, at constant speed; near half a turn rounding may choose the side
        resolution
            mm: maximum motion of the mesh from `toi_lower` to `toi_upper`
        max_steps
            iteration limit per segment
        progress
            receives (segments done, all)

        The host engine checks, also for scenes on a device.
        """
        steps = whole_number(max_steps, "max_steps", 1)
        meshes, matrices = asked(mesh, poses, self._volume)
        with told(progress, segments_in(meshes, matrices)) as tell:
            return Motion(self._core.motion(meshes, matrices, encoded_text(interpolation, "interpolation"), number(resolution, "resolution"), steps,
                                            tell), None if self._labels is None else self._labels._core)

    def _wanted_labels(self, labels: Union[None, Literal[True], Sequence[Union[int, str]]], what: str) -> Optional[list[int]]:
        if labels is None:
            return None
        if self._labels is None:
            raise InvalidArgumentError(f"{what} labels need a scene with labels=")
        every = [int(label) for label in self._labels.values if label != 0]
        wanted = every if labels is True else [self._labels._number(label, "a label") for label in listed(labels, "labels")]
        if absent := sorted(set(wanted).difference(every, (0,))):
            outcome = "infinite" if what == "distances to" else "0"
            more = f" and {len(absent) - _MAX_NAMED} more" if len(absent) > _MAX_NAMED else ""
            warnings.warn(f"labels: no voxel of the label map has the label{'s' if len(absent) > 1 else ''} "
                          f"{', '.join(map(str, absent[:_MAX_NAMED]))}{more}; {what} {'them' if len(absent) > 1 else 'it'} are {outcome}",
                          stacklevel=3)
        return wanted
