# SPDX-License-Identifier: MIT
"""Scenes and trackers over the library: sends questions to the host or device part, in pieces.

Sizes and boxes are x, y, z; arrays of voxels are z, y, x.
"""
from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._common import encoded_text
from ._device_side import DeviceSide
from ._errors import InvalidArgumentError, NotReadyError
from ._handles import Device, Labels, Mesh, Volume
from ._host_side import FEW_TRIANGLES, HostSide, check_on_host
from ._library import CData, check, ffi, forks, lib, made, matrix, named, not_zero, pointer, refuse, struct, vector
from ._request import PROJECTIONS, HostQuestion, Opacity, Question, Request, TouchQuestion
from ._tables import Tables
from ._turns import Tell, Turns, in_pieces, in_turn
from ._wish import PictureWish

#: Maximum triangle tests of a first piece (some milliseconds), and its maximum number of poses, because one triangle
#: may pass through the whole volume. A device, which cannot be interrupted, gets fewer; the host gets at least one per
#: thread.
_FIRST_TRIANGLES = 2**20
_FIRST_ON_HOST = 64
_FIRST_ON_DEVICE = 8
_MAX_HOST_PAIRS = 2**20
#: Stack level of warnings: the caller of a method of the package.
_CALLER = 4
_MAX_QUESTIONS = 64

#: settings of a touch
TouchOptions = tuple[tuple[str, Any], ...]

INTERPOLATIONS = ("screw", "slerp")


def _first_piece(request: Request, cost: int, most: int) -> int:
    return int(max(min(_FIRST_TRIANGLES // (request.max_triangles * cost), most), 1))


def _is_curved(meshes: Any) -> bool:
    """Whether triangles stand for a curved surface, of which a device knows nothing."""
    return any(mesh.deflection for mesh in ([meshes] if type(meshes) is Mesh else [one[0] for one in meshes]))


def _check_threshold(threshold: float) -> None:
    if not 0 <= threshold <= 1:
        refuse(f"threshold is {threshold:g}; it must be from 0 to 1")


def _warn_of_opacity(volume: Volume, opacity: Opacity, threshold: float, who: str) -> None:
    """Warns if nothing is opaque. `who`: the argument with the points."""
    reaches, some = opacity.facts(volume, threshold)
    lo, hi = volume.range
    if not reaches:
        warnings.warn(f"{who}: none reaches the threshold {threshold:g}: nothing touches", stacklevel=_CALLER)
    elif not some:
        values = f"{lo:g} to {hi:g}" if lo < hi else f"{lo:g}"
        warnings.warn(f"{who}: none of the volume's values, {values}, is opaque: nothing touches", stacklevel=_CALLER)


def _check_ways(request: Request, interpolation: int) -> None:
    """Refuses an item of fewer than two poses, and two poses without a rigid motion between them. Checks all before any
    work, because the work counts from the first pose of each piece."""
    found = ffi.new("double[16]")
    for number, item in enumerate(request.of):
        which = "" if len(request.of) == 1 else f"item {number}: "
        poses = len(item.columns)
        if poses < 2:
            refuse(f"{which}the number of poses is {poses}, a motion needs two or more: (N,4,4)")
        centre = np.mean(item.mesh.bounds, axis=0).tolist()
        for pose in range(poses - 1):
            first = item.data + 16 * pose
            try:
                check(lib.vxt_pose_between(first, first + 16, 0.0, interpolation, centre, found))
            except InvalidArgumentError as error:
                raise InvalidArgumentError(f"{which}poses {pose} and {pose + 1}: {error}") from None


def poses_between(first: npt.NDArray[np.float64], last: npt.NDArray[np.float64], parameters: npt.NDArray[np.float64],
                  interpolation: str, centre: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """(T,4,4) for T parameters."""
    begin, end = matrix(first, "the first pose"), matrix(last, "the second pose")
    middle, how = vector(centre, "centre"), _interpolation(interpolation)
    poses = np.empty((len(parameters), 4, 4))
    for pose, parameter in zip(poses, parameters):
        check(lib.vxt_pose_between(begin, end, parameter, how, middle, pointer("double", pose)))
    return poses.transpose(0, 2, 1).copy()


def _interpolation(name: str) -> int:
    encoded_text(name, "interpolation")
    return named(name, "interpolation", INTERPOLATIONS)


class Scene:
    """Implements `voxtact.Scene`, without checks."""

    __slots__ = ("_turns", "_volume", "_labels", "_device", "_threads", "_opacity", "threshold", "revision", "_host", "_on_device",
                 "_born", "_edited", "_open", "_questions", "_touches", "__weakref__")

    def __init__(self, volume: Volume, points: Optional[npt.NDArray[np.float64]], domain: Optional[tuple[float, float]],
                 table_size: int, threshold: float, labels: Optional[Labels], device: Optional[Device], threads: int) -> None:
        self._opacity = Opacity(volume, points, domain, table_size)
        _warn_of_opacity(volume, self._opacity, threshold, "opacity")
        _check_threshold(threshold)
        self._turns = Turns()
        self._volume = volume
        self._labels = labels
        self._device = device
        self._threads = threads
        self.threshold = threshold
        self.revision = 0
        self._host: Optional[HostSide] = None
        self._on_device: Optional[DeviceSide] = None
        self._born = -1
        self._edited = False
        self._open = True
        self._questions: dict[Any, Question] = {}
        self._touches: dict[TouchOptions, TouchQuestion] = {}
        self._begin()

    @in_turn
    def _begin(self) -> None:
        """Creates the scene's part on host or device, and the host engine."""
        if self._device is not None:
            self._device_side(self._device)
        else:
            _ = self._host_side().engine

    # Properties

    @property
    def opacity(self) -> npt.NDArray[np.float64]:
        return self._opacity.points.copy()

    @property
    def domain(self) -> tuple[float, float]:
        return self._opacity.domain

    @property
    def table_size(self) -> int:
        return self._opacity.table_size

    def _check_open(self) -> None:
        if not self._open:
            raise NotReadyError("the scene is closed; make a new one")

    def _host_side(self) -> HostSide:
        self._check_open()
        if self._host is None:
            self._host = HostSide(self._volume, self._opacity, self._threads, self._labels, self._turns.cancel)
        return self._host

    def _device_side(self, device: Device) -> DeviceSide:
        self._check_open()
        if self._on_device is not None and self._born != forks():
            if self._device is not None:
                _ = self._device.context  # the error states the reason
            self._on_device = None
        if self._on_device is None:
            view, now = self._volume.view, None
            if self._edited:
                now = self._host_side().voxels()
                view = struct("volume_view", voxels=pointer("char", now.reshape(-1).view(np.uint8)), bytes=now.nbytes, grid=view.grid,
                              type=view.type)
            self._on_device = DeviceSide(device, self._volume, view, self._opacity, self._labels, self._turns.cancel)
            self._born = forks()
        return self._on_device

    def _own_device_side(self) -> Optional[DeviceSide]:
        """Returns the device part of this process, if any."""
        return self._on_device if self._born == forks() else None

    # Changes

    def set_opacity(self, points: Optional[npt.NDArray[np.float64]], domain: Optional[tuple[float, float]], table_size: int) -> None:
        opacity = Opacity(self._volume, points, domain, table_size)
        _warn_of_opacity(self._volume, opacity, self.threshold, "opacity")
        self._set_opacity(opacity)

    @in_turn
    def _set_opacity(self, opacity: Opacity) -> None:
        self._check_open()
        there = self._own_device_side()
        if self._host is not None:
            self._host.set_opacity(opacity)
        if there is not None:
            there.set_opacity(opacity)
        self._opacity = opacity
        self.revision += 1

    def set_threshold(self, threshold: float) -> None:
        _check_threshold(threshold)
        self._set_threshold(threshold)

    @in_turn
    def _set_threshold(self, threshold: float) -> None:
        self._check_open()
        self.threshold = threshold
        self.revision += 1

    @in_turn
    def _edit(self, edit: str, *arguments: Any) -> None:
        host = self._host_side()
        there = self._own_device_side()
        # The device first: both refuse the same edits, and it has more reasons to fail.
        if there is not None:
            getattr(there, edit)(*arguments)
        getattr(host, edit)(*arguments)
        self._edited = True
        self.revision += 1

    def set_ball(self, centre: npt.NDArray[np.float64], radius: float, value: float) -> None:
        self._edit("set_ball", vector(centre, "the ball's centre"), radius, value)

    def set_box(self, first: Sequence[int], size: Sequence[int], value: float) -> None:
        self._edit("set_box", ffi.new("vxt_voxel_box*", {"first": first, "size": size}), value)

    def write_box(self, first: Sequence[int], voxels: npt.NDArray[Any]) -> None:
        """Writes a box. `voxels`: z, y, x, of the volume's type and in C order."""
        self._edit("write", ffi.new("vxt_voxel_box*", {"first": first, "size": list(reversed(voxels.shape))}), voxels)

    # Questions about pairs

    def _question(self, options: dict[str, Any]) -> Question:
        """Returns the cached question of these options; a view is not cached."""
        if "view" in options:
            return Question(options)
        key = tuple(options.items())
        question = self._questions.get(key)
        if question is None:
            question = Question(options)
            if len(self._questions) < _MAX_QUESTIONS:
                self._questions[key] = question
        return question

    def _touch_question(self, options: TouchOptions) -> TouchQuestion:
        """Creates and caches the question of these options."""
        question = TouchQuestion(dict(options))
        if len(self._touches) < _MAX_QUESTIONS:
            self._touches[options] = question
        return question

    def _answered(self, request: Request, question: Question, progress: Tell) -> Tables:
        if question.outputs & lib.VXT_OUTPUT_LABELS and self._labels is None:
            refuse("touched labels need a scene with labels=")
        tables = Tables("count", request.lengths(), PROJECTIONS[question.projection], question.outputs, question.max_contacts,
                        question.counters, (request, question, self.revision))
        side: Any
        if self._device is not None:
            side = self._device_side(self._device)
            first, most = _first_piece(request, 1, _FIRST_ON_DEVICE), side.max_pairs(request, question)
        else:
            check_on_host(question)
            side = self._host_side()
            first, most = self._first_on_host(request, 1), _MAX_HOST_PAIRS
        if request.pairs == 0:
            tables.add(0, side.count(question, request, 0, 0, self.threshold))
        self._in_pieces(request, request.pairs, first, most, progress,
                        lambda begin, count: tables.add(begin, side.count(question, request, begin, count, self.threshold)))
        return tables

    def _first_on_host(self, request: Request, cost: int) -> int:
        return max(_first_piece(request, cost, _FIRST_ON_HOST), self._host_side().threads)

    @staticmethod
    def _in_pieces(request: Request, total: int, first: int, most: int, progress: Tell, work: Any) -> None:
        try:
            in_pieces(total, first, most, progress, work)
        except InvalidArgumentError:
            request.check()  # the engine itself checks the pose of a request with one pose
            raise

    @in_turn
    def _count(self, request: Request, question: Question, progress: Tell) -> Tables:
        self._check_open()
        return self._answered(request, question, progress)

    def count(self, meshes: Any, poses: Any, options: dict[str, Any], progress: Tell) -> Tables:
        return self._count(Request(meshes, poses), self._question(options), progress)

    @in_turn
    def _touch_of_one(self, mesh: Mesh, place: bytes, question: TouchQuestion) -> Tables:
        host = self._host
        if host is None or not self._open:
            host = self._host_side()
        return host.touch(question, mesh, place, self.threshold)

    @in_turn
    def _ask(self, question: HostQuestion, request: Request, progress: Tell) -> Tables:
        """Answers a question of the host engine."""
        side = self._host_side()
        of_segments = question.name == "motion"
        tables = Tables(question.name, request.lengths(of_segments), max_contacts=question.max_contacts)
        total, part = (request.segments, request.part_of_segments) if of_segments else (request.pairs, request.part)

        def work(first: int, count: int) -> None:
            few = question.cost == 1 and count * request.max_triangles <= FEW_TRIANGLES
            tables.add(first, side.ask(question, list(part(first, count)), self.threshold, few))

        if total == 0:
            work(0, 0)
        self._in_pieces(request, total, self._first_on_host(request, question.cost), _MAX_HOST_PAIRS, progress, work)
        return tables

    def ask(self, name: str, meshes: Any, poses: Any, settings: dict[str, Any], progress: Tell) -> Tables:
        """Answers a question by its name. settings: see HostQuestion."""
        request = Request(meshes, poses)
        if name == "motion":
            how = _interpolation(settings.get("interpolation", INTERPOLATIONS[0]))
            request.check()
            _check_ways(request, how)
        return self._ask(HostQuestion(name, settings), request, progress)

    def touch(self, meshes: Any, poses: Any, options: TouchOptions, progress: Tell) -> Tables:
        question = self._touches.get(options) or self._touch_question(options)
        if self._device is not None and question.is_plain and not _is_curved(meshes):
            return self.count(meshes, poses, question.count_options, progress)
        if (question.is_plain and progress is None and type(meshes) is Mesh and meshes.triangles <= FEW_TRIANGLES
                and poses.shape == (4, 4)):
            try:
                return self._touch_of_one(meshes, poses.tobytes("F"), question)
            except InvalidArgumentError:
                Request(meshes, poses).check()
                raise
        return self._ask(question, Request(meshes, poses), progress)

    @in_turn
    def again(self, asked: Any, output: str) -> Optional[Tables]:
        """Repeats the question with an output; None if the scene has changed. `asked`: `Tables.again`."""
        self._check_open()
        request, question, revision = asked
        if revision != self.revision:
            return None
        return self._answered(request, question.again(output), None)

    @in_turn
    def engine_seconds(self, meshes: Any, poses: Any, times: int) -> list[float]:
        """Returns the duration of one host call per touch, for benchmarks."""
        request, question, side = Request(meshes, poses), TouchQuestion({}), self._host_side()
        seconds: list[float] = []
        for _ in range(times):
            tables = Tables("touch", ())
            tables.add(0, side.ask(question, list(request.part(0, request.pairs)), self.threshold,
                                   request.pairs * request.max_triangles <= FEW_TRIANGLES))
            seconds.append(tables.milliseconds / 1000)
        return seconds

    # Others

    def plan(self, target: npt.NDArray[np.float64], wish: dict[str, Any], avoided: Optional[Volume],
             points: Optional[npt.NDArray[np.float64]], domain: Optional[tuple[float, float]]) -> Tables:
        """Answers a plan. wish: members of vxt_plan by their names in C, and `avoid`, labels."""
        opaque = None
        if points is not None:
            volume = self._volume if avoided is None else avoided
            opaque = Opacity(volume, points, domain, self.table_size)
            _warn_of_opacity(volume, opaque, self.threshold, "avoid_opacity")
        return self._plan(dict(wish, target=vector(target, "target")), avoided, opaque)

    @in_turn
    def _plan(self, wish: dict[str, Any], avoided: Optional[Volume], opaque: Optional[Opacity]) -> Tables:
        tables = Tables("plan", ())
        tables.add(0, self._host_side().plan(wish, avoided, opaque, self.threshold))
        return tables

    def picture(self, meshes: Any, poses: Any, options: dict[str, Any], device: Optional[Device]) -> npt.NDArray[np.uint8]:
        wish = PictureWish(self._volume, meshes, poses, options)
        return self._picture(wish, device)

    @in_turn
    def _picture(self, wish: PictureWish, device: Optional[Device]) -> npt.NDArray[np.uint8]:
        self._check_open()
        on = self._device if self._device is not None else device
        assert on is not None
        return self._device_side(on).picture(wish, self._opacity, self.threshold)

    @in_turn
    def track(self, tracker: CData, mesh: Mesh, place: CData, tracked: CData) -> None:
        """Tracks one pose."""
        item = self._host_side().item(mesh, place, 1)
        check(lib.vxt_tracker_track(tracker, ffi.addressof(item), self.threshold or -0.0, tracked))

    @in_turn
    def close(self) -> None:
        self._open = False
        self._host = None
        self._on_device = None


class Tracker:
    """Implements `voxtact.Tracker`, without checks."""

    __slots__ = ("_scene", "_mesh", "_handle")

    def __init__(self, scene: Scene, mesh: Mesh, max_distance: float, resolution: float, max_steps: int) -> None:
        not_zero(max_distance, "distance", "max")
        not_zero(resolution, "count", "resolution")
        self._scene = scene
        self._mesh = mesh
        self._handle = made("tracker", lib.vxt_tracker_create, max_distance, resolution, max_steps)

    def update(self, pose: npt.NDArray[np.float64]) -> tuple[bool, bool, float, float, bool]:
        """Returns touches, undecided, the bounds, and whether the volume was searched."""
        place, tracked = ffi.new("double[16]", matrix(pose, "pose")), struct("tracked")
        self._scene.track(self._handle, self._mesh, place, tracked)
        return tracked.touch == 1, tracked.touch == 2, tracked.lower, tracked.upper, bool(tracked.searched)


