# SPDX-License-Identifier: MIT
"""Options and appearance of pictures, and the camera of pictures and projections."""
from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Sequence
from typing import Any, Literal, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from ._arguments import Poses, whole
from ._common import encoded, encoded_text, number, numbers
from ._errors import InvalidArgumentError
from ._library import lib, made
from ._mesh import Mesh
from ._tables import points_of
from ._volume import Volume
from ._wish import look as look_of
from ._wish import look_names
from ._wish import view_from as clip_from_world

#: Red, green and blue, 0 to 1.
Colour = tuple[float, float, float]
Show = Literal["contacts", "discarded", "triangles", "plain"]
Light = Literal["soft", "eye", "none"]
#: A clipping plane: see `Scene.picture`.
Clip = Union[str, tuple[str, float], tuple[float, float, float, float]]


class Look(NamedTuple):
    """Opacity and colours for a kind of image. `look` creates one."""

    #: (N,2): value and opacity, for `Scene`
    opacity: npt.NDArray[np.float64]
    #: (N,4): value, red, green and blue, for `Scene.picture`
    colours: npt.NDArray[np.float64]


def looks() -> tuple[str, ...]:
    """Returns the names of all looks: "mr", "ct-bone", …"""
    return tuple(look_names())


def look(name: str, volume: Volume) -> Look:
    """Returns a look in the volume's own units: "mr" looks scale with its range of values, "ct" looks use Hounsfield units.

        mr = vx.look("mr", head)
        vx.Scene(head, opacity=mr.opacity).picture(colours=mr.colours)
    """
    if not isinstance(volume, Volume):
        raise TypeError(f"volume is a {type(volume).__name__}; voxtact.read_volume() makes a voxtact.Volume of it")
    return Look(*look_of(encoded_text(name, "name"), volume._core))


def read_colours(path: Union[str, os.PathLike[str]]) -> npt.NDArray[np.float64]:
    """Reads the colours of a transfer function in JSON (docs/cli.md): (N,4), value, red, green and blue; (0,4) without
    colours."""
    return points_of(lib.vxt_colour_points_get, made("colour_points", lib.vxt_read_colours, encoded(path)), 4)


def _colour(given: Any, what: str) -> tuple[float, ...]:
    array = numbers(given, what)
    if array.shape != (3,) or not ((array >= 0) & (array <= 1)).all():
        raise InvalidArgumentError(f"{what} is {given!r}; three numbers from 0 to 1 are needed: red, green, blue")
    return tuple(float(channel) for channel in array)


def view_options(given: Any) -> Any:
    """Parses a name, (azimuth, elevation), or a matrix."""
    if isinstance(given, tuple) and len(given) == 2:
        return number(given[0], "view"), number(given[1], "view")
    return given if isinstance(given, str) else numbers(given, "view")


def _clip(given: Any) -> tuple[Any, ...]:
    """Parses (side, mm or None), or a plane's four numbers."""
    if isinstance(given, str):
        return (encoded_text(given, "clip"), None)
    if isinstance(given, Sequence) and len(given) == 2 and isinstance(given[0], str):
        at = number(given[1], "clip")
        if not np.isfinite(at):
            raise InvalidArgumentError(f"clip {given[0]!r} is at {at} mm")
        return (encoded_text(given[0], "clip"), at)
    plane = numbers(given, "clip")
    if plane.shape != (4,):
        raise InvalidArgumentError(f"clip has {given!r}; a side, (side, mm), or a plane (x, y, z, offset) is needed")
    return tuple(float(each) for each in plane)


def _clips(given: Any) -> list[tuple[Any, ...]]:
    if isinstance(given, str) or (isinstance(given, tuple) and len(given) in (2, 4)
                                  and not isinstance(given[-1], (str, tuple, list, np.ndarray))):
        return [_clip(given)]
    return [_clip(each) for each in given]


def _chosen(given: Any, pairs: int, meshes: int) -> tuple[list[int], list[int]]:
    """Returns pair and triangle of each row."""
    array = np.asarray(given)
    if array.dtype.names is not None and {"pair", "triangle"} <= set(array.dtype.names):
        return array["pair"].tolist(), array["triangle"].tolist()
    if array.size == 0:
        return [], []
    if array.ndim != 1 or array.dtype.kind not in "iu" or array.min() < 0 or array.max() >= 2**32:
        raise InvalidArgumentError("triangles are neither rows with pair and triangle, as Answer.triangles has them, nor "
                                   "numbers of triangles")
    if meshes != 1:
        raise InvalidArgumentError(f"triangles are numbers, and there are {meshes} meshes: give rows with pair and "
                                   "triangle, as Answer.triangles has them")
    return np.repeat(np.arange(pairs), len(array)).tolist(), np.tile(array, pairs).tolist()


def picture_options(pairs: int, meshes: int, *, size: list[int], view: Any, preset: Optional[str], colours: Any,
                    background: Any, lighting: str, show: Optional[str], through: Optional[float], triangles: Any,
                    mesh_colours: Any, clip: Any, clip_meshes: bool) -> dict[str, Any]:
    """Returns the options of a picture in the library's form."""
    if preset is not None and colours is not None:
        raise InvalidArgumentError("preset and colours both say which colours the volume has; leave out one of them")
    options: dict[str, Any] = {
        "size": size, "view": view_options(view), "lighting": lighting,
        "background": _colour(background, "background"), "clip": _clips(clip), "clip_meshes": bool(clip_meshes),
        "show": show if show is not None else "contacts" if triangles is None else "triangles"}
    if clip_meshes and not options["clip"]:
        raise InvalidArgumentError("clip_meshes takes of meshes what clip takes away, and there is no clip")
    if preset is not None:
        options["preset"] = preset
    if colours is not None:
        options["colours"] = numbers(colours, "colours")
    if through is not None:
        options["through"] = number(through, "through")
        if not 0 <= options["through"] <= 1:
            raise InvalidArgumentError(f"through is {through!r}; it must be from 0 to 1")
        if show == "plain":
            raise InvalidArgumentError("through is about what is painted on meshes, and show='plain' paints nothing")
    for name, given in (("show", show), ("through", through), ("clip_meshes", clip_meshes or None)):
        if given is not None and meshes == 0:
            raise InvalidArgumentError(f"{name} is about meshes, and there is none")
    if mesh_colours is not None:
        options["mesh_colours"] = [_colour(each, "mesh_colours") for each in mesh_colours]
    if triangles is not None:
        if options["show"] != "triangles":
            raise InvalidArgumentError(f"triangles are chosen, and show={options['show']!r} does not show them")
        options["triangles"] = _chosen(triangles, pairs, meshes)
    return options


def png(pixels: npt.NDArray[np.uint8]) -> bytes:
    """Encodes a picture as PNG, in memory."""
    height, width, _ = pixels.shape

    def chunk(kind: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    rows = np.zeros((height, 1 + 4 * width), dtype=np.uint8)  # each row begins with its filter: none
    rows[:, 1:] = pixels.reshape(height, 4 * width)
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6))
            + chunk(b"IEND", b""))


class View(NamedTuple):
    """The camera of the projections "view" and "two-view", and of pictures. `view_from` creates one."""

    #: (4,4): Vulkan's clip space (x right, y down, depth 0 to 1); orthographic or perspective
    clip_from_world: npt.ArrayLike
    #: pixels
    width: int = 512
    height: int = 512


def view_from(view: Union[str, tuple[float, float]], volume: Volume, mesh: Optional[Mesh] = None,
              poses: Optional[Poses] = None, *, size: tuple[int, int] = (512, 512)) -> View:
    """Returns a `View` that frames a volume, like `Scene.picture`: orthographic, with square pixels.

        scene.count(knife, poses, projection="view", view=vx.view_from("left", head, knife, poses))

    view
        "front", "back", "left", "right", "top", "bottom"; or (azimuth, elevation) in degrees
    mesh, poses
        kept between the near and far planes: the projection "view" counts nothing beyond them
    size
        (width, height), pixels
    """
    if not isinstance(volume, Volume) or not (mesh is None or isinstance(mesh, Mesh)):
        raise TypeError("volume is a voxtact.Volume, and mesh a voxtact.Mesh: voxtact.read_volume() and read_mesh() make them")
    if not isinstance(view, (str, tuple)):
        raise TypeError(f"view is a {type(view).__name__}; a name or (azimuth, elevation) is needed")
    width, height = whole(size, 2, "size")
    matrices = None if mesh is None else np.eye(4) if poses is None else numbers(poses, "poses")
    return View(clip_from_world(view_options(view), volume._core, None if mesh is None else mesh._core, matrices, width, height), width, height)
