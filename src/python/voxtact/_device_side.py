# SPDX-License-Identifier: MIT
"""The device part of a scene: the edited volume, its opacity, detectors, and inputs of pictures."""
from __future__ import annotations

import weakref
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._errors import LimitExceededError
from ._handles import METHODS, Device, Labels, Mesh, Volume
from ._library import NULL, CData, check, copied, ffi, lib, made, made_with, not_zero, pointer, refuse, struct, structs
from ._request import PROJECTIONS, Opacity, Question, Request
from ._turns import interruptibly
from ._wish import PictureWish

#: Maximum number of cached detectors; the oldest is evicted.
_MAX_DETECTORS = 8
#: Bytes of one answer's outputs, below the limits of all devices.
_OUTPUT_BYTES = 2**25
_MAX_PAIRS = 2**16
#: table size of a picture
_MAX_ENTRIES = 1024
_CREASE_DEGREES = 40.0


class _Uploaded:
    """Device objects of a mesh: for questions, and for pictures with its normals."""

    __slots__ = ("asked", "drawn")

    def __init__(self) -> None:
        self.asked: CData = None
        self.drawn: Optional[tuple[CData, CData]] = None


class DeviceSide:
    """The device part of a scene. `cancel` ends its pictures."""

    def __init__(self, device: Device, volume: Volume, view: CData, opacity: Opacity, labels: Optional[Labels],
                 cancel: CData) -> None:
        self._device = device
        self._grid = volume.grid
        self._cancel = cancel
        self._volume = self._upload("volume", view, struct("volume_options", bricks=1, editable=1))
        self._labels = NULL if labels is None else self._upload("label_map", labels.handle, NULL)
        self._detectors: dict[Any, CData] = {}
        self._meshes: weakref.WeakKeyDictionary[Mesh, _Uploaded] = weakref.WeakKeyDictionary()
        self._renderer: CData = None
        self._bricks: CData = None
        self.set_opacity(opacity)

    def _upload(self, kind: str, *arguments: Any) -> CData:
        device = self._device
        return device.make(kind, getattr(lib, f"vxt_{kind}_upload"), device.context, device.queue, *arguments)

    def _upload_for_pictures(self, kind: str, *arguments: Any) -> CData:
        renderer = lib.vxt_blocking_renderer_renderer(self._renderer)
        return made_with((self._renderer,), kind, getattr(lib, f"vxt_{kind}_upload"), renderer, self._device.queue, *arguments)

    def set_opacity(self, opacity: Opacity) -> None:
        self._function = self._upload("transfer_function", opacity.desc, NULL)

    def set_box(self, box: CData, value: float) -> None:
        self._device.submit(lib.vxt_volume_cmd_set_box, self._volume, box, value)

    def set_ball(self, centre: list[float], radius: float, value: float) -> None:
        self._device.submit(lib.vxt_volume_cmd_set_ball, self._volume, centre, radius, value)

    def write(self, box: CData, voxels: npt.NDArray[Any]) -> None:
        self._device.submit(lib.vxt_volume_cmd_write, self._volume, box, pointer("char", voxels.reshape(-1).view(np.uint8)), voxels.nbytes)

    # Questions

    def _method(self, question: Question) -> int:
        if question.method is not None:
            if question.method == lib.VXT_METHOD_CPU:
                refuse("the method cpu is the host engine: make the scene without device=")
            return question.method
        if question.is_certified:
            return int(lib.VXT_METHOD_COMPUTE)
        if question.stop_at_first and not question.outputs:
            return int(lib.VXT_METHOD_QUERY_ANY)
        return int(lib.vxt_context_default_method(self._device.context))

    def _detector(self, question: Question) -> CData:
        found = self._detectors.get(question.key)
        if found is None:
            method = self._method(question)
            if question.is_certified:
                if method != lib.VXT_METHOD_COMPUTE:
                    refuse(f"projection='certified' needs method='compute', not '{METHODS[method]}'")
                if question.overestimate:
                    refuse("the overestimate is for projection='dominant-axis', not for 'certified'")
                kind = "certified"
                size = 0.0 if question.resolution is None else not_zero(question.resolution, "count", "resolution")
                desc = struct("certified_desc", max_depth=question.max_depth or 0.0, resolution=size, outputs=question.outputs,
                              stop_at_first=question.stop_at_first, counters=question.counters)
            else:
                if question.counters:
                    refuse(f"counters are of projection='certified', not of '{PROJECTIONS[question.projection]}'")
                kind = "raster"
                desc = struct("raster_desc", method=method, projection=question.projection, boundary=question.boundary,
                              filter=lib.vxt_default_filter(method) if question.filter is None else question.filter,
                              max_depth=question.max_depth or 0.0, outputs=question.outputs,
                              samples_per_voxel=question.samples_per_voxel or 0, overestimate=question.overestimate)
            device = self._device
            found = device.make("blocking_detector", getattr(lib, f"vxt_blocking_detector_create_{kind}"), device.context, desc, device.queue,
                                max(question.max_contacts, 1))
            if len(self._detectors) >= _MAX_DETECTORS:
                del self._detectors[next(iter(self._detectors))]
            self._detectors[question.key] = found
        return found

    def _uploaded(self, mesh: Mesh) -> _Uploaded:
        return self._meshes.setdefault(mesh, _Uploaded())

    def _on_device(self, mesh: Mesh) -> CData:
        one = self._uploaded(mesh)
        if one.asked is None:
            one.asked = self._upload("mesh", mesh.view, struct("mesh_options", clusters=1))
        return one.asked

    def count(self, question: Question, request: Request, first: int, count: int, threshold: float) -> CData:
        detector = self._detector(question)
        parts = list(request.part(first, count))
        items = structs("item", len(parts))
        for item, (mesh, poses, number) in zip(items, parts):
            item.mesh = self._on_device(mesh)
            item.volume = self._volume
            item.transfer_function = self._function
            item.world_from_object = poses
            item.pose_count = number
            item.labels = self._labels
        batch = struct("batch", items=items, item_count=len(parts), view=question.view_on(self._grid), threshold=threshold or -0.0)
        answer = made("answer", lib.vxt_answer_create)
        try:
            check(lib.vxt_blocking_detector_detect(detector, batch, answer))
        except LimitExceededError as error:
            if question.outputs & lib.VXT_OUTPUT_CONTACTS:
                raise LimitExceededError(f"{error}; ask for fewer by max_contacts, which is {question.max_contacts}") from None
            raise
        return answer

    @staticmethod
    def max_pairs(request: Request, question: Question) -> int:
        if not question.outputs & lib.VXT_OUTPUT_TRIANGLES:
            return _MAX_PAIRS
        return int(max(min(_OUTPUT_BYTES // (4 * request.max_triangles), _MAX_PAIRS), 1))

    # Pictures

    def _drawn(self, mesh: Mesh) -> tuple[CData, CData]:
        one = self._uploaded(mesh)
        if one.drawn is None:
            view = struct("mesh_view")
            creased = made("mesh_data", lib.vxt_split_at_creases, mesh.view, _CREASE_DEGREES)
            check(lib.vxt_mesh_data_view(creased, view))
            one.drawn = self._upload("mesh", view, NULL), self._upload_for_pictures("mesh_normals", view)
        return one.drawn

    def _colours(self, wish: PictureWish, opacity: Opacity) -> CData:
        of = opacity.desc
        desc = struct("render_function_desc", points=of.points, point_count=of.point_count, domain=of.domain,
                      colours=ffi.cast("vxt_colour_point*", pointer("double", wish.colours)), colour_count=len(wish.colours),
                      step=min(self._grid.spacing) / 2, table_size=min(opacity.table_size, _MAX_ENTRIES))
        return self._upload_for_pictures("render_function", desc)

    def picture(self, wish: PictureWish, opacity: Opacity, threshold: float) -> npt.NDArray[np.uint8]:
        device = self._device
        if self._renderer is None:
            self._renderer = device.make("blocking_renderer", lib.vxt_blocking_renderer_create, device.context, device.queue)
            self._bricks = made_with((self._renderer, self._volume), "render_bricks", lib.vxt_render_bricks_create,
                                     lib.vxt_blocking_renderer_renderer(self._renderer), self._volume)
        function = self._colours(wish, opacity)
        items = [] if wish.shown is None else wish.shown.of
        meshes = structs("scene_mesh", sum(len(item.columns) for item in items))
        kept: list[CData] = []
        number = 0
        for item, colour in zip(items, wish.mesh_colours):
            drawing, normals = self._drawn(item.mesh)
            for pose in item.columns:
                one = meshes[number]
                one.mesh, one.normals, one.transfer_function = drawing, normals, self._function
                one.world_from_object = [float(element) for element in pose.reshape(-1)]
                one.colour = [channel or -0.0 for channel in colour]  # three 0 would be the default
                one.threshold, one.through, one.paint, one.clipped = threshold or -0.0, wish.through, wish.paint, wish.clip_meshes
                if wish.paint == lib.VXT_PAINT_TRIANGLES:
                    chosen = wish.triangles[number]
                    kept.append(self._upload_for_pictures("painted_triangles", item.mesh.triangles,
                                                          ffi.new("uint32_t[]", chosen or 1), len(chosen)))
                    one.triangles = kept[-1]
                number += 1
        scene = struct("picture_scene", volume=self._volume, function=function, bricks=self._bricks, meshes=meshes, mesh_count=number,
                       clip_planes=wish.clips, clip_plane_count=len(wish.clips), lighting=wish.lighting,
                       clip_from_world=wish.clip_from_world, background=list(wish.background), cancel=self._cancel)
        picture, view = made("picture", lib.vxt_picture_create), struct("picture_view")
        interruptibly(lambda: check(lib.vxt_blocking_renderer_render(self._renderer, scene, wish.width, wish.height, NULL, NULL,
                                                                     picture)), self._cancel)
        check(lib.vxt_picture_get(picture, view))
        return copied(view.rgba, (view.height, view.width, 4), np.uint8)
