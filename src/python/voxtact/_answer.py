# SPDX-License-Identifier: MIT
"""What scenes answer: numpy arrays, made when they are looked at."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core as core
from ._common import Kept, check_made, members_of, no_truth, restored
from ._errors import NotReadyError

if TYPE_CHECKING:
    from ._scene import Scene

_OUTPUTS = ("triangles", "contacts", "bounds", "labels")
_MEMBERS = ("hit", "possible", "count", "exact", "item", "pose", "method", "projection", "counters", "milliseconds",
            "device_milliseconds", "contacts_found", *_OUTPUTS)
_MEASURED_MEMBERS = ("lo", "hi", "end", "labels", "item", "pose", "milliseconds")
_CLEARANCE_MEMBERS = (*_MEASURED_MEMBERS, "closest")
_AREA_MEMBERS = (*_MEASURED_MEMBERS, "triangles", "by_triangle")
_ENDS = np.array(["closed", "beyond", "rounding", "budget"])
_AREA_ENDS = np.array(["closed", "rounding", "budget"])


class Counters(NamedTuple):
    """What the passes of the projection "conservative" did on a device for all poses: docs/engine.md.

    Of each peak (`most_…`): in the round that had most.
    """

    #: of 64 triangles, once for each pair, that were looked at
    clusters: int
    #: of these, may touch
    clusters_kept: int
    #: of 16 triangles, may touch
    runs_kept: int
    #: shares of triangles with more than 27 cells
    large_parts: int
    #: of these triangles, looked at
    bricks_seen: int
    #: of all triangles in bricks that may be opaque, looked at
    cells_seen: int
    #: of these, need a decision
    cells_listed: int
    #: of cells_seen, count without one: opaque all over, and a triangle clearly in them
    cells_certain: int
    #: by a lane each; the others are of pairs that touch anyway, or had no room
    cells_decided: int
    #: dispatched for them
    lanes: int
    #: of these, left undecided by single precision
    cells_open: int
    #: what a queue had no room for: shares of work groups
    left: int
    #: looked at for these
    bricks_left: int
    #: looked at for these, and decided where they need it
    cells_left: int
    #: dispatches of each pass
    rounds: int
    #: clusters that a round can have
    room: int
    #: peak of clusters_kept
    most_clusters: int
    #: peak of runs_kept
    most_runs: int
    #: peak of large_parts, those without room among them
    most_parts: int
    #: peak of cells_listed, those without room among them
    most_cells: int
    #: peak of cells_open
    most_open: int
    #: peak of left
    most_left: int
    #: peak of bricks_seen and cells_seen together
    most_looks: int
    #: peak of bricks_left and cells_left together
    most_looks_left: int


class Answer:
    """What `Scene.detect` found: a row for each pair of a mesh and a pose, in the order in which they were given."""

    __slots__ = ("_core", "_scene", "_later")
    _core: Union[core.Answer, Kept]
    _scene: Optional[Scene]
    _later: Optional[dict[str, core.Answer]]

    def __init__(self, made_of: core.Answer, scene: Optional[Scene]) -> None:
        check_made(made_of, core.Answer, "Scene.detect()")
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
    def device_seconds(self) -> float:
        """What the device was at work for it; 0 on the host, and where its queue has no timestamps."""
        return self._core.device_milliseconds / 1000

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
    def counters(self) -> Counters:
        """What a device did, of ``detect(counters=True)``; others raise NotReadyError."""
        numbers = self._core.counters
        if numbers is None:
            raise NotReadyError("nothing was counted: detect(counters=True) asks for it, of a scene on a device")
        return Counters(*numbers)

    @property
    def seconds(self) -> float:
        """What the engine took."""
        return self._core.milliseconds / 1000

    def _output(self, name: str) -> Union[core.Answer, Kept]:
        """The answer that has an output; asks again where it was not asked for."""
        if self._core.outputs[_OUTPUTS.index(name)]:
            return self._core
        if self._later is None:
            self._later = {}
        if name not in self._later:
            core = self._core
            if isinstance(core, Kept) and core.of_scene:
                raise NotReadyError(f"an answer that was pickled or copied knows no scene: detect({name}=True) asks for its "
                                    f"{name} in the same go, and looking at them before keeps them, too")
            if self._scene is None or isinstance(core, Kept):
                raise NotReadyError(f"answers of within() and around() have no {name}: ask detect(), which is about touching")
            again = self._scene._core.again(core, name)
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

    def __bool__(self) -> NoReturn:
        no_truth(self, ".hit, or .hit.any()")

    def __reduce__(self) -> tuple[Any, ...]:
        members = members_of(self._core, _MEMBERS)
        later = self._later or {}
        for name, answer in later.items():
            members.update(members_of(answer, (name, "contacts_found") if name == "contacts" else (name,)))
        members["of_scene"] = self._core.of_scene if isinstance(self._core, Kept) else self._scene is not None
        members["outputs"] = tuple(known or name in later for known, name in zip(self._core.outputs, _OUTPUTS))
        return restored, (Answer, {"_core": Kept(len(self), members), "_scene": None, "_later": None})


class _Measured:
    """What clearances and areas have in common."""

    __slots__ = ("_core",)
    _core: Union[core.Clearances, core.Areas, Kept]

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

    def __len__(self) -> int:
        return len(self._core)

    def __bool__(self) -> NoReturn:
        no_truth(self, ".lo and .hi")


class Clearance(_Measured):
    """What `Scene.clearance` found: a row for each pair, in order; to labels, a column for each."""

    __slots__ = ()
    _core: Union[core.Clearances, Kept]

    def __init__(self, made_of: core.Clearances) -> None:
        check_made(made_of, core.Clearances, "Scene.clearance()")
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
        """(N,): two points as far apart as `hi`, by a device no farther, LPS, mm: `triangle` (-1: there is none, the rest
        is NaN), `mesh` (3) on it and `volume` (3), opaque; and how the distance changes with the pose:
        `per_translation` (3), mm per mm along the world's axes, and `per_rotation` (3), mm per radian about the parallels
        of these through the object's origin.
        """
        if self.lo.ndim == 2:
            raise NotReadyError("clearances to labels have no closest points")
        return self._core.closest

    def plot(self, ax: Any = None) -> Any:
        """The bounds over the poses, mm, with matplotlib; the axes."""
        from ._plot import plot_clearance

        return plot_clearance(self, ax)

    def __repr__(self) -> str:
        if not len(self):
            return "<voxtact.Clearance of no poses>"
        to = f" to {len(self.labels)} labels" if self.lo.ndim == 2 else ""
        if not self.lo.size:
            return f"<voxtact.Clearance of {len(self)} poses{to}>"
        return f"<voxtact.Clearance of {len(self)} poses{to}: the least is {self.lo.min():.4g} to {self.hi.min():.4g} mm>"

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (Clearance, {"_core": Kept(len(self), members_of(self._core, _CLEARANCE_MEMBERS))})


class Area(_Measured):
    """What `Scene.area` found: a row for each pair, in order; in labels, a column for each."""

    __slots__ = ()
    _core: Union[core.Areas, Kept]

    def __init__(self, made_of: core.Areas) -> None:
        check_made(made_of, core.Areas, "Scene.area()")
        self._core = made_of

    @property
    def lo(self) -> npt.NDArray[np.float64]:
        """(N,) or (N,L): so much of the surface is certainly opaque, mm^2."""
        return self._core.lo

    @property
    def hi(self) -> npt.NDArray[np.float64]:
        """(N,) or (N,L): no more of the surface is opaque, mm^2."""
        return self._core.hi

    @property
    def end(self) -> npt.NDArray[np.str_]:
        """Why the bounds are no nearer to each other.

        "closed" (within the tolerance), "rounding" (which decides what is left) or "budget" (`most_steps`).
        """
        names: npt.NDArray[np.str_] = _AREA_ENDS[self._core.end]
        return names

    @property
    def triangles(self) -> npt.NDArray[np.void]:
        """(T,): those that may have an area, by pair, then by number: `pair`, `triangle`, its own area `whole`, and `lo`
        and `hi`, mm^2. Of `triangles=True` only.
        """
        if not self._core.by_triangle:
            raise NotReadyError("areas of triangles were not asked for; measure with triangles=True")
        return self._core.triangles

    def plot(self, ax: Any = None) -> Any:
        """The bounds over the poses, mm^2, with matplotlib; the axes."""
        from ._plot import plot_area

        return plot_area(self, ax)

    def __repr__(self) -> str:
        if not len(self):
            return "<voxtact.Area of no poses>"
        to = f" in {len(self.labels)} labels" if self.lo.ndim == 2 else ""
        if not self.lo.size:
            return f"<voxtact.Area of {len(self)} poses{to}>"
        return f"<voxtact.Area of {len(self)} poses{to}: the largest is {self.lo.max():.4g} to {self.hi.max():.4g} mm^2>"

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (Area, {"_core": Kept(len(self), members_of(self._core, _AREA_MEMBERS))})
