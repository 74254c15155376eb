# SPDX-License-Identifier: MIT
"""Exceptions of voxtact. A text is one line: the failure, the argument or file, and the fix."""
from __future__ import annotations

import errno
import os
import re
from typing import Optional

_SURROGATES = re.compile("[\ud800-\udfff]")


class Error(Exception):
    """Anything that voxtact refuses, or that failed. The classes below say what kind of thing it was."""

    #: What kind, as a word: "invalid-argument", "unsupported", …
    code = "error"
    #: The VkResult behind it; 0 where there is none.
    vk_result = 0

    def __str__(self) -> str:
        # What an argument looks like may have lines, and what a file has may be no UTF-8; this can be printed anywhere.
        text = str(self.args[0]) if self.args else ""
        return _SURROGATES.sub("\ufffd", " ".join(text.split("\n")))


class InvalidArgumentError(Error, ValueError):
    """An argument that can never be right: a wrong shape, a NaN, a number out of its range."""

    code = "invalid-argument"


class UnsupportedError(Error):
    """This device, this engine or this machine cannot do it; another one may."""

    code = "unsupported"


class LimitExceededError(Error):
    """A limit, named in the text with its size."""

    code = "limit-exceeded"


class OutOfMemoryError(Error, MemoryError):
    """Memory of the host or the device."""

    code = "out-of-memory"


class DeviceLostError(Error):
    """The Vulkan device is gone. Whatever was made with it refuses from now on; open it again."""

    code = "device-lost"


class VulkanError(Error):
    """Another failure of a Vulkan call; `vk_result` has its number."""

    code = "vulkan"


class FileError(Error, OSError):
    """A file that cannot be read or written."""

    code = "file"


class MissingFileError(FileError, FileNotFoundError):
    """A file, or a folder to write into, that is not there: with `errno` and `filename`."""


class FormatError(Error, ValueError):
    """A file that can be read, but what it holds cannot be used."""

    code = "format"


class NotReadyError(Error):
    """The object or output does not exist, or no longer: a closed scene, an output that was not requested."""

    code = "not-ready"


class InternalError(Error):
    """A bug in voxtact."""

    code = "internal"


# By the numbers of voxtact::ErrorCode.
_CLASSES: dict[int, type[Error]] = {
    1: InvalidArgumentError,
    2: UnsupportedError,
    3: LimitExceededError,
    4: OutOfMemoryError,
    5: DeviceLostError,
    6: VulkanError,
    7: FileError,
    8: FormatError,
    9: NotReadyError,
    10: InternalError,
}


def exception(code: int, text: str, vk_result: int) -> Error:
    """The exception of an error of the library."""
    made = _missing(text) if code == 7 else None
    made = made or _CLASSES.get(code, Error)(text)
    made.vk_result = vk_result
    return made


def _missing(text: str) -> Optional[Error]:
    """Of a text about a file, where that is not there."""
    about = re.match("cannot (read|write) '(.*?)': ", text, re.DOTALL)
    if about is None or os.path.lexists(about[2] if about[1] == "read" else os.path.dirname(about[2]) or "."):
        return None
    made = MissingFileError(text)
    made.errno = errno.ENOENT
    made.filename = about[2]
    return made
