# SPDX-License-Identifier: MIT
"""What the library answers: tables of columns, as numpy arrays over its memory, made when they are read."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ._library import CData, check, copied, ffi, lib, shown, struct, text_of

_TYPES = (np.uint32, np.int32, np.uint64, np.float64)  # by vxt_type
YES, UNDECIDED = 1, 2  # of the columns `touch`

_Layout = dict[str, tuple[np.dtype[Any], bytes, bytes, int]]
#: Of each question the tables: their rows as numpy has them, and table, name and offset of a column to find them by.
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
    """The tables of one question, of pieces: (number of the first row of the main table, vxt_answer).

    lengths: pairs, or segments, of each item; again: what `Scene.again` needs, in the process that asked
    """

    __slots__ = ("question", "lengths", "projection", "outputs", "max_contacts", "counted", "again", "_pieces", "_kept")

    def __init__(self, question: str, lengths: Sequence[int], projection: str = "certified", outputs: int = 0,
                 max_contacts: int = 0, counted: bool = False, again: Any = None) -> None:
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

    def _names(self) -> list[str]:
        """Of its tables; where it has been pickled or joined, of those that are kept."""
        if self._pieces:
            return list(self._layout())
        return [table for table, rows in self._kept.items() if isinstance(rows, np.ndarray) and rows.dtype.names]

    def _piece(self, handle: CData, table: str) -> npt.NDArray[Any]:
        rows, in_table, name, offset = self._layout()[table]
        column = struct("column")
        check(lib.vxt_answer_find(handle, in_table, name, column))
        return shown(ffi.cast("char*", column.data) - offset if column.rows else column.data, (column.rows,), rows, handle)

    def rows(self, table: str) -> npt.NDArray[Any]:
        """All rows of a table. Where it has numbers of pairs, they are those of the whole."""
        kept: Optional[npt.NDArray[Any]] = self._kept.get(table)
        if kept is None:
            pieces = [self._piece(handle, table) for _, handle in self._pieces]
            kept = self._kept[table] = pieces[0] if len(pieces) == 1 else _joined(pieces, [first for first, _ in self._pieces])
        return kept

    def total(self, name: str) -> float:
        """Of all pieces; 0 of what the question has not."""
        totals = self.rows("totals")
        return float(totals[name].sum()) if name in (totals.dtype.names or ()) else 0.0

    @property
    def milliseconds(self) -> float:
        return self.total("wall_milliseconds")

    @classmethod
    def joined(cls, parts: list[Tables]) -> Tables:
        """Those of several answers to one question about one mesh."""
        one = parts[0]
        if len(parts) == 1:
            return one
        whole = cls(one.question, [sum(map(len, parts))], one.projection, one.outputs, one.max_contacts)
        firsts = [sum(map(len, parts[:number])) for number in range(len(parts))]
        whole._kept = {table: _joined([part.rows(table) for part in parts], firsts) for table in one._names()}
        return whole

    # Of the table of pairs

    def touch_is(self, verdict: int) -> npt.NDArray[np.bool_]:
        name = f"touch is {verdict}"
        if name not in self._kept:
            self._kept[name] = self.rows("segments" if self.question == "motion" else "pairs")["touch"] == verdict
        found: npt.NDArray[np.bool_] = self._kept[name]
        return found

    def touches(self) -> bool:
        """Whether any certainly does, or may."""
        return bool(self.rows("pairs")["touch"].any())

    def count(self) -> npt.NDArray[np.uint64]:
        found: npt.NDArray[np.uint64] = self.rows("pairs")["count"]
        return found

    def method(self) -> int:
        """The counting method of the last row; the host's, where nothing was counted."""
        if self.question == "count" and len(self):
            return int(self.rows("pairs")["method"][-1])
        return int(lib.VXT_METHOD_CPU)

    def item(self) -> npt.NDArray[np.uint32]:
        return np.repeat(np.arange(len(self.lengths), dtype=np.uint32), self.lengths)

    def pose(self) -> npt.NDArray[np.uint32]:
        return np.concatenate([np.zeros(0, np.uint32), *(np.arange(length, dtype=np.uint32) for length in self.lengths)])

    def counters(self, names: Sequence[str]) -> Optional[tuple[int, ...]]:
        """Those of these names of all pieces together; nothing where they were not asked for."""
        if self.counted and "counters" not in self._kept:
            counters = struct("certified_counters")
            found: list[list[int]] = []
            for handle in self.handles():
                check(lib.vxt_answer_counters(handle, counters))
                found.append([getattr(counters, name) for name in names])
            self._kept["counters"] = tuple(max(column) if name.startswith("most_") or name == "room" else sum(column)
                                           for name, column in zip(names, zip(*found)))
        return self._kept.get("counters")

    def __len__(self) -> int:
        return sum(self.lengths)

    def __reduce__(self) -> tuple[Any, ...]:
        kept = dict(self._kept)
        kept.update((table, self.rows(table).copy()) for table in self._names())
        return _tables_again, (self.question, list(self.lengths), self.projection, self.outputs, self.max_contacts, kept)


def _tables_again(question: str, lengths: list[int], projection: str, outputs: int, max_contacts: int, kept: dict[str, Any]) -> Tables:
    """What pickle calls."""
    tables = Tables(question, lengths, projection, outputs, max_contacts)
    tables._kept = kept
    return tables


def _joined(pieces: list[npt.NDArray[Any]], firsts: list[int]) -> npt.NDArray[Any]:
    """The rows of all pieces, whose pairs begin at these numbers."""
    whole = np.zeros(sum(map(len, pieces)), pieces[0].dtype)
    begin = 0
    for first, rows in zip(firsts, pieces):
        part = whole[begin:begin + len(rows)]
        part[...] = rows
        if "pair" in (whole.dtype.names or ()):
            part["pair"] += np.uint32(first)
        begin += len(rows)
    return whole


# To copy an array takes less than to make one.
_FALSE, _TRUE = np.array([False]), np.array([True])


class SingleTables(Tables):
    """Those of a yes or no about one pose, which is asked most often: the verdict alone, without memory of the library."""

    __slots__ = ("_verdict", "_milliseconds")

    def __init__(self, verdict: int, milliseconds: float) -> None:
        self._verdict = verdict
        self._milliseconds = milliseconds

    question = "touch"
    lengths = (1,)
    projection = "certified"
    outputs = max_contacts = 0
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
    """A copy of an array of points of the library, of so many doubles each."""
    count = ffi.new("size_t*")
    first = get(handle, count)
    return copied(first, (count[0], columns))
