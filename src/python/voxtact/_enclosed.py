# SPDX-License-Identifier: MIT
"""Finds an opaque region that a closed mesh encloses without touching it, for a warning."""
from __future__ import annotations

from typing import Optional

import numpy as np
import numpy.typing as npt

from ._mesh import Mesh
from ._volume import Volume

_ALONG_A_SIDE = 64
_TRIED = 16
_DIRECTION = np.array([0.5377, 0.3182, 0.7807])  # a direction parallel to no edge


def _is_closed(mesh: Mesh) -> bool:
    """Returns True if each edge belongs to two triangles; corners at one position are one vertex."""
    _, places = np.unique(mesh.vertices, axis=0, return_inverse=True)
    corners = places.reshape(-1)[mesh.faces]
    edges = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    return bool((np.unique(edges, axis=0, return_counts=True)[1] == 2).all())


def _some_opaque(volume: Volume, opacity: npt.NDArray[np.float64], threshold: float) -> npt.NDArray[np.float64]:
    """(N,3): centres of opaque voxels from all parts of the volume, world mm."""
    steps = [-(-length // _ALONG_A_SIDE) for length in volume.shape]
    values = volume.array[tuple(slice(step // 2, None, step) for step in steps)]
    found = np.argwhere(np.interp(values, opacity[:, 0], opacity[:, 1]) >= threshold)
    numbers = (found * steps + np.array(steps) // 2)[:, ::-1]
    matrix = volume.world_from_index
    return np.asarray(numbers @ matrix[:3, :3].T + matrix[:3, 3])


def enclosed(volume: Volume, opacity: npt.NDArray[np.float64], threshold: float, mesh: Mesh,
             pose: npt.NDArray[np.float64]) -> Optional[npt.NDArray[np.float64]]:
    """Returns an opaque point (3,) inside a closed mesh at a pose, world mm; None if no tested point is inside."""
    world = mesh.vertices.astype(np.float64) @ pose[:3, :3].T + pose[:3, 3]
    lo, hi = world.min(axis=0), world.max(axis=0)
    places = _some_opaque(volume, opacity, threshold)
    places = places[((places > lo) & (places < hi)).all(axis=1)]
    if not len(places) or not _is_closed(mesh):
        return None
    a, b, c = (world[mesh.faces[:, corner]] for corner in range(3))
    u, v = b - a, c - a
    normal = np.cross(_DIRECTION, v)
    size = (u * normal).sum(axis=1)
    for place in places[np.argsort(np.linalg.norm(places - (lo + hi) / 2, axis=1))[:_TRIED]]:
        with np.errstate(divide="ignore", invalid="ignore"):
            s = ((place - a) * normal).sum(axis=1) / size
            other = np.cross(place - a, u)
            t, along = (other @ _DIRECTION) / size, (v * other).sum(axis=1) / size
        if ((s >= 0) & (t >= 0) & (s + t < 1) & (along > 0)).sum() % 2:
            return np.array(place)
    return None
