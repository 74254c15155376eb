# SPDX-License-Identifier: MIT
"""Questions that only the host engine answers: distance, area, overlap, motion, and any other by its name."""
from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, Literal, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _engine as core
from ._answer import Answer, Area, Distance, Overlap
from ._arguments import Poses, Progress, asked, pairs_in, segments_in, told
from ._common import encoded_text, listed, number, numbers, whole_number
from ._errors import InvalidArgumentError
from ._labels import Labels
from ._library import FACTS, lib, standard
from ._mesh import Mesh
from ._motion import Interpolation, Motion
from ._tables import Tables
from ._track import Tracker
from ._volume import Volume

#: voxels: resolution of the touch
RESOLUTION = 1 / 64
INFINITE = float("inf")
#: maximum number of labels in a warning
_MAX_NAMED = 10


def _filled(meshes: Any) -> Any:
    """Returns the meshes with their holes filled; warns about the added area."""
    single = not isinstance(meshes, list)
    closed: list[Any] = []
    for mesh, poses in [(meshes, None)] if single else meshes:
        one, area = mesh.filled()
        if area > 0:
            warnings.warn(f"{mesh.name}: holes filled, area added: {area:.4g} mm²", stacklevel=4)
        closed.append((one, poses))
    return closed[0][0] if single else closed


class Measuring:
    """Questions of a scene about distances, areas, overlaps and motions."""

    __slots__ = ()
    _core: core.Scene
    _volume: Volume
    _labels: Optional[Labels]

    def ask(self, question: str, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *,
            progress: Progress = None, **settings: Any) -> Answer:
        """Answers any question of the library by its name: an `Answer`, whose tables are the library's.

            scene.ask("distance", knife, poses, tolerance=0.1)["pairs"]["lower"]

        question
            a name in `questions()`
        settings
            names in `settings(question)`; None: the default. Labels are numbers, names, or True (all but 0)

        The host engine answers, also for scenes on a device. The camera of counts looks from above.
        """
        return Answer(self._tables(question, mesh, poses, progress, settings))

    def _setting(self, question: str, name: str, value: Any) -> Any:
        """Converts a value by the kind of its setting; the library refuses unknown settings."""
        fact = FACTS.get((question, name))
        if fact is None:
            return 0.0
        if fact.kind == "labels":
            return self._wanted_labels(value)
        if fact.kind == "numbers":
            given = numbers(value, name)
            if given.ndim != 1 or not given.size:
                raise InvalidArgumentError(f"{name} have the shape {given.shape}; (B,) is needed, with at least one value")
            return given.tolist()
        if fact.kind == "choice":
            encoded_text(value, name)
            return value
        if fact.kind == "flag" and isinstance(value, (bool, np.bool_)):
            return bool(value)
        return whole_number(value, name, int(fact.min), int(fact.max)) if fact.kind == "whole" else number(value, name)

    def _tables(self, question: str, mesh: Any, poses: Any, progress: Progress, settings: dict[str, Any],
                fill_holes: bool = False) -> Tables:
        given = {name: self._setting(question, name, value) for name, value in settings.items() if value is not None}
        meshes, matrices = asked(mesh, poses, self._volume, 4)
        if fill_holes:
            meshes = _filled(meshes)
        with told(progress, (segments_in if question == "motion" else pairs_in)(meshes, matrices)) as tell:
            return self._core.ask(question, meshes, matrices, given, tell)

    def distance(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *,
                  tolerance: float = standard("distance", "tolerance"), max: float = INFINITE,
                  labels: Union[None, Literal[True], Sequence[Union[int, str]]] = None, any_opacity: bool = False,
                  solid: bool = False, max_steps: int = standard("distance", "max_steps"), progress: Progress = None) -> Distance:
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
        return Distance(self._tables("distance", mesh, poses, progress, {
            "tolerance": tolerance, "max": max, "labels": wanted, "any_opacity": any_opacity, "solid": solid,
            "max_steps": max_steps}), wanted)

    def area(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *,
             tolerance: float = standard("area", "tolerance"),
             labels: Union[None, Literal[True], Sequence[Union[int, str]]] = None, triangles: bool = False,
             max_steps: int = standard("area", "max_steps"), progress: Progress = None) -> Area:
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
        return Area(self._tables("area", mesh, poses, progress, {
            "tolerance": tolerance, "labels": wanted, "triangles": triangles, "max_steps": max_steps}), wanted, bool(triangles))

    def overlap(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *,
                tolerance: Optional[float] = standard("overlap", "tolerance"), bands: Optional[npt.ArrayLike] = None,
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
        limits = None if bands is None else self._setting("overlap", "bands", bands)
        wanted = self._wanted_labels(labels, "overlaps with")
        return Overlap(self._tables("overlap", mesh, poses, progress, {
            "tolerance": tolerance, "bands": limits, "labels": wanted, "max_steps": max_steps}, fill_holes), wanted, limits)

    def tracker(self, mesh: Mesh, *, max: float = INFINITE, resolution: float = RESOLUTION,
                max_steps: int = lib.VXT_DEFAULT_TRACKER_STEPS) -> Tracker:
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
               interpolation: Interpolation = "screw", resolution: float = standard("motion", "resolution"),
               max_steps: int = standard("motion", "max_steps"), progress: Progress = None) -> Motion:
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
        return Motion(self._tables("motion", mesh, poses, progress, {
            "interpolation": interpolation, "resolution": resolution, "max_steps": max_steps}),
                      None if self._labels is None else self._labels._core)

    def _wanted_labels(self, labels: Union[None, Literal[True], Sequence[Union[int, str]]], what: str = "") -> Optional[list[int]]:
        """Returns the labels by number; warns of those without voxels, if `what` is measured of them."""
        if labels is None:
            return None
        if self._labels is None:
            raise InvalidArgumentError(f"{what} labels need a scene with labels=".lstrip())
        every = [int(label) for label in self._labels.values if label != 0]
        wanted = every if labels is True else [self._labels._number(label, "a label") for label in listed(labels, "labels")]
        if what and (absent := sorted(set(wanted).difference(every, (0,)))):
            outcome = "infinite" if what == "distances to" else "0"
            more = f" and {len(absent) - _MAX_NAMED} more" if len(absent) > _MAX_NAMED else ""
            warnings.warn(f"labels: no voxel of the label map has the label{'s' if len(absent) > 1 else ''} "
                          f"{', '.join(map(str, absent[:_MAX_NAMED]))}{more}; {what} {'them' if len(absent) > 1 else 'it'} are {outcome}",
                          stacklevel=3)
        return wanted
