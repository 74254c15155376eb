# SPDX-License-Identifier: MIT
"""The camera of projections and pictures."""
from __future__ import annotations

from typing import NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from ._arguments import Poses, whole
from ._common import numbers
from ._mesh import Mesh
from ._picture import view_options
from ._volume import Volume
from ._wish import view_from as clip_from_world


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
