# SPDX-License-Identifier: MIT
"""Boxes and the broad phase."""
from __future__ import annotations

from typing import Optional

import numpy as np
import numpy.typing as npt

from ._common import numbers
from ._errors import InvalidArgumentError
from ._library import NULL, copied, doubles, ffi, lib, made, pointer
from ._turns import guarded


def _boxes(given: npt.ArrayLike, what: str) -> npt.NDArray[np.float64]:
    boxes = numbers(given, what)
    if boxes.ndim != 3 or boxes.shape[1:] != (2, 3):
        raise InvalidArgumentError(f"{what} are no (N,2,3): the least and the greatest corner of each")
    return doubles(boxes)


def overlapping_pairs(boxes: npt.ArrayLike, others: Optional[npt.ArrayLike] = None) -> npt.NDArray[np.uint32]:
    """Finds the boxes that share a point (broad phase); touching counts.

    boxes, others
        (N,2,3): minimum and maximum corner of each box, as from `Mesh.boxes_at`; a box with a NaN, or whose minimum
        exceeds its maximum, shares nothing

    Returns (M,2), sorted: two indices into `boxes`, the first less than the second; with `others`, an index into each.

        near = vx.overlapping_pairs(knife.boxes_at(poses), [head.bounds])[:, 0]   # poses that may touch at all
    """
    left = _boxes(boxes, "boxes")
    # The pointer of an empty list is not null: null would stand for the boxes themselves.
    right = np.zeros((1, 2, 3)) if others is None else np.concatenate([_boxes(others, "others"), np.zeros((1, 2, 3))])
    pairs = guarded(made, "box_pairs", lib.vxt_overlapping_pairs, ffi.cast("vxt_box*", pointer("double", left)), len(left),
                    NULL if others is None else ffi.cast("vxt_box*", pointer("double", right)), len(right) - 1)
    count = ffi.new("size_t*")
    found = lib.vxt_box_pairs_get(pairs, count)
    return copied(found, (count[0], 2), np.uint32)
