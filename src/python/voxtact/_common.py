# SPDX-License-Identifier: MIT
"""What volumes and meshes have in common."""
from __future__ import annotations

from typing import Literal, NoReturn

import numpy as np
import numpy.typing as npt

from ._errors import InvalidArgumentError

#: "ras": +x right, +y anterior, +z superior, as NIfTI and nibabel have it; "lps": +x left, +y posterior, +z superior,
#: as DICOM, ITK and voxtact have it. Both in millimetres.
Space = Literal["ras", "lps"]

#: Takes points of RAS to LPS, and back: ``poses = LPS_FROM_RAS @ poses``.
LPS_FROM_RAS: npt.NDArray[np.float64] = np.diag([-1.0, -1.0, 1.0, 1.0])
LPS_FROM_RAS.setflags(write=False)

#: What names of volumes and meshes that need no file begin with.
BUILTIN = "builtin:"


def not_pickled(of: object) -> NoReturn:
    """What `__reduce__` of each class does."""
    name = type(of).__name__
    raise TypeError(f"a voxtact.{name} cannot be pickled or copied: it is made of memory of this process; "
                    "make another one from the same file or arrays")


def check_space(space: str, argument: str) -> None:
    if space not in ("ras", "lps"):
        raise InvalidArgumentError(f"{argument}={space!r} is neither 'ras' nor 'lps'")
