# SPDX-License-Identifier: MIT
"""What scenes answer: numpy arrays, made when they are looked at."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, NoReturn, Optional

import numpy as np
import numpy.typing as npt

from . import _core as core
from ._common import not_pickled
from ._errors import NotReadyError

if TYPE_CHECKING:
    from ._scene import Scene

_OUTPUTS = ("triangles", "contacts", "bounds", "labels")
_ENDS = np.array(["closed", "beyond", "rounding", "budget"])


class Answer:
    """What `Scene.detect` found: a row for each pair of a mesh and a pose, in the order in which they were given."""

    __slots__ = ("_core", "_scene", "_later")
    _core: core.Answer
    _scene: Optional[Scene]
    _later: Optional[dict[str, core.Answer]]

    def __init__(self, made_of: core.Answer, scene: Optional[Scene]) -> None:
        self._core = made_of
        self._scene = scene
        self._later = None

    @property
    def hit(self) -> npt.NDArray[np.bool_]:
        """(N,): it certainly touches."""
        return self._core.hit

    @property
    def possible(self) -> npt.NDArray[np.bool_]:
        """(N,): nothing certain, but rounding leaves it open; projection "conservative" alone."""
        return self._core.possible

    @property
    def count(self) -> npt.NDArray[np.uint64]:
        """(N,): how many fragments of the mesh are in what is opaque; 0 or 1 where yes or no was asked."""
        return self._core.count

    @property
    def exact(self) -> npt.NDArray[np.bool_]:
        """(N,): the count is the count; elsewhere there are at least so many."""
        return self._core.exact

    @property
    def item(self) -> npt.NDArray[np.uint32]:
        """(N,): the number of the mesh in the list that was given; 0 for a single one."""
        return self._core.item

    @property
    def pose(self) -> npt.NDArray[np.uint32]:
        """(N,): the number of the pose among those of its mesh."""
        return self._core.pose

    @property
    def triangles(self) -> npt.NDArray[np.void]:
        """The touched triangles: `pair`, `triangle`, `count`; by pair, then by triangle."""
        return self._output("triangles").triangles

    @property
    def contacts(self) -> npt.NDArray[np.void]:
        """A row for each fragment that touches, by pair, triangle and place.

        `pair`; `triangle`; `position` (3), LPS, mm, on the triangle; `normal` (3), unit, out of what is opaque, 0 where
        there is none; `depth`, mm along the normal to where the opacity ends; `value` and `opacity` of the image there;
        `label`, 0 without a label map.
        """
        return self._output("contacts").contacts

    @property
    def contacts_found(self) -> int:
        """How many there are; more than rows in `contacts` where that was cut at `most_contacts`."""
        return self._output("contacts").contacts_found

    @property
    def bounds(self) -> npt.NDArray[np.float64]:
        """(N,2,3): the least and the greatest corner of each pair's contacts, LPS, mm; NaN where there is none."""
        return self._output("bounds").bounds

    @property
    def labels(self) -> npt.NDArray[np.void]:
        """Fragments by label: `pair`, `label`, `count`. The scene needs labels."""
        return self._output("labels").labels

    @property
    def method(self) -> str:
        """What counted."""
        return self._core.method

    @property
    def projection(self) -> str:
        """What gave the fragments."""
        return self._core.projection

    @property
    def seconds(self) -> float:
        """What the engine took."""
        return self._core.milliseconds / 1000

    def _output(self, name: str) -> core.Answer:
        """The answer that has an output; asks again where it was not asked for."""
        if self._core.outputs[_OUTPUTS.index(name)]:
            return self._core
        if self._later is None:
            self._later = {}
        if name not in self._later:
            if self._scene is None:
                raise NotReadyError(f"answers of within() and around() have no {name}: ask detect(), which is about touching")
            again = self._scene._core.again(self._core, name)
            if again is None:
                raise NotReadyError(f"the scene has changed since this answer: detect({name}=True) asks for its {name} "
                                    "in the same go")
            self._later[name] = again
        return self._later[name]

    def plot(self, ax: Any = None) -> Any:
        """The counts over the poses, with matplotlib; the axes. What touches is red, what is possible is hollow."""
        from ._plot import plot_answer

        return plot_answer(self, ax)

    def __len__(self) -> int:
        return len(self._core)

    def __repr__(self) -> str:
        hits, possible = int(self.hit.sum()), int(self.possible.sum())
        more = f", {possible} possibly" if possible else ""
        return f"<voxtact.Answer: {hits} of {len(self)} poses touch{more}; {self.projection}, {self.method}>"

    def __reduce__(self) -> NoReturn:
        not_pickled(self)


class Clearance:
    """What `Scene.clearance` found: a row for each pair, in order; to labels, a column for each."""

    __slots__ = ("_core",)
    _core: core.Clearances

    def __init__(self, made_of: core.Clearances) -> None:
        self._core = made_of

    @property
    def lo(self) -> npt.NDArray[np.float64]:
        """(N,) or (N,L): no point of the surface is nearer to what is opaque, mm. 0 where it touches."""
        return self._core.lo

    @property
    def hi(self) -> npt.NDArray[np.float64]:
        """(N,) or (N,L): some point of the surface is as near, mm. Infinite beyond the maximum, or where nothing is."""
        return self._core.hi

    @property
    def end(self) -> npt.NDArray[np.str_]:
        """Why the bounds are no nearer to each other.

        "closed" (within the tolerance), "beyond" (the maximum), "rounding" (which decides what is left) or "budget"
        (`most_steps`).
        """
        names: npt.NDArray[np.str_] = _ENDS[self._core.end]
        return names

    @property
    def closest(self) -> npt.NDArray[np.void]:
        """(N,): two points as far apart as `hi`, LPS, mm: `triangle` (-1: there is none, the rest is NaN), `mesh` (3) on it and
        `volume` (3), opaque; and how the distance changes with the pose: `per_translation` (3), mm per mm along the
        world's axes, and `per_rotation` (3), mm per radian about the parallels of these through the object's origin.
        """
        if self.labels.size:
            raise NotReadyError("clearances to labels have no closest points")
        return self._core.closest

    @property
    def labels(self) -> npt.NDArray[np.int32]:
        """(L,): of the columns; empty where it is not about labels."""
        return self._core.labels

    @property
    def item(self) -> npt.NDArray[np.uint32]:
        """(N,): the number of the mesh in the list that was given; 0 for a single one."""
        return self._core.item

    @property
    def pose(self) -> npt.NDArray[np.uint32]:
        """(N,): the number of the pose among those of its mesh."""
        return self._core.pose

    @property
    def seconds(self) -> float:
        """What the engine took."""
        return self._core.milliseconds / 1000

    def plot(self, ax: Any = None) -> Any:
        """The bounds over the poses, mm, with matplotlib; the axes."""
        from ._plot import plot_clearance

        return plot_clearance(self, ax)

    def __len__(self) -> int:
        return len(self._core)

    def __repr__(self) -> str:
        if not self.lo.size:
            return "<voxtact.Clearance of no poses>"
        to = f" to {len(self.labels)} labels" if self.labels.size else ""
        return f"<voxtact.Clearance of {len(self)} poses{to}: the least is {self.lo.min():.4g} to {self.hi.min():.4g} mm>"

    def __reduce__(self) -> NoReturn:
        not_pickled(self)
