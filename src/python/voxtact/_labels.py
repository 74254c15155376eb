# SPDX-License-Identifier: MIT
"""Label maps and label names."""
from __future__ import annotations

import difflib
import operator
import os
from typing import Any, NoReturn, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _handles as core
from ._common import check_made, encoded, not_pickled, numbers
from ._errors import InvalidArgumentError
from ._library import ffi, lib, made, text_of
from ._volume import Volume, read_volume


class Labels:
    """A label map: the structure of each voxel. `read_labels` creates one."""

    __slots__ = ("_core", "volume", "names")
    _core: core.Labels
    #: The image of the label map.
    volume: Volume
    #: The label names, if known.
    names: dict[int, str]

    def __init__(self, volume: Volume, names: Optional[dict[int, str]] = None) -> None:
        check_made(volume, Volume, "read_labels()")
        self._core = core.Labels(volume._core)
        self.volume = volume
        self.names = dict(names or {})

    @property
    def values(self) -> npt.NDArray[np.int32]:
        """The labels, ascending; includes 0."""
        return self._core.values

    def at(self, points: npt.ArrayLike) -> npt.NDArray[np.int32]:
        """Returns the labels (N,) at world points (N,3), LPS, mm: those of the nearest voxels; 0 outside."""
        return self._core.at(numbers(points, "points"))

    def along(self, start: npt.ArrayLike, end: npt.ArrayLike) -> npt.NDArray[np.int32]:
        """Returns the labels on the straight line from one world point (3,) to another, LPS, mm: in that order, each
        once, without 0. Labels that it only grazes may be missing."""
        return self._core.along(numbers(start, "start"), numbers(end, "end"))

    def number(self, label: Union[int, str]) -> int:
        """Returns the value of a label, given by value or name."""
        return self._number(label, "a label")

    def _number(self, label: Union[int, str], what: str) -> int:
        if not isinstance(label, str):
            try:
                if isinstance(label, (bool, np.bool_)):
                    raise TypeError
                given = operator.index(label)
            except TypeError:
                raise TypeError(f"{what} is {label!r}; its number or its name is needed") from None
            if not -2**31 <= given < 2**31:
                raise InvalidArgumentError(f"{what} is {given}; labels are from {-2**31} to {2**31 - 1}")
            return given
        found = [number for number, name in self.names.items() if name == label]
        if len(found) != 1:
            near = difflib.get_close_matches(label, self.names.values(), 3)
            raise InvalidArgumentError(f"{len(found)} labels are called {label!r}"
                                       + (f"; did you mean {', '.join(near)}?" if near and not found else ""))
        return found[0]

    def __repr__(self) -> str:
        return f"<voxtact.Labels {self.volume.name!r}: {len(self.values)} labels, {len(self.names)} names>"

    def __reduce__(self) -> NoReturn:
        not_pickled(self)


def read_label_names(path: Union[str, os.PathLike[str]]) -> dict[int, str]:
    """Reads label names: lines `number name`, such as MRIcron's; FreeSurfer's colour tables.

    Bytes in names that are not UTF-8 become surrogate escapes, as in Python's file names. Decode names of a file in
    Latin-1 by ``name.encode("utf-8", "surrogateescape").decode("latin-1")``.
    """
    found, label = made("label_names", lib.vxt_read_label_names, encoded(path)), ffi.new("int32_t*")
    names: dict[int, str] = {}
    index = 0
    while name := lib.vxt_label_names_get(found, index, label):
        names[label[0]] = text_of(name)
        index += 1
    return names


def _checked(names: Optional[dict[int, str]]) -> Optional[dict[int, str]]:
    for number, name in ({} if names is None else names).items():
        whole = hasattr(number, "__index__") and not isinstance(number, (bool, np.bool_))
        if not whole or not isinstance(name, str):
            raise TypeError(f"names has {number!r}: {name!r}; it is a dict of numbers and names")
    return names


def read_labels(source: Any, *, names: Union[None, dict[int, str], str, os.PathLike[str]] = None,
                **options: Any) -> Labels:
    """Reads a label map: an image of whole numbers that `read_volume` reads, on its own grid.

    names: the label names, as a dict or a file (see `read_label_names`).
    """
    if options.get("resample"):
        raise InvalidArgumentError("resample= is for images: labels are not interpolated")
    known = _checked(names) if names is None or isinstance(names, dict) else read_label_names(names)
    if isinstance(source, Labels):
        read_volume(source.volume, **options)  # the library does not use them
        return source if known is None else Labels(source.volume, known)
    return Labels(read_volume(source, **options), known)
