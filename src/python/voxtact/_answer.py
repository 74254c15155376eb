# SPDX-License-Identifier: MIT
"""Answers of scenes: numpy arrays, created on access."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, Optional

import numpy as np
import numpy.typing as npt

from ._common import check_made, no_truth, restored
from ._errors import NotReadyError
from ._handles import METHODS, Labels
from ._library import named
from ._tables import UNDECIDED, YES, Tables

if TYPE_CHECKING:
    from ._scene import Scene

_INSIDE = np.array(["none", "some", "all", "undecided"])
_OUTPUTS = ("triangles", "contacts", "bounds", "labels")  # by the bits of vxt_output
_ENDS = np.array(["closed", "beyond", "rounding", "budget"])
_WITNESS = np.dtype([("triangle", np.int64), ("position", np.float64, 3), ("label", np.int32)], align=True)
_INSIDE_MESH = 2**32 - 1  # triangle of a witness point that is on none
_CLOSEST = np.dtype([("triangle", np.int64), ("mesh", np.float64, 3), ("volume", np.float64, 3),
                     ("per_translation", np.float64, 3), ("per_rotation", np.float64, 3)])


class Counters(NamedTuple):
    """Counters of the passes of the projection "certified" on a device, for all poses: docs/engine.md.

    `peak_…`: peaks of a round.
    """

    #: clusters of 64 triangles that were tested, once for each pair
    clusters: int
    #: of these, those that may touch
    clusters_kept: int
    #: runs of 16 triangles that may touch
    runs_kept: int
    #: shares of triangles with more than 27 cells
    large_parts: int
    #: bricks of these triangles that were tested
    bricks_seen: int
    #: cells of all triangles that were tested, in bricks that may be opaque
    cells_seen: int
    #: of these, cells that need a decision
    cells_listed: int
    #: of cells_seen, counted without a decision: opaque, a triangle clearly inside
    cells_certain: int
    #: cells that a lane decided; others: the pair touches anyway, or no room
    cells_decided: int
    #: lanes dispatched for these cells
    lanes: int
    #: of these, cells that single precision left undecided
    cells_open: int
    #: shares of work groups for which a queue had no room
    left: int
    #: bricks tested for these
    bricks_left: int
    #: cells tested for these, and decided if needed
    cells_left: int
    #: dispatches of each pass
    rounds: int
    #: maximum number of clusters in a round
    room: int
    #: peak of clusters_kept
    peak_clusters: int
    #: peak of runs_kept
    peak_runs: int
    #: peak of large_parts, including those without room
    peak_parts: int
    #: peak of cells_listed, including those without room
    peak_cells: int
    #: peak of cells_open
    peak_open: int
    #: peak of left
    peak_left: int
    #: peak of bricks_seen and cells_seen together
    peak_tests: int
    #: peak of bricks_left and cells_left together
    peak_tests_left: int


def _triangles_of(rows: npt.NDArray[Any]) -> npt.NDArray[np.int64]:
    triangles = rows["triangle"].astype(np.int64)
    return np.where((rows["witness"] == 0) | (triangles == _INSIDE_MESH), -1, triangles)


class _Answer:
    """Common part of all answers about pairs."""

    __slots__ = ("_tables",)
    _tables: Tables

    @property
    def item(self) -> npt.NDArray[np.uint32]:
        """(N,): index of the mesh in the given list; 0 for a single mesh."""
        return self._tables.item()

    @property
    def pose(self) -> npt.NDArray[np.uint32]:
        """(N,): index of the pose among those of its mesh."""
        return self._tables.pose()

    @property
    def seconds(self) -> float:
        """Duration in the engine."""
        return self._tables.milliseconds / 1000

    def __len__(self) -> int:
        return len(self._tables)


class Answer(_Answer):
    """The answer of `Scene.ask`: tables of rows, `answer["pairs"]`.

    The main table, "pairs" or "segments", has a row for each pair or segment, in order; `item` and `pose` number the
    meshes and poses as given, `pair` the rows of the main table. "totals" has one row.
    """

    __slots__ = ()

    def __init__(self, made_of: Tables) -> None:
        check_made(made_of, Tables, "Scene.ask()")
        self._tables = made_of

    @property
    def question(self) -> str:
        """The name of the question."""
        return self._tables.question

    @property
    def tables(self) -> tuple[str, ...]:
        """The names of the tables."""
        return tuple(self._tables.names())

    def __getitem__(self, table: str) -> npt.NDArray[np.void]:
        named(table, "the table", self.tables)
        return self._tables.rows(table)

    def __repr__(self) -> str:
        return f"<voxtact.Answer: {self.question}, {len(self)} rows; tables {', '.join(self.tables)}>"

    def __bool__(self) -> NoReturn:
        no_truth(self, f'["{self.tables[0]}"]')

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (Answer, {"_tables": self._tables})


class _Decided(_Answer):
    """An answer with a certified yes or no for each pair."""

    __slots__ = ()

    @property
    def touches(self) -> npt.NDArray[np.bool_]:
        """(N,): the pair certainly touches."""
        return self._tables.touch_is(YES)

    @property
    def undecided(self) -> npt.NDArray[np.bool_]:
        """(N,): rounding leaves the pair undecided. Neither `touches` nor `undecided`: certainly no contact."""
        return self._tables.touch_is(UNDECIDED)

    @property
    def device_seconds(self) -> float:
        """Duration on the device; 0 on the host, and if the queue has no timestamps."""
        return self._tables.total("gpu_milliseconds") / 1000

    @property
    def method(self) -> str:
        """The counting method; "cpu" on the host."""
        return METHODS[self._tables.method()]

    def _verdicts(self) -> str:
        undecided = int(self.undecided.sum())
        more = f", {undecided} undecided" if undecided else ""
        return f"{int(self.touches.sum())} of {len(self)} poses touch{more}"

    def __bool__(self) -> NoReturn:
        no_truth(self, ".touches, or .touches.any()")


class Touch(_Decided):
    """The answer of `Scene.touch`: a row for each pair of a mesh and a pose, in the given order."""

    __slots__ = ("_labels", "_with_witness", "_witness")
    _labels: Optional[Labels]
    _with_witness: bool
    _witness: Optional[npt.NDArray[np.void]]

    def __init__(self, made_of: Tables, labels: Optional[Labels] = None, with_witness: bool = False) -> None:
        check_made(made_of, Tables, "Scene.touch()")
        self._tables = made_of
        self._labels = labels
        self._with_witness = with_witness
        self._witness = None

    @property
    def witness(self) -> npt.NDArray[np.void]:
        """(N,): a witness point of each yes, with `witness=True`.

        `position` (3), LPS, mm: opaque, and on the triangle or within the margin of it, or inside a solid; NaN without
        a witness point. `triangle`: its number in the mesh; -1 inside a solid, and without a witness point. `label`
        there, 0 without a label map.
        """
        if not self._with_witness:
            raise NotReadyError("the answer has no witness points; ask with touch(witness=True)")
        if self._witness is None:
            rows = self._tables.rows("pairs")
            found, some = np.zeros(len(rows), _WITNESS), rows["witness"] == 1
            found["triangle"] = _triangles_of(rows)
            found["position"] = np.where(some[:, None], rows["point"], np.nan)
            if self._labels is not None:
                found["label"][some] = self._labels.at(rows["point"][some])
            self._witness = found
        return self._witness

    def plot(self, ax: Any = None) -> Any:
        """Plots the verdicts over the poses with matplotlib; returns the axes."""
        from ._plot import plot_touch

        return plot_touch(self, ax)

    def __repr__(self) -> str:
        return f"<voxtact.Touch: {self._verdicts()}; {self.method}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (Touch, {"_tables": self._tables, "_labels": None, "_with_witness": self._with_witness,
                                  "_witness": self.witness if self._with_witness else None})


class Count(_Decided):
    """The answer of `Scene.count`: a row for each pair of a mesh and a pose, in the given order."""

    __slots__ = ("_scene", "_later")
    _scene: Optional[Scene]
    _later: Optional[dict[str, Tables]]

    def __init__(self, made_of: Tables, scene: Optional[Scene]) -> None:
        check_made(made_of, Tables, "Scene.count()")
        self._tables = made_of
        self._scene = scene
        self._later = None

    @property
    def count(self) -> npt.NDArray[np.uint64]:
        """(N,): passing fragments of the mesh; 0 or 1 with `stop_at_first`."""
        return self._tables.count()

    @property
    def count_exact(self) -> npt.NDArray[np.bool_]:
        """(N,): True if the count is exact; False: a lower bound."""
        found: npt.NDArray[np.bool_] = self._tables.rows("pairs")["exactness"] == 0
        return found

    @property
    def triangles(self) -> npt.NDArray[np.void]:
        """The touched triangles: `pair`, `triangle`, `count`; by pair, then by triangle."""
        return self._output("triangles").rows("triangles")

    @property
    def contacts(self) -> npt.NDArray[np.void]:
        """A row for each passing fragment, by pair, triangle and position.

        `pair`; `triangle`; `position` (3), LPS, mm, on the triangle; `normal` (3), unit vector out of the opaque
        region, 0 without a gradient; `depth`, mm along the normal to the end of the opaque region; `value` and
        `opacity` of the image there; `label`, 0 without a label map.
        """
        return self._output("contacts").rows("contacts")

    @property
    def contacts_found(self) -> int:
        """The number of contacts; larger than the rows of `contacts` if `max_contacts` cut the list."""
        return int(self._output("contacts").total("contacts_found"))

    @property
    def bounds(self) -> npt.NDArray[np.float64]:
        """(N,2,3): the minimum and the maximum corner of each pair's contacts, LPS, mm; NaN without contacts."""
        rows = self._output("bounds").rows("bounds")
        found = np.stack([rows["lower"], rows["upper"]], axis=1)
        found[(rows["lower"] > rows["upper"]).any(axis=1)] = np.nan
        return np.asarray(found)

    @property
    def labels(self) -> npt.NDArray[np.void]:
        """Fragments by label: `pair`, `label`, `count`. The scene needs labels."""
        return self._output("labels").rows("labels")

    @property
    def projection(self) -> str:
        """The projection that made the fragments."""
        return self._tables.projection

    @property
    def counters(self) -> Counters:
        """The work of a device, with ``count(counters=True)``; others raise NotReadyError."""
        numbers = self._tables.counters(Counters._fields)
        if numbers is None:
            raise NotReadyError("the answer has no counters; ask with count(counters=True), on a device")
        return Counters(*numbers)

    def _output(self, name: str) -> Tables:
        """Returns the tables with an output; repeats the question if they lack it."""
        if self._tables.outputs >> _OUTPUTS.index(name) & 1:
            return self._tables
        if self._later is None:
            self._later = {}
        if name not in self._later:
            if self._scene is None:
                raise NotReadyError(f"a pickled or copied answer has no scene: ask for its {name} at once by "
                                    f"count({name}=True), or read them before you copy the answer")
            again = self._scene._core.again(self._tables.again, name)
            if again is None:
                raise NotReadyError(f"the scene has changed since this answer: ask for its {name} at once by "
                                    f"count({name}=True)")
            self._later[name] = again
        return self._later[name]

    def plot(self, ax: Any = None) -> Any:
        """Plots the counts over the poses with matplotlib; returns the axes. Red: touches; hollow: undecided."""
        from ._plot import plot_count

        return plot_count(self, ax)

    def __repr__(self) -> str:
        return f"<voxtact.Count: {self._verdicts()}; {self.projection}, {self.method}>"

    def __reduce__(self) -> tuple[Any, ...]:
        self._tables.counters(Counters._fields)  # kept for later requests
        return restored, (Count, {"_tables": self._tables, "_scene": None, "_later": dict(self._later or {})})


class _Measured(_Answer):
    """Bounds for each pair, or for each pair and label."""

    __slots__ = ("_labels",)
    _labels: Optional[list[int]]

    def _column(self, name: str) -> npt.NDArray[Any]:
        if self._labels is None:
            return np.asarray(self._tables.rows("pairs")[name])
        return np.asarray(self._tables.rows("labels")[name].reshape(len(self), len(self._labels)))

    @property
    def labels(self) -> npt.NDArray[np.int32]:
        """(L,): the labels of the columns; empty without labels."""
        return np.array(self._labels or [], np.int32)

    def _text(self, to: str, extreme: str, unit: str) -> str:
        name = f"<voxtact.{type(self).__name__} of {len(self) or 'no'} poses"
        if not len(self):
            return name + ">"
        lower, upper = self._column("lower"), self._column("upper")
        name += f" {to} {len(self.labels)} labels" if lower.ndim == 2 else ""
        if not lower.size:
            return name + ">"
        of = np.min if extreme == "min" else np.max
        return f"{name}: {extreme} {of(lower):.4g} to {of(upper):.4g} {unit}>"

    def __bool__(self) -> NoReturn:
        no_truth(self, ".lower and .upper")


class Distance(_Measured):
    """The answer of `Scene.distance`: a row for each pair, in order; with labels a column for each."""

    __slots__ = ()

    def __init__(self, made_of: Tables, labels: Optional[list[int]] = None) -> None:
        check_made(made_of, Tables, "Scene.distance()")
        self._tables = made_of
        self._labels = labels

    @property
    def lower(self) -> npt.NDArray[np.float64]:
        """(N,) or (N,L): lower bound, mm; 0 if the mesh touches."""
        return self._column("lower")

    @property
    def upper(self) -> npt.NDArray[np.float64]:
        """(N,) or (N,L): upper bound, mm; infinite beyond `max`, and if nothing is opaque."""
        return self._column("upper")

    @property
    def end(self) -> npt.NDArray[np.str_]:
        """Why the search ended.

        "closed" (upper - lower is within the tolerance), "beyond" (lower reached `max`), "rounding" (rounding decides
        the rest) or "budget" (`max_steps`).
        """
        names: npt.NDArray[np.str_] = _ENDS[self._column("end")]
        return names

    @property
    def closest(self) -> npt.NDArray[np.void]:
        """(N,): two witness points of `upper`, LPS, mm, and the gradient of their distance with respect to the pose.

        `triangle`, -1 without witness points, whose rest is NaN, and inside a solid, where both points are the same
        one; `mesh` (3) on the triangle; `volume` (3), opaque;
        `per_translation` (3), mm per mm along the world's axes; `per_rotation` (3), mm per radian about axes through
        the object's origin.
        """
        if self._column("lower").ndim == 2:
            raise NotReadyError("distances to labels have no closest points")
        rows = self._tables.rows("pairs")
        found = np.empty(len(rows), _CLOSEST)
        none = rows["witness"] == 0
        found["triangle"] = _triangles_of(rows)
        for name, column in (("mesh", "on_mesh"), ("volume", "in_volume"), ("per_translation", "per_translation"),
                             ("per_rotation", "per_rotation")):
            found[name] = np.where(none[:, None], np.nan, rows[column])
        return found

    def plot(self, ax: Any = None) -> Any:
        """Plots the bounds over the poses, mm, with matplotlib; returns the axes."""
        from ._plot import plot_distance

        return plot_distance(self, ax)

    def __repr__(self) -> str:
        return self._text("to", "min", "mm")

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (Distance, {"_tables": self._tables, "_labels": self._labels})


class Area(_Measured):
    """The answer of `Scene.area`: a row for each pair, in order; with labels a column for each."""

    __slots__ = ("_by_triangle",)
    _by_triangle: bool

    def __init__(self, made_of: Tables, labels: Optional[list[int]] = None, by_triangle: bool = False) -> None:
        check_made(made_of, Tables, "Scene.area()")
        self._tables = made_of
        self._labels = labels
        self._by_triangle = by_triangle

    @property
    def lower(self) -> npt.NDArray[np.float64]:
        """(N,) or (N,L): lower bound of the opaque area of the surface, mm^2."""
        return self._column("lower")

    @property
    def upper(self) -> npt.NDArray[np.float64]:
        """(N,) or (N,L): upper bound, mm^2."""
        return self._column("upper")

    @property
    def end(self) -> npt.NDArray[np.str_]:
        """Why the search ended: "closed" (upper - lower is within the tolerance), "rounding" or "budget" (`max_steps`).
        """
        names: npt.NDArray[np.str_] = _ENDS[self._column("end")]
        return names

    @property
    def triangles(self) -> npt.NDArray[np.void]:
        """(T,): triangles that may have an area, by pair, then by index, with `triangles=True`.

        `pair`, `triangle`, `whole`, the triangle's own area, and its bounds `lower` and `upper`, mm^2.
        """
        if not self._by_triangle:
            raise NotReadyError("the answer has no areas of triangles; ask with area(triangles=True)")
        return self._tables.rows("triangles")

    def plot(self, ax: Any = None) -> Any:
        """Plots the bounds over the poses, mm^2, with matplotlib; returns the axes."""
        from ._plot import plot_area

        return plot_area(self, ax)

    def __repr__(self) -> str:
        return self._text("in", "max", "mm^2")

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (Area, {"_tables": self._tables, "_labels": self._labels, "_by_triangle": self._by_triangle})


class Overlap(_Measured):
    """The answer of `Scene.overlap`: a row for each pair, in order; with bands or labels a column for each."""

    __slots__ = ("_bands",)
    _bands: Optional[list[float]]

    def __init__(self, made_of: Tables, labels: Optional[list[int]] = None, bands: Optional[list[float]] = None) -> None:
        check_made(made_of, Tables, "Scene.overlap()")
        self._tables = made_of
        self._labels = labels
        self._bands = bands

    def _column(self, name: str) -> npt.NDArray[Any]:
        if self._bands is None:
            return super()._column(name)
        return np.asarray(self._tables.rows("bands")[name].reshape(len(self), len(self._bands) + 1))

    @property
    def lower(self) -> npt.NDArray[np.float64]:
        """(N,), (N,B) or (N,L): lower bound of the opaque volume inside the mesh, mm^3; of a band, opaque or not."""
        return self._column("lower")

    @property
    def upper(self) -> npt.NDArray[np.float64]:
        """(N,), (N,B) or (N,L): upper bound, mm^3."""
        return self._column("upper")

    @property
    def solid_lower(self) -> npt.NDArray[np.float64]:
        """(N,): lower bound of the volume of the mesh, mm^3."""
        return np.asarray(self._tables.rows("pairs")["solid_lower"])

    @property
    def solid_upper(self) -> npt.NDArray[np.float64]:
        """(N,): upper bound of the volume of the mesh, mm^3."""
        return np.asarray(self._tables.rows("pairs")["solid_upper"])

    @property
    def inside(self) -> npt.NDArray[np.str_]:
        """(N,) or (N,L): how much of the opaque region is inside: "none", "some", "all" or "undecided"."""
        table = super()._column("inside")
        names: npt.NDArray[np.str_] = _INSIDE[table]
        return names

    @property
    def end(self) -> npt.NDArray[np.str_]:
        """Why the search ended: "closed" (upper - lower is within the tolerance), "rounding" or "budget" (`max_steps`)."""
        names: npt.NDArray[np.str_] = _ENDS[self._column("end")]
        return names

    @property
    def bands(self) -> npt.NDArray[np.float64]:
        """(B,2): the limits of each band: values from the first limit to below the second; empty without bands."""
        if self._bands is None:
            return np.zeros((0, 2))
        return np.stack([[-np.inf, *self._bands], [*self._bands, np.inf]], axis=1)

    def plot(self, ax: Any = None) -> Any:
        """Plots the bounds over the poses, mm^3, or over the bands, with matplotlib; returns the axes."""
        from ._plot import plot_overlap

        return plot_overlap(self, ax)

    def __repr__(self) -> str:
        if self._bands is None:
            return self._text("in", "max", "mm^3")
        return f"<voxtact.Overlap of {len(self) or 'no'} poses in {len(self._bands) + 1} bands>"

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (Overlap, {"_tables": self._tables, "_labels": self._labels, "_bands": self._bands})
