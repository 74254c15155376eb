# SPDX-License-Identifier: MIT
"""Exceptions of voxtact. A text is one line: the failure, the argument or file, and the fix."""
from __future__ import annotations

import errno
import os
import re
from typing import Optional

_SURROGATES = re.compile("[\ud800-\udfff]")


class Error(Exception):
    """Base class of all exceptions of voxtact. The classes below state the kind."""

    #: Kind of error: "invalid-argument", "unsupported", …
    code = "error"
    #: VkResult of the error; 0 if there is none.
    vk_result = 0

    def __str__(self) -> str:
        # Arguments may contain line breaks, and files bytes that are not UTF-8; the result is printable everywhere.
        text = str(self.args[0]) if self.args else ""
        return _SURROGATES.sub("\ufffd", " ".join(text.split("\n")))


class InvalidArgumentError(Error, ValueError):
    """An invalid argument: a wrong shape, a NaN, a number out of its range."""

    code = "invalid-argument"


class UnsupportedError(Error):
    """Not supported by this device, engine or machine; another may support it."""

    code = "unsupported"


class LimitExceededError(Error):
    """A limit was exceeded; the text names it with its value."""

    code = "limit-exceeded"


class OutOfMemoryError(Error, MemoryError):
    """Out of host or device memory."""

    code = "out-of-memory"


class DeviceLostError(Error):
    """The Vulkan device is lost. Its objects refuse all calls; open it again."""

    code = "device-lost"


class VulkanError(Error):
    """Another failure of a Vulkan call; `vk_result` has its number."""

    code = "vulkan"


class FileError(Error, OSError):
    """A file cannot be read or written."""

    code = "file"


class MissingFileError(FileError, FileNotFoundError):
    """A file or output folder does not exist; has `errno` and `filename`."""


class FormatError(Error, ValueError):
    """The contents of a file cannot be used."""

    code = "format"


class NotReadyError(Error):
    """The object or output does not exist: a closed scene, an output that was not requested."""

    code = "not-ready"


class InternalError(Error):
    """A bug in voxtact."""

    code = "internal"


# In the order of voxtact::ErrorCode.
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
    """Creates the exception for an error of the library."""
    made = _missing(text) if code == 7 else None
    made = made or _CLASSES.get(code, Error)(text)
    made.vk_result = vk_result
    return made


def _missing(text: str) -> Optional[Error]:
    """Creates a MissingFileError from the text about a missing file."""
    about = re.match("cannot (read|write) '(.*?)': ", text, re.DOTALL)
    if about is None or os.path.lexists(about[2] if about[1] == "read" else os.path.dirname(about[2]) or "."):
        return None
    made = MissingFileError(text)
    made.errno = errno.ENOENT
    made.filename = about[2]
    return made
