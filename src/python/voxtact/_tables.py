# SPDX-License-Identifier: MIT
"""Answers of the library: tables of columns, as numpy arrays over its memory, created on access."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._library import CData, check, copied, ffi, lib, shown, struct, text_of

_TYPES = (np.uint32, np.int32, np.uint64, np.float64)  # indexed by vxt_type
YES, UNDECIDED = 1, 2  # of the column `touch`

_Layout = dict[str, tuple[np.dtype[Any], bytes, bytes, int]]
#: Tables of each question: the numpy dtype of their rows, and table, name and offset of a column that identifies them.
_layouts: dict[str, _Layout] = {}


def _layout_of(handle: CData) -> _Layout:
    columns: dict[str, list[tuple[str, Any, int, int]]] = {}
    column = struct("column")
    for index in range(lib.vxt_answer_columns(handle)):
        check(lib.vxt_answer_column(handle, index, column))
        kind = np.dtype(_TYPES[column.type])
        columns.setdefault(text_of(column.table), []).append(
            (text_of(column.name), kind if column.elements == 1 else (kind, (column.elements,)), column.offset, column.stride))
    made: _Layout = {}
    for table, found in columns.items():
        names, formats, offsets, strides = zip(*found)
        rows = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": strides[0]})
        made[table] = rows, table.encode(), names[0].encode(), offsets[0]
    return made


class Tables:
    """The tables of one question, in pieces: (index of the first row of the main table, vxt_answer).

    lengths: number of pairs, or segments, of each item; again: the arguments of `Scene.again`, in the process that
    asked
    """

    __slots__ = ("question", "lengths", "projection", "outputs", "max_contacts", "counted", "again", "_pieces", "_kept")

    def __init__(self, question: str, lengths: Sequence[int], projection: str = "certified", outputs: int = 0,
                 max_contacts: Optional[int] = None, counted: bool = False, again: Any = None) -> None:
        self.question = question
        self.lengths = lengths
        self.projection = projection
        self.outputs = outputs
        self.max_contacts = max_contacts
        self.counted = counted
        self.again = again
        self._pieces: list[tuple[int, CData]] = []
        self._kept: dict[str, Any] = {}

    def add(self, first: int, handle: CData) -> None:
        self._pieces.append((first, handle))

    def handles(self) -> list[CData]:
        return [handle for _, handle in self._pieces]

    def _layout(self) -> _Layout:
        if self.question not in _layouts:
            _layouts[self.question] = _layout_of(self._pieces[0][1])
        return _layouts[self.question]

    def names(self) -> list[str]:
        """Returns the names of the tables; of a pickled or joined answer, those of the kept tables."""
        if self._pieces:
            return list(self._layout())
        return [table for table, rows in self._kept.items() if isinstance(rows, np.ndarray) and rows.dtype.names]

    def _piece(self, handle: CData, table: str) -> npt.NDArray[Any]:
        rows, in_table, name, offset = self._layout()[table]
        column = struct("column")
        check(lib.vxt_answer_find(handle, in_table, name, column))
        return shown(ffi.cast("char*", column.data) - offset if column.rows else column.data, (column.rows,), rows, handle)

    def rows(self, table: str) -> npt.NDArray[Any]:
        """Returns all rows of a table. Indices of pairs, items and poses count from the first piece."""
        kept: Optional[npt.NDArray[Any]] = self._kept.get(table)
        if kept is None:
            kept = self._join(table, [self._piece(handle, table) for _, handle in self._pieces], [first for first, _ in self._pieces])
        return kept

    def _join(self, table: str, pieces: list[npt.NDArray[Any]], firsts: list[int]) -> npt.NDArray[Any]:
        """Joins and keeps the rows of all pieces, whose pairs begin at `firsts`."""
        rows, names = pieces[0], pieces[0].dtype.names or ()
        if len(pieces) > 1 or len(self.lengths) > 1 and "item" in names:
            rows = np.concatenate(pieces, out=np.zeros(sum(map(len, pieces)), rows.dtype))
        if len(pieces) > 1 and "pair" in names:
            rows["pair"] += np.repeat(np.array(firsts, np.uint32), [len(piece) for piece in pieces])
        if rows is not pieces[0] and len(rows) and "item" in names:  # the library does not know items without poses
            pair: Any = rows["pair"] if "pair" in names else slice(None)
            rows["item"], rows["pose"] = self.item()[pair], self.pose()[pair]
        if rows is not pieces[0] and table == "totals":
            for name in names:
                rows[name][0] = rows[name].sum()
        kept = self._kept[table] = rows[:{"contacts": self.max_contacts, "totals": 1}.get(table)]
        return kept

    def total(self, name: str) -> float:
        """Returns the total over all pieces; 0 for a column that the question lacks."""
        totals = self.rows("totals")
        return float(totals[name].sum()) if name in (totals.dtype.names or ()) else 0.0

    @property
    def milliseconds(self) -> float:
        return self.total("wall_milliseconds")

    @classmethod
    def joined(cls, parts: list[Tables]) -> Tables:
        """Joins the tables of several answers to one question about one mesh."""
        one = parts[0]
        if len(parts) == 1:
            return one
        whole = cls(one.question, [sum(map(len, parts))], one.projection, one.outputs, one.max_contacts)
        firsts = [sum(map(len, parts[:number])) for number in range(len(parts))]
        for table in one.names():
            whole._join(table, [part.rows(table) for part in parts], firsts)
        return whole

    # The table of pairs

    def touch_is(self, verdict: int) -> npt.NDArray[np.bool_]:
        name = f"touch is {verdict}"
        if name not in self._kept:
            self._kept[name] = self.rows("segments" if self.question == "motion" else "pairs")["touch"] == verdict
        found: npt.NDArray[np.bool_] = self._kept[name]
        return found

    def touches(self) -> bool:
        """Returns whether each pair certainly touches, or may touch."""
        return bool(self.rows("pairs")["touch"].any())

    def count(self) -> npt.NDArray[np.uint64]:
        found: npt.NDArray[np.uint64] = self.rows("pairs")["count"]
        return found

    def method(self) -> int:
        """The counting method of the last row; without rows, that of the host."""
        if self.question == "count" and len(self):
            return int(self.rows("pairs")["method"][-1])
        return int(lib.VXT_METHOD_CPU)

    def item(self) -> npt.NDArray[np.uint32]:
        return np.repeat(np.arange(len(self.lengths), dtype=np.uint32), self.lengths)

    def pose(self) -> npt.NDArray[np.uint32]:
        return np.concatenate([np.zeros(0, np.uint32), *(np.arange(length, dtype=np.uint32) for length in self.lengths)])

    def counters(self, names: Sequence[str]) -> Optional[tuple[int, ...]]:
        """Returns counters by name over all pieces; None if they were not requested."""
        if self.counted and "counters" not in self._kept:
            counters = struct("certified_counters")
            found: list[list[int]] = []
            for handle in self.handles():
                check(lib.vxt_answer_counters(handle, counters))
                found.append([getattr(counters, name) for name in names])
            self._kept["counters"] = tuple(max(column) if name.startswith("peak_") or name == "room" else sum(column)
                                           for name, column in zip(names, zip(*found)))
        return self._kept.get("counters")

    def __len__(self) -> int:
        return sum(self.lengths)

    def __reduce__(self) -> tuple[Any, ...]:
        kept = {table: self.rows(table).copy() for table in self.names()}
        kept.update((name, value) for name, value in self._kept.items() if name not in kept)
        return _tables_again, (self.question, list(self.lengths), self.projection, self.outputs, self.max_contacts, kept)


def _tables_again(question: str, lengths: list[int], projection: str, outputs: int, max_contacts: Optional[int],
                  kept: dict[str, Any]) -> Tables:
    """Restores tables from a pickle."""
    tables = Tables(question, lengths, projection, outputs, max_contacts)
    tables._kept = kept
    return tables


# Copying an array takes less time than creating one.
_FALSE, _TRUE = np.array([False]), np.array([True])


class SingleTables(Tables):
    """Tables of a touch query about one pose, the most frequent one: the verdict alone, without memory of the library.
    """

    __slots__ = ("_verdict", "_milliseconds")

    def __init__(self, verdict: int, milliseconds: float) -> None:
        self._verdict = verdict
        self._milliseconds = milliseconds

    question = "touch"
    lengths = (1,)
    projection = "certified"
    outputs, max_contacts = 0, None
    counted = False

    def rows(self, table: str) -> npt.NDArray[Any]:
        return np.array([(self._verdict, self._milliseconds)], [("touch", np.uint32), ("wall_milliseconds", np.float64)])

    def touch_is(self, verdict: int) -> npt.NDArray[np.bool_]:
        return (_TRUE if self._verdict == verdict else _FALSE).copy()

    def touches(self) -> bool:
        return self._verdict != 0

    def total(self, name: str) -> float:
        return self._milliseconds if name == "wall_milliseconds" else 0.0

    def item(self) -> npt.NDArray[np.uint32]:
        return np.zeros(1, np.uint32)

    pose = item

    def counters(self, names: Sequence[str]) -> Optional[tuple[int, ...]]:
        return None

    @property
    def milliseconds(self) -> float:
        return self._milliseconds

    def __len__(self) -> int:
        return 1

    def __reduce__(self) -> tuple[Any, ...]:
        return SingleTables, (self._verdict, self._milliseconds)


def points_of(get: Any, handle: CData, columns: int) -> npt.NDArray[np.float64]:
    """Copies an array of points of the library, each of this number of doubles."""
    count = ffi.new("size_t*")
    first = get(handle, count)
    return copied(first, (count[0], columns))
