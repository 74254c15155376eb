# SPDX-License-Identifier: MIT
"""Small files: poses, cameras, opacities, and pictures."""
from __future__ import annotations

import os
from typing import NamedTuple, Union

import numpy as np
import numpy.typing as npt

from . import _core as core
from ._common import encoded, encoded_text
from ._errors import InvalidArgumentError


def read_poses(path: Union[str, os.PathLike[str]]) -> npt.NDArray[np.float64]:
    """(N,4,4) from the program's files: one matrix a line, 16 numbers row by row; `#` comments."""
    return core.read_poses(encoded(path))


def read_camera(path: Union[str, os.PathLike[str]]) -> npt.NDArray[np.float64]:
    """(4,4), clip_from_world, from one of the program's files."""
    return core.read_camera(encoded(path))


def read_opacity(source: Union[str, os.PathLike[str]]) -> npt.NDArray[np.float64]:
    """(N,2), value and opacity: from a file (lines `value opacity`, or JSON), or from text like "40:0,80:1"."""
    if isinstance(source, str) and ":" in source and not os.path.exists(source):
        return core.parse_opacity(encoded_text(source, "opacity"))
    return core.read_opacity(encoded(source))


class Points(NamedTuple):
    """A list of points that was read."""

    #: (N,3), as they stand in the file
    positions: npt.NDArray[np.float64]
    #: of each; "": it has none
    names: tuple[str, ...]


def read_points(path: Union[str, os.PathLike[str]]) -> Points:
    """Points from a file: lines `x y z` or `x y z name`; `#` comments."""
    return Points(*core.read_points(encoded(path)))


def write_png(path: Union[str, os.PathLike[str]], picture: npt.NDArray[np.uint8]) -> None:
    """Writes a picture (H,W,4) of uint8 as PNG."""
    pixels = np.ascontiguousarray(picture)
    if pixels.ndim != 3 or pixels.shape[2] != 4 or pixels.dtype != np.uint8:
        raise InvalidArgumentError(f"the picture is {pixels.dtype} of shape {pixels.shape}; uint8 of (H, W, 4) is needed")
    core.write_png(encoded(path), pixels)
