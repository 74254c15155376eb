# SPDX-License-Identifier: MIT
"""Options of pictures, in the library's form."""
from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._common import encoded_text
from ._errors import InvalidArgumentError
from ._handles import Mesh, Volume
from ._library import NULL, CData, check, doubles, ffi, lib, made, matrix, matrix_of, named, refuse, struct, text_of
from ._request import Request
from ._tables import points_of

_PAINTS = {"contacts": lib.VXT_PAINT_CONTACTS, "discarded": lib.VXT_PAINT_DISCARDED, "triangles": lib.VXT_PAINT_TRIANGLES,
           "plain": lib.VXT_PAINT_PLAIN}
_DIRECTIONS = ("front", "back", "left", "right", "top", "bottom")
_SIDES = ("left", "right", "back", "front", "top", "bottom", "near")
_LIGHTS = ("soft", "eye", "none")


def look_names() -> list[str]:
    names: list[str] = []
    while name := lib.vxt_look_name(len(names)):
        names.append(text_of(name))
    return names


def look(name: bytes, volume: Volume) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Returns opacity and colours of a look."""
    found = made("look", lib.vxt_look_create, name, ffi.new("vxt_range*", volume.range))
    return points_of(lib.vxt_look_opacity, found, 2), points_of(lib.vxt_look_colours, found, 4)


def _direction_of(view: Any) -> CData:
    """Returns a vxt_view_direction from a name or angles; None for a matrix."""
    if isinstance(view, str):
        named(view, "view", _DIRECTIONS)
        direction = ffi.new("vxt_view_direction*")
        check(lib.vxt_direction_named(encoded_text(view, "view"), direction))
        return direction
    return ffi.new("vxt_view_direction*", view) if isinstance(view, tuple) and len(view) == 2 else None


def _view_of(direction: CData, volume: Volume, shown: Optional[Request], width: int, height: int, what: str) -> list[float]:
    """Returns a view that frames the volume; meshes are between its near and far plane, too."""
    if width == 0 or height == 0:
        refuse(f"size has a 0; a {what} has at least one pixel")
    if not math.isfinite(direction.azimuth) or not math.isfinite(direction.elevation):
        refuse("view: azimuth or elevation is not finite")
    also, view = NULL, ffi.new("vxt_view*")
    if shown is not None and shown.pairs:
        boxes = np.concatenate([item.mesh.boxes_at(item.columns) for item in shown.of])
        also = ffi.new("vxt_box*", {"lo": boxes[:, 0].min(axis=0).tolist(), "hi": boxes[:, 1].max(axis=0).tolist()})
    check(lib.vxt_view_from(direction, volume.grid, also, width, height, view))
    return list(view.clip_from_world)


def view_from(view: Any, volume: Volume, mesh: Optional[Mesh], poses: Optional[npt.NDArray[np.float64]], width: int,
              height: int) -> npt.NDArray[np.float64]:
    direction = _direction_of(view)
    if direction is None:
        refuse("view is neither a name nor (azimuth, elevation)")
    shown = None if mesh is None else Request(mesh, poses)
    if shown is not None:
        shown.check()
    return matrix_of(ffi.new("double[16]", _view_of(direction, volume, shown, width, height, "view")))


def _clip_of(given: tuple[Any, ...], volume: Volume, direction: CData) -> tuple[list[float], float]:
    """Returns a plane from (side, mm or None), or from (x, y, z, offset)."""
    if len(given) == 4:
        return list(given[:3]), given[3]
    side = given[0].decode("utf-8", "surrogateescape")
    if side == "near" and direction is None:
        refuse("clip 'near' needs a view by name or by angles; with a matrix, give a plane: (x, y, z, offset)")
    named(side, "clip", _SIDES)
    plane = ffi.new("vxt_clip_plane*")
    check(lib.vxt_clip_side(given[0], NULL if given[1] is None else ffi.new("double*", given[1]), volume.grid,
                            NULL if direction is None else direction, plane))
    return list(plane.normal), plane.offset


def _colour_by(get: Callable[..., None], *arguments: Any) -> list[float]:
    colour = ffi.new("double[3]")
    get(*arguments, colour)
    return list(colour)


class PictureWish:
    """Contents and appearance of a picture."""

    def __init__(self, volume: Volume, meshes: Any, poses: Any, options: dict[str, Any]) -> None:
        self.shown = None if meshes is None else Request(meshes, poses)
        if self.shown is not None:
            self.shown.check()
        items = [] if self.shown is None else self.shown.of
        self.width, self.height = options["size"]
        direction = _direction_of(options["view"])
        if "preset" in options:
            colours = look(encoded_text(options["preset"], "preset"), volume)[1]
        else:
            colours = doubles(options.get("colours", [[0.0, *_colour_by(lib.vxt_plain_colour)]]))
            if colours.ndim != 2 or colours.shape[1] != 4:
                refuse("colours are no (N,4): value, red, green and blue")
        self.colours: npt.NDArray[np.float64] = colours
        self.background = options["background"]
        named(options["lighting"], "lighting", _LIGHTS)
        self.lighting = struct("lighting")
        check(lib.vxt_lighting_named(encoded_text(options["lighting"], "lighting"), volume.grid, self.lighting))
        self.paint = list(_PAINTS.values())[named(options["show"], "show", tuple(_PAINTS))]
        if direction is not None:
            self.clip_from_world = _view_of(direction, volume, self.shown, self.width, self.height, "picture")
        else:
            self.clip_from_world = matrix(options["view"], "view")
            if self.width == 0 or self.height == 0:
                refuse("size has a 0; a picture has at least one pixel")
        clips = [_clip_of(clip, volume, direction) for clip in options["clip"]]
        self.clips = ffi.new("vxt_clip_plane[]", clips)
        self.clip_meshes = options["clip_meshes"]
        colours_of_meshes = options.get("mesh_colours") or [_colour_by(lib.vxt_mesh_colour, number) for number in range(len(items))]
        if len(colours_of_meshes) != len(items):
            refuse(f"mesh_colours has {len(colours_of_meshes)} colours, and there are {len(items)} meshes")
        self.mesh_colours = colours_of_meshes
        self.triangles = self._chosen(*options.get("triangles", ((), ())))
        self.through = options["through"] if "through" in options else lib.vxt_paint_through(self.paint)

    def _chosen(self, pairs: list[int], triangles: list[int]) -> list[list[int]]:
        """Returns the chosen triangles of each pair; wrong indices are refused with the mesh."""
        count = 0 if self.shown is None else self.shown.pairs
        chosen: list[list[int]] = [[] for _ in range(count)]
        for pair, triangle in zip(pairs, triangles):
            if not 0 <= pair < count:
                raise InvalidArgumentError(f"triangles are of pair {pair}, and there are {count} pairs of a mesh and a pose")
            chosen[pair].append(triangle)
        return chosen
