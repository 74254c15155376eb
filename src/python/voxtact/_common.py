# SPDX-License-Identifier: MIT
"""Common parts of volumes and meshes."""
from __future__ import annotations

import operator
import os
from typing import Any, Literal, NoReturn, Union

import numpy as np
import numpy.typing as npt

from ._errors import InvalidArgumentError

#: "ras": +x right, +y anterior, +z superior, as NIfTI and nibabel have it; "lps": +x left, +y posterior, +z superior,
#: as DICOM, ITK and voxtact have it. Both in millimetres.
Space = Literal["ras", "lps"]

#: Maps points from RAS to LPS, and back: ``poses = LPS_FROM_RAS @ poses``.
LPS_FROM_RAS: npt.NDArray[np.float64] = np.diag([-1.0, -1.0, 1.0, 1.0])
LPS_FROM_RAS.setflags(write=False)

_FLOAT = np.dtype(np.float64)

#: Prefix of builtin volumes and meshes.
BUILTIN = "builtin:"


def encoded(path: Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]) -> bytes:
    """Encodes a path for the library; refuses a NUL character."""
    try:
        name = os.fsencode(path)
    except UnicodeEncodeError:
        raise InvalidArgumentError(f"the path {path!r} has a character that no file's name can have") from None
    if b"\0" in name:
        raise InvalidArgumentError(f"the path {path!r} has a null character")
    return name


def encoded_text(given: str, what: str) -> bytes:
    """Encodes text for the library; bytes that are not UTF-8 round-trip."""
    if not isinstance(given, str):
        raise TypeError(f"{what} is a {type(given).__name__}; a text is needed")
    try:
        return given.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:
        raise InvalidArgumentError(f"{what} is {given!r}, which has half a character") from None


def not_pickled(of: object) -> NoReturn:
    """Implements `__reduce__` of classes that cannot be pickled."""
    name = type(of).__name__
    raise TypeError(f"a voxtact.{name} cannot be pickled or copied: it is made of memory of this process; "
                    "make another one from the same file or arrays")


def no_truth(of: object, ask: str) -> NoReturn:
    """Implements `__bool__` of answers: refuses, because an object with rows would always be true."""
    raise TypeError(f"a voxtact.{type(of).__name__} is neither true nor false: it has rows; look at {ask}")


def restored(kind: type, slots: dict[str, Any]) -> Any:
    """Restores an object of a class with these slots from a pickle."""
    made: Any = object.__new__(kind)
    for name, value in slots.items():
        setattr(made, name, value)
    return made


def check_made(made_of: object, kind: type, by: str) -> None:
    """Refuses a direct call of the constructor of an answer."""
    if not isinstance(made_of, kind):
        raise TypeError(f"{by} makes one; a {type(made_of).__name__} cannot")


def array_of(given: Any, what: str) -> npt.NDArray[Any]:
    """Converts to an array, without a copy if possible. Refuses ragged rows and masked values."""
    if isinstance(given, np.ma.MaskedArray) and np.any(given.mask):
        raise InvalidArgumentError(f"{what}: some of the masked array is masked and has no value; fill it "
                                   "(`.filled(value)`)")
    try:
        return np.asarray(given)
    except ValueError as error:
        raise InvalidArgumentError(f"{what} is no array: its rows differ in length, or {error}") from None


def numbers(given: npt.ArrayLike, what: str) -> npt.NDArray[np.float64]:
    """Converts to a float64 array, without a copy if possible. Refuses complex numbers, texts and dates."""
    if type(given) is np.ndarray and given.dtype == _FLOAT:
        return given
    array = array_of(given, what)
    if array.dtype.kind not in "biufO":
        raise TypeError(f"{what} has the type {array.dtype}; numbers are needed")
    try:
        return array.astype(np.float64, copy=False)
    except OverflowError:
        raise InvalidArgumentError(f"{what} has a number that is too large") from None
    except (TypeError, ValueError):
        raise TypeError(f"{what} has what is no number") from None


def exact_in_float32(whole: npt.NDArray[Any]) -> bool:
    """Returns True if float32 represents each of these whole numbers exactly."""
    floats = whole.astype(np.float32)
    end = np.float32(2.0) ** (8 * whole.dtype.itemsize - (whole.dtype.kind == "i"))
    back = (floats >= -end) & (floats < end)  # types that convert back to a number
    return bool(back.all() and (floats.astype(whole.dtype) == whole).all())


def listed(given: Any, what: str) -> list[Any]:
    """Returns the items of a sequence. Refuses a text, whose items are letters."""
    if isinstance(given, (str, bytes)):
        raise TypeError(f"{what} is a {type(given).__name__}; a sequence is needed: [{given!r}]")
    try:
        iter(given)
    except TypeError:
        raise TypeError(f"{what} is a {type(given).__name__}; a sequence is needed") from None
    try:
        return list(given)
    except LookupError:  # a mapping has length and items, but is no sequence
        raise TypeError(f"{what} is a {type(given).__name__}; a sequence is needed") from None


def number(given: Any, what: str) -> float:
    """Converts to float. Refuses texts and truth values, which float() accepts."""
    kind = getattr(getattr(given, "dtype", None), "kind", "f")
    try:
        if not isinstance(given, (str, bytes, bytearray, bool)) and kind in ("i", "u", "f", "O"):
            return float(given)
    except OverflowError:
        raise InvalidArgumentError(f"{what} is too large a number") from None
    except (TypeError, ValueError):
        pass
    shown = " ".join(repr(given).split())  # multi-line representation of an array
    raise TypeError(f"{what} is {shown}; a number is needed")


def whole_number(given: Any, what: str, least: int = 0, most: int = 2**32 - 1) -> int:
    """Converts to a whole number within limits, which fit in unsigned 32 bits. Refuses truth values."""
    try:
        if isinstance(given, (bool, np.bool_)):
            raise TypeError
        found = operator.index(given)
    except TypeError:
        shown = " ".join(repr(given).split())  # multi-line representation of an array
        raise TypeError(f"{what} is {shown}; a whole number is needed") from None
    if not least <= found <= most:
        raise InvalidArgumentError(f"{what} is {found}; a whole number from {least} to {most} is needed")
    return found


def checked_space(space: Any, argument: str) -> Space:
    """Checks the name of a space, in any case."""
    lower = space.lower() if isinstance(space, str) else space
    if lower not in ("ras", "lps"):
        raise InvalidArgumentError(f"{argument}={space!r} is neither 'ras' nor 'lps'")
    return "ras" if lower == "ras" else "lps"
