# SPDX-License-Identifier: MIT
"""The host part of a scene: the edited volume, its opacity, and the engine with its threads."""
from __future__ import annotations

from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._errors import UnsupportedError
from ._handles import METHODS, Labels, Mesh, Volume
from ._library import NULL, CData, check, failure, ffi, forks, lib, made, made_with, pointer, struct
from ._request import HostQuestion, Opacity, Question, Request
from ._tables import SingleTables
from ._turns import interruptibly

#: Below this number of triangle tests, starting a thread takes longer than a touch query. Counts always start one: one
#: triangle may have all the fragments.
FEW_TRIANGLES = 2**14

_ask, _find, _from_buffer, _DOUBLES = lib.vxt_ask, lib.vxt_answer_find, ffi.from_buffer, ffi.typeof("double[]")


def check_on_host(question: Question) -> None:
    """Refuses options that only devices have."""
    if question.method is not None and question.method != lib.VXT_METHOD_CPU:
        raise UnsupportedError(f"the method {METHODS[question.method]} needs a Vulkan device; make the scene with device=")
    if question.filter not in (None, lib.VXT_FILTER_EXACT) or question.overestimate:
        raise UnsupportedError("the host engine has the filter exact alone, and no overestimate; for others make the scene "
                               "with device=")
    if question.counters:
        raise UnsupportedError("counters are of the passes on a device; make the scene with device=")


class HostSide:
    """The host part of a scene. `cancel` ends its calls."""

    def __init__(self, volume: Volume, opacity: Opacity, threads: int, labels: Optional[Labels], cancel: CData) -> None:
        self._given = volume
        self.volume = made("host_volume", lib.vxt_host_volume_create, volume.view)
        self.labels = NULL if labels is None else labels.on(volume.view.grid)
        self._wanted_threads = threads
        self._cancel = cancel
        self._engine: CData = None
        self._born = -1
        self._pairs = struct("pairs", cancel=cancel)
        self._alone = ffi.new("vxt_host_item[1]", [{"volume": self.volume, "labels": self.labels}])
        # Reused for each touch query of one pose.
        self._single = ffi.new("vxt_host_item*", {"volume": self.volume, "pose_count": 1})
        self._single_mesh: Optional[Mesh] = None
        self._single_pairs = struct("pairs", items=self._single, item_count=1, cancel=cancel)
        self._single_answer = made("answer", lib.vxt_answer_create)
        self._touch, self._took = struct("column"), struct("column")
        self._touch_at = ffi.cast("uint32_t**", ffi.addressof(self._touch, "data"))
        self._took_at = ffi.cast("double**", ffi.addressof(self._took, "data"))
        self.set_opacity(opacity)

    def set_opacity(self, opacity: Opacity) -> None:
        self.function = made("host_transfer_function", lib.vxt_host_transfer_function_create, opacity.desc)
        self._alone[0].transfer_function = self._single.transfer_function = self.function

    @property
    def engine(self) -> CData:
        """The engine of this process: a forked child has no threads of its parent."""
        if self._born != forks():
            self._engine = made_with((), "host_engine", lib.vxt_host_engine_create, self._wanted_threads)
            self._born = forks()
        return self._engine

    @property
    def threads(self) -> int:
        return int(lib.vxt_host_engine_threads(self.engine))

    def set_box(self, box: CData, value: float) -> None:
        check(lib.vxt_host_volume_set_box(self.volume, box, value))

    def set_ball(self, centre: list[float], radius: float, value: float) -> None:
        check(lib.vxt_host_volume_set_ball(self.volume, centre, radius, value))

    def write(self, box: CData, voxels: npt.NDArray[Any]) -> None:
        check(lib.vxt_host_volume_write(self.volume, box, pointer("char", voxels.reshape(-1).view(np.uint8)), voxels.nbytes))

    def voxels(self) -> npt.NDArray[Any]:
        """The current voxels."""
        now = np.empty_like(self._given.array)
        box = ffi.new("vxt_voxel_box*", {"size": self._given.size})
        check(lib.vxt_host_volume_read(self.volume, box, pointer("char", now.reshape(-1).view(np.uint8)), now.nbytes))
        return now

    def item(self, mesh: Mesh, poses: CData, count: int) -> CData:
        """Returns the item for one mesh; the next call reuses it."""
        item = self._alone[0]
        item.mesh = mesh.on_host
        item.world_from_object = poses
        item.pose_count = count
        return item

    def _fill(self, parts: list[tuple[Mesh, CData, int]]) -> None:
        pairs = self._pairs
        if len(parts) == 1:
            self.item(*parts[0])
            pairs.items = self._alone
        else:
            self._many = ffi.new("vxt_host_item[]", [{"mesh": mesh.on_host, "volume": self.volume, "transfer_function": self.function,
                                                      "world_from_object": poses, "pose_count": count, "labels": self.labels}
                                                     for mesh, poses, count in parts])
            pairs.items = self._many
        pairs.item_count = len(parts)

    def ask(self, question: HostQuestion, parts: list[tuple[Mesh, CData, int]], threshold: float, few: bool = False) -> CData:
        """Returns the answer for parts of a request."""
        self._fill(parts)
        pairs = self._pairs
        pairs.opacity_threshold = threshold or -0.0
        pairs.view = question.view_on(self._given.grid)
        answer = made("answer", lib.vxt_answer_create)
        engine = self.engine
        if few:
            check(_ask(engine, *question.arguments, pairs, answer))
        else:
            interruptibly(lambda: check(_ask(engine, *question.arguments, pairs, answer)), self._cancel)
        return answer

    def count(self, question: Question, request: Request, first: int, count: int, threshold: float) -> CData:
        few = question.stop_at_first and count * request.max_triangles <= FEW_TRIANGLES
        return self.ask(question, list(request.part(first, count)), threshold, few)

    def touch(self, question: HostQuestion, mesh: Mesh, place: bytes, threshold: float) -> SingleTables:
        """Answers a touch query about one pose, column by column."""
        single = self._single
        if self._single_mesh is not mesh:
            single.mesh = mesh.on_host
            self._single_mesh = mesh
        single.world_from_object = _from_buffer(_DOUBLES, place)
        self._single_pairs.opacity_threshold = threshold or -0.0
        answer = self._single_answer
        name, settings, count = question.arguments
        result = _ask(self._engine if self._born == forks() else self.engine, name, settings, count, self._single_pairs, answer)
        if result:
            raise failure(result)
        _find(answer, b"pairs", b"touch", self._touch)
        _find(answer, b"totals", b"wall_milliseconds", self._took)
        return SingleTables(self._touch_at[0][0], self._took_at[0][0])

    def plan(self, wish: dict[str, Any], avoided: Optional[Volume], opaque: Optional[Opacity], threshold: float) -> CData:
        """Answers a plan. wish: members of vxt_plan by their names in C, and `avoid`."""
        obstacles: list[dict[str, Any]] = []
        kept: list[Any] = []  # keeps the memory that the structs reference
        some = threshold or -0.0

        def text(name: str) -> CData:
            kept.append(ffi.new("char[]", name.encode()))
            return kept[-1]

        avoid = wish.pop("avoid")
        if avoid:
            kept.append(ffi.new("int32_t[]", avoid))
            obstacles.append({"volume": self.volume, "labels": self.labels, "avoid": kept[-1], "avoid_count": len(avoid),
                              "opacity_threshold": some, "name": text("avoid")})
        if opaque is not None:
            other = self.volume if avoided is None else made("host_volume", lib.vxt_host_volume_create, avoided.view)
            function = made("host_transfer_function", lib.vxt_host_transfer_function_create, opaque.desc)
            kept += [other, function]
            obstacles.append({"volume": other, "transfer_function": function, "opacity_threshold": some,
                              "name": text("avoid_opacity")})
        places = ffi.new("vxt_obstacle[]", obstacles)
        if wish.pop("entry_by_label"):
            wish["entry_labels"] = self.labels
        elif "entry_radius" not in wish:
            wish.update(entry_volume=self.volume, entry_transfer_function=self.function, entry_threshold=some)
        plan = struct("plan", obstacles=places, obstacle_count=len(obstacles), cancel=self._cancel, **wish)
        answer = made("answer", lib.vxt_answer_create)
        engine = self.engine
        interruptibly(lambda: check(lib.vxt_ask_plan(engine, plan, answer)), self._cancel)
        return answer


