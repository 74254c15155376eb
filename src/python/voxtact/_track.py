# SPDX-License-Identifier: MIT
"""Distances of a mesh that moves in small steps."""
from __future__ import annotations

from typing import NamedTuple, NoReturn

import numpy.typing as npt

from . import _engine as core
from ._common import check_made, not_pickled, numbers
from ._mesh import Mesh


class Tracked(NamedTuple):
    """The answer of `Tracker.update`: certified bounds at one pose."""

    #: it certainly touches
    touches: bool
    #: rounding leaves it undecided
    undecided: bool
    #: mm: lower bound of the distance; 0 if it touches
    lower: float
    #: mm: upper bound; infinite if unknown
    upper: float
    #: the volume was searched; False: the answer follows from earlier ones
    searched: bool

    @property
    def free(self) -> bool:
        """True: the mesh certainly does not touch."""
        return not (self.touches or self.undecided)


class Tracker:
    """A mesh that moves in small steps, as in haptics. `Scene.tracker` creates one.

    While the mesh has moved by less than its known distance, an answer follows from the previous one, without a search.
    Verdicts never depend on earlier calls; the width of the bounds does. Updates use changes of the scene. Calls wait
    for other calls of the scene.
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
        """The moving mesh."""
        return self._mesh

    def update(self, pose: npt.ArrayLike) -> Tracked:
        """Moves the mesh to a pose, (4,4), world_from_object, and returns the bounds there.

        Refuses poses that are not affine or not finite; the mesh then does not move.
        """
        return Tracked(*self._core.update(numbers(pose, "pose")))

    def __repr__(self) -> str:
        return f"<voxtact.Tracker of {self._mesh.name!r}>"

    def __reduce__(self) -> NoReturn:
        not_pickled(self)
