# SPDX-License-Identifier: MIT
"""A mesh that moves by little from call to call."""
from __future__ import annotations

from typing import NamedTuple, NoReturn

import numpy.typing as npt

from . import _core as core
from ._common import check_made, not_pickled, numbers
from ._mesh import Mesh


class Tracked(NamedTuple):
    """What is known of a mesh at one of its poses: of `Tracker.update`."""

    #: it certainly touches
    hit: bool
    #: rounding decides whether it touches
    possible: bool
    #: mm: no point of the surface is nearer to what is opaque; 0 where it touches
    lo: float
    #: mm: some point of the surface is as near; infinite where that is not known
    hi: float
    #: the volume was looked into; False: it follows from what was known before
    searched: bool

    @property
    def free(self) -> bool:
        """It certainly does not touch."""
        return not (self.hit or self.possible)


class Tracker:
    """A mesh that is moved by little from call to call, as under a hand. `Scene.tracker` makes one.

    While the mesh has moved by no more than it was known to be clear, an answer follows from the one before and takes
    microseconds. Whether it touches never depends on the calls before; how near to each other the bounds are does.
    Changes of the scene are seen. Calls wait for other calls of the scene.
    """

    __slots__ = ("_core", "_mesh")
    _core: core.Tracker
    _mesh: Mesh

    def __init__(self, made_of: core.Tracker, mesh: Mesh) -> None:
        check_made(made_of, core.Tracker, "Scene.tracker()")
        self._core = made_of
        self._mesh = mesh

    @property
    def mesh(self) -> Mesh:
        """What moves."""
        return self._mesh

    def update(self, pose: npt.ArrayLike) -> Tracked:
        """The mesh is at another pose, (4,4), world_from_object: what is known of it there.

        Refuses poses that are not affine or not finite; then nothing has moved.
        """
        return Tracked(*self._core.update(numbers(pose, "pose")))

    def __repr__(self) -> str:
        return f"<voxtact.Tracker of {self._mesh.name!r}>"

    def __reduce__(self) -> NoReturn:
        not_pickled(self)
