# SPDX-License-Identifier: MIT
"""The shared library of the C interface: its place, its errors, and the memory that it shares with numpy."""
from __future__ import annotations

import os
import threading
from collections.abc import Callable
from typing import Any, Literal, NamedTuple, NoReturn, Union, get_args

import numpy as np
import numpy.typing as npt

from ._cdef import ffi as _ffi
from ._errors import Error, InvalidArgumentError, exception

#: A cffi object; cffi has no types.
CData = Any
ffi: Any = _ffi


def _load() -> Any:
    """Loads the library in the folder of this file, or the one in VOXTACT_LIBRARY; it stays loaded until the process ends,
    because objects may outlive modules."""
    place = os.environ.get("VOXTACT_LIBRARY") or os.path.join(os.path.dirname(__file__), "libvoxtact.so")
    try:
        return ffi.dlopen(place, ffi.RTLD_NOW | ffi.RTLD_LOCAL | getattr(ffi, "RTLD_NODELETE", 0))
    except OSError as error:
        raise ImportError(f"the library of voxtact cannot be loaded: {error}") from None


lib = _load()
NULL: CData = ffi.NULL


# Errors


def failure(result: int) -> Error:
    """Creates the exception of a vxt_result, with the calling thread's last error."""
    return exception(result, text_of(lib.vxt_last_error(NULL)), int(lib.vxt_last_vk_result(NULL)))


def check(result: int) -> None:
    """Raises the error of a failed library call."""
    if result:
        raise failure(result)


def refuse(text: str) -> NoReturn:
    raise InvalidArgumentError(text)


# Texts and structs


def text_of(chars: CData) -> str:
    """Decodes text; bytes that are not UTF-8 become surrogate escapes, as in Python's file names."""
    made: str = ffi.string(chars).decode("utf-8", "surrogateescape")
    return made


def texts_of(get: Callable[[int], CData]) -> list[str]:
    """Returns the texts that a function returns by index, up to a null."""
    texts: list[str] = []
    while chars := get(len(texts)):
        texts.append(text_of(chars))
    return texts


def struct(kind: str, **members: Any) -> CData:
    """Creates a struct that begins with struct_size."""
    made = ffi.new(f"vxt_{kind}*", members)
    made.struct_size = ffi.sizeof(f"vxt_{kind}")
    return made


def structs(kind: str, count: int) -> CData:
    """Creates an array of zeros, each with its struct_size."""
    made = ffi.new(f"vxt_{kind}[]", count)
    for one in made:
        one.struct_size = ffi.sizeof(f"vxt_{kind}")
    return made


# Objects

#: number of forks between this process and the one that loaded the library
_forks = 0
#: How to destroy each object with threads or on a device, by its address, and its parents. A forked child does not
#: destroy its parent's objects: it would wait for missing threads.
_bound: dict[int, tuple[Callable[[CData], None], CData, tuple[int, ...]]] = {}
_uses: dict[int, int] = {}
_waiting: set[int] = set()
_ending = threading.RLock()
_leaks = False


def forks() -> int:
    return _forks


def _after_fork() -> None:
    global _forks, _ending
    _forks += 1
    _ending = threading.RLock()
    for known in (_bound, _uses, _waiting):
        known.clear()  # type: ignore[attr-defined]


def leak() -> None:
    """Stops destroying objects: at the end of the process, modules and garbage go in any order."""
    global _leaks
    _leaks = True
    _bound.clear()


os.register_at_fork(after_in_child=_after_fork)


def _address(handle: CData) -> int:
    return int(ffi.cast("uintptr_t", handle))


def _end(address: int) -> None:
    """Destroys an object, or defers it until its dependent objects are destroyed: garbage goes in any order."""
    if address not in _bound:
        return
    if _uses.get(address):
        _waiting.add(address)
        return
    destroy, handle, parents = _bound.pop(address)
    destroy(handle)
    for parent in parents:
        _uses[parent] -= 1
        if parent in _waiting and not _uses[parent]:
            _waiting.discard(parent)
            _end(parent)


def _end_of(handle: CData) -> None:
    with _ending:
        _end(_address(handle))


def made(kind: str, create: Callable[..., int], *arguments: Any) -> CData:
    """Creates an object that is destroyed with its last reference. `create` writes a vxt_KIND* to its last argument."""
    place = ffi.new(f"vxt_{kind}**")
    check(create(*arguments, place))
    return ffi.gc(place[0], getattr(lib, f"vxt_{kind}_destroy"))


def made_with(parents: tuple[CData, ...], kind: str, create: Callable[..., int], *arguments: Any) -> CData:
    """Like `made`, for objects with threads or on a device; their parents are destroyed later."""
    place = ffi.new(f"vxt_{kind}**")
    check(create(*arguments, place))
    handle = place[0]
    if _leaks:
        return handle
    with _ending:
        those = tuple(map(_address, parents))
        for parent in those:
            _uses[parent] = _uses.get(parent, 0) + 1
        _uses[_address(handle)] = 0
        _bound[_address(handle)] = getattr(lib, f"vxt_{kind}_destroy"), handle, those
    return ffi.gc(handle, _end_of)


# Arrays


def shown(data: CData, shape: tuple[int, ...], dtype: npt.DTypeLike, owner: Any) -> npt.NDArray[Any]:
    """Returns an array over memory of the library; it keeps the memory's owner."""
    kind = np.dtype(dtype)
    size = kind.itemsize
    for length in shape:
        size *= length
    if size == 0:
        return np.empty(shape, kind)
    kept = ffi.gc(ffi.cast("char*", data), lambda _, _owner=owner: None)
    return np.frombuffer(ffi.buffer(kept, size), kind).reshape(shape)


def copied(data: CData, shape: tuple[int, ...], dtype: npt.DTypeLike = np.float64) -> npt.NDArray[Any]:
    """Returns a copy of memory of the library."""
    made = np.empty(shape, dtype)
    if made.size:
        ffi.memmove(ffi.from_buffer(made), data, made.nbytes)
    return made


def read_only(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    array.setflags(write=False)
    return array


def pointer(kind: str, array: npt.NDArray[Any]) -> CData:
    """Returns a pointer to the elements of a contiguous array; the pointer keeps the array."""
    return ffi.from_buffer(f"{kind}[]", array)


def doubles(array: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Returns a contiguous array of doubles, without a copy if possible."""
    return np.ascontiguousarray(array, dtype=np.float64)


def shape_text(array: npt.NDArray[Any]) -> str:
    return "(" + ",".join(map(str, array.shape)) + ")"


def vector(array: npt.NDArray[np.float64], what: str) -> list[float]:
    """Returns three numbers."""
    if array.shape != (3,):
        refuse(f"{what} has the shape {shape_text(array)}; (3,) is needed")
    return [float(number) for number in array]


def matrix(array: npt.NDArray[np.float64], what: str) -> list[float]:
    """Returns a (4,4) matrix in column-major order."""
    if array.shape != (4, 4):
        refuse(f"{what} has the shape {shape_text(array)}; (4,4) is needed")
    return [float(number) for number in array.T.reshape(-1)]


def matrix_of(columns: CData) -> npt.NDArray[np.float64]:
    """Returns the (4,4) matrix of 16 doubles of the library."""
    return copied(columns, (4, 4)).T.copy()


def matrices_of(columns: CData, count: int) -> npt.NDArray[np.float64]:
    return copied(columns, (count, 4, 4)).transpose(0, 2, 1).copy()


def named(word: Any, what: str, names: tuple[str, ...]) -> int:
    """Returns the index of a name in a list."""
    if not isinstance(word, str):
        raise TypeError(f"{what} cannot be {word!r}")
    if word not in names:
        refuse(f"{what} '{word}' is none of {', '.join(names)}")
    return names.index(word)


# Questions and their settings

Kind = Literal["number", "whole", "flag", "choice", "numbers", "labels"]  # in the order of vxt_fact_kind
_NUMBERS: dict[str, Callable[[float], Union[float, int, bool]]] = {"number": float, "whole": int, "flag": bool}


class SettingInfo(NamedTuple):
    """A setting of a question: `settings` lists them."""

    #: keyword of `Scene.ask`
    name: str
    kind: Kind
    #: None: the setting is optional
    default: Union[None, bool, int, float, str]
    #: "mm", "mm^2", "mm^3", "degrees", "voxels"; "" for none
    unit: str
    #: "from 1e-06 mm on"; of a choice its names, comma-separated
    range: str
    text: str
    #: limits of numbers
    min: float
    max: float


class QuestionInfo(NamedTuple):
    """A question about meshes at poses: `questions` lists them."""

    #: argument of `Scene.ask`
    name: str
    text: str


def _facts() -> dict[tuple[str, str], SettingInfo]:
    found: dict[tuple[str, str], SettingInfo] = {}
    fact = struct("fact")
    for index in range(lib.vxt_fact_count()):
        check(lib.vxt_fact_get(index, fact))
        kind: Kind = get_args(Kind)[fact.kind]
        question, name, unit, span, text, choices = (text_of(chars) for chars in (fact.question, fact.name, fact.unit, fact.range,
                                                                                  fact.text, fact.choices))
        default = choices.split(",")[0] if choices else _NUMBERS[kind](fact.standard) if fact.has_standard else None
        found[question, name] = SettingInfo(name, kind, default, unit, span, text, fact.min, fact.max)
    return found


#: By question and name.
FACTS = _facts()
__version__ = text_of(lib.vxt_version())


def questions() -> list[QuestionInfo]:
    """Returns the questions that `Scene.ask` answers, each with one line of text."""
    found: list[QuestionInfo] = []
    question = struct("question")
    for index in range(lib.vxt_question_count()):
        check(lib.vxt_question_get(index, question))
        found.append(QuestionInfo(text_of(question.name), text_of(question.text)))
    return found


def settings(question: str) -> list[SettingInfo]:
    """Returns the settings of a question: names, kinds, defaults, units, ranges and texts."""
    named(question, "question", tuple(one.name for one in questions()))
    return [fact for (of, _), fact in FACTS.items() if of == question]


def standard(question: str, name: str) -> Any:
    """Returns the default of a setting."""
    return FACTS[question, name].default


def not_zero(number: float, question: str, name: str) -> float:
    """Refuses 0, which selects the default in some structs of the library, with the library's text."""
    if number == 0:
        fact = FACTS[question, name]
        refuse(f"the {name.replace('_', ' ')} 0{' ' * bool(fact.unit)}{fact.unit} is not a number {fact.range}")
    return number
