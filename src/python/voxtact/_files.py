# SPDX-License-Identifier: MIT
"""Small files: poses, cameras, opacities, and pictures."""
from __future__ import annotations

import os
from typing import NamedTuple, Union

import numpy as np
import numpy.typing as npt

from ._common import encoded, encoded_text
from ._errors import InvalidArgumentError
from ._library import NULL, check, ffi, lib, made, matrices_of, matrix_of, pointer, text_of
from ._tables import points_of
from ._turns import guarded


def read_poses(path: Union[str, os.PathLike[str]], format: str = "matrix") -> npt.NDArray[np.float64]:
    """Reads poses, (N,4,4), from a file: one matrix per line, 16 numbers row by row; `#` comments.

    format: "matrix", or 7 numbers per line, a translation in mm (t) and a unit quaternion: "t-xyzw", "t-wxyz",
    "xyzw-t", "wxyz-t".
    """
    count = ffi.new("size_t*")
    poses = guarded(made, "poses", lib.vxt_read_poses, encoded(path), encoded_text(format, "format"))
    return matrices_of(lib.vxt_poses_get(poses, count), count[0])


def read_camera(path: Union[str, os.PathLike[str]]) -> npt.NDArray[np.float64]:
    """Reads a camera, (4,4), clip_from_world, from a file."""
    found = ffi.new("double[16]")
    check(lib.vxt_read_camera(encoded(path), found))
    return matrix_of(found)


def read_opacity(source: Union[str, os.PathLike[str]]) -> npt.NDArray[np.float64]:
    """Reads opacity, (N,2), value and opacity: from a file (lines `value opacity`, or JSON), or from text like
    "40:0,80:1"."""
    if isinstance(source, str) and ":" in source and not os.path.exists(source):
        points = made("control_points", lib.vxt_parse_opacity, encoded_text(source, "opacity"))
    else:
        points = made("control_points", lib.vxt_read_transfer_function, encoded(source))
    return points_of(lib.vxt_control_points_get, points, 2)


class Points(NamedTuple):
    """A list of points read from a file."""

    #: (N,3), in the order of the file
    positions: npt.NDArray[np.float64]
    #: one per point; "" without a name
    names: tuple[str, ...]


def read_points(path: Union[str, os.PathLike[str]]) -> Points:
    """Reads points, mm in LPS: lines `x y z` or `x y z name`, or 3D Slicer's .fcsv or .mrk.json."""
    points, position = guarded(made, "points", lib.vxt_read_points, encoded(path)), ffi.new("double[3]")
    positions: list[list[float]] = []
    names: list[str] = []
    while name := lib.vxt_points_get(points, len(names), position, NULL):
        names.append(text_of(name))
        positions.append(list(position))
    return Points(np.array(positions, np.float64).reshape(-1, 3), tuple(names))


def write_png(path: Union[str, os.PathLike[str]], picture: npt.NDArray[np.uint8]) -> None:
    """Writes a picture (H,W,4) of uint8 as PNG."""
    pixels = np.ascontiguousarray(picture)
    if pixels.ndim != 3 or pixels.shape[2] != 4 or pixels.dtype != np.uint8:
        raise InvalidArgumentError(f"the picture is {pixels.dtype} of shape {pixels.shape}; uint8 of (H, W, 4) is needed")
    height, width, _ = pixels.shape
    check(lib.vxt_write_png(encoded(path), width, height, pointer("char", pixels.reshape(-1)), pixels.nbytes))
