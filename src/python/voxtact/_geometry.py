# SPDX-License-Identifier: MIT
"""Boxes and the broad phase."""
from __future__ import annotations

from typing import Optional

import numpy as np
import numpy.typing as npt

from . import _core as core
from ._common import numbers


def overlapping_pairs(boxes: npt.ArrayLike, others: Optional[npt.ArrayLike] = None) -> npt.NDArray[np.uint32]:
    """The broad phase: which boxes share a point, touching included.

    boxes, others
        (N,2,3): the least and the greatest corner of each, as `Mesh.boxes_at` has them; one with a NaN, or whose
        least corner is greater than the other, shares nothing

    (M,2), sorted: numbers of `boxes`, the first less than the second; or with `others` a number of each.

        near = vx.overlapping_pairs(knife.boxes_at(poses), [head.bounds])[:, 0]   # poses that may touch at all
    """
    return core.overlapping_pairs(numbers(boxes, "boxes"), None if others is None else numbers(others, "others"))
