# SPDX-License-Identifier: MIT
"""Arguments of questions: meshes, poses, points of opacity and progress, with their checks."""
from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Literal, Optional, Union

import numpy as np
import numpy.typing as npt

from ._common import numbers
from ._errors import InvalidArgumentError
from ._files import read_opacity
from ._mesh import Mesh
from ._volume import Volume

Projection = Literal["certified", "view", "two-view", "dominant-axis"]
Method = Literal["auto", "query", "query-any", "atomic", "subgroup", "compute", "cpu"]
#: Points (value, opacity), ascending; or text, "40:0,80:1"; or a file. None: from 0 to 1 over the domain.
Opacity = Union[None, npt.ArrayLike, str, "os.PathLike[str]"]
#: (N,4,4) or (4,4).
Poses = npt.ArrayLike
#: ``f(done, all)``, a bar of tqdm, or tqdm itself.
Progress = Union[None, Callable[[int, int], object], Any]


@contextmanager
def told(progress: Progress, pairs: int) -> Iterator[Optional[Callable[[int, int], object]]]:
    """Returns the callback of the library, called as callback(done, all)."""
    if progress is None:
        yield None
        return
    mine = isinstance(progress, type)
    bar: Any = progress(total=pairs) if mine else progress  # type: ignore[call-arg]
    if not hasattr(bar, "update"):
        if not callable(bar):
            raise TypeError("progress is a function of (done, all), a bar of tqdm, or tqdm itself")
        yield bar
        return
    if getattr(bar, "total", 0) is None:
        bar.total = pairs
    before = 0

    def tell(done: int, _: int) -> None:
        nonlocal before
        bar.update(done - before)
        before = done

    try:
        yield tell
    finally:
        if mine:
            bar.close()


def _poses(given: Any) -> npt.NDArray[np.float64]:
    """Returns the poses of a mesh. An empty list has no poses."""
    if type(given) is np.ndarray:
        return numbers(given, "poses")
    if hasattr(given, "__next__"):
        raise TypeError(f"poses is a {type(given).__name__}; a list of them or an array is needed, (N,4,4) or (4,4)")
    return np.zeros((0, 4, 4)) if isinstance(given, (list, tuple)) and len(given) == 0 else numbers(given, "poses")


def asked(mesh: Any, poses: Any, volume: Volume, level: int = 3) -> tuple[Any, Any]:
    """Returns a mesh with its poses, or a list of such pairs, in the library's form. Warns once for each volume if
    volume and mesh have different, unstated spaces. level: stack level of the warning."""
    if isinstance(mesh, Mesh):
        if poses is None:
            raise TypeError("poses are missing: (N,4,4) or (4,4), world_from_object, row by row, mm, LPS")
        if volume._assumed and mesh._assumed:
            volume._assumed = False
            warnings.warn("the volume's affine is taken to lead to RAS, as nibabel's does, and the mesh's vertices to be in LPS: say "
                          'space="ras" or space="lps" in read_volume() and read_mesh()', stacklevel=level)
        return mesh._core, _poses(poses)
    if poses is None and isinstance(mesh, Sequence) and not isinstance(mesh, (str, bytes)):
        pairs: list[tuple[Any, Any]] = []
        for one in mesh:
            if not (isinstance(one, Sequence) and len(one) == 2 and isinstance(one[0], Mesh)):
                raise TypeError(f"item {len(pairs)} of the list is no pair (mesh, poses) with a voxtact.Mesh, as "
                                "voxtact.read_mesh() makes it")
            pairs.append((one[0]._core, _poses(one[1])))
        return pairs, None
    raise TypeError(f"mesh is a {type(mesh).__name__}; voxtact.read_mesh() makes a voxtact.Mesh of it")


def count_of(poses: npt.NDArray[np.float64]) -> int:
    return 1 if poses.ndim == 2 else len(poses) if poses.ndim == 3 else 0


def pairs_in(mesh: Any, poses: Any) -> int:
    return count_of(poses) if poses is not None else sum(count_of(one[1]) for one in mesh)


def segments_in(mesh: Any, poses: Any) -> int:
    counts = [count_of(poses)] if poses is not None else [count_of(one[1]) for one in mesh]
    return sum(max(count - 1, 0) for count in counts)


def points(opacity: Opacity) -> Optional[npt.NDArray[np.float64]]:
    if opacity is None:
        return None
    if isinstance(opacity, (str, os.PathLike)):
        return read_opacity(opacity)
    return numbers(opacity, "opacity")


def whole(given: Any, count: int, what: str) -> list[int]:
    array = np.asarray(given)
    if array.shape != (count,) or array.dtype.kind not in "iu" or (array < 0).any() or (array >= 2**32).any():
        raise InvalidArgumentError(f"{what} is {given!r}; {count} whole numbers from 0 to {2**32 - 1} are needed")
    return [int(each) for each in array]


def pair(given: Any, what: str) -> tuple[float, float]:
    array = numbers(given, what)
    if array.shape != (2,):
        raise InvalidArgumentError(f"{what} is {given!r}; two numbers are needed")
    return float(array[0]), float(array[1])
