# SPDX-License-Identifier: MIT
"""Long calls in an interpreter: mutual exclusion, Ctrl-C, and the interpreter's exit."""
from __future__ import annotations

import _thread
import atexit
import functools
import os
import threading
import time
import weakref
from collections.abc import Callable
from typing import Any, Optional, TypeVar

from ._errors import NotReadyError
from ._library import NULL, CData, leak, lib, made

#: seconds between two checks for the end of a call or a signal
_PATIENCE = 0.05
_PIECE_SECONDS = 0.1
#: Maximum ratio of a piece's size to the previous one.
_MAX_GROWTH = 8

#: Receives the progress: (done, all).
Tell = Optional[Callable[[int, int], object]]
Method = TypeVar("Method", bound=Callable[..., Any])

_main = threading.main_thread().ident
#: Threads in a call of the library, with their cancel flags.
_inside: dict[int, CData] = {}
_ends = False


class _TheEnd(BaseException):
    """Unwinds a call of another thread when the interpreter exits."""


# Exit of the interpreter: the C library's own exit destroys objects that a daemon thread in a call would use.


def _wait_for_calls() -> None:
    """Cancels the calls of other threads at exit, and waits for them."""
    global _ends
    _ends = True
    cancelled: list[CData] = []
    while others := [cancel for thread, cancel in list(_inside.items()) if thread != _thread.get_ident()]:
        for cancel in others:
            lib.vxt_cancel_set(cancel, 1)
        cancelled += others
        time.sleep(_PATIENCE)
    for cancel in cancelled:
        lib.vxt_cancel_set(cancel, 0)
    leak()


def _stop_at_the_end() -> None:
    """Stops a thread that has just entered a call if the interpreter exits."""
    if _ends and _thread.get_ident() != _main:
        raise _TheEnd


def _wait_for_the_end() -> None:
    """Blocks other threads when the interpreter exits. The main thread's last calls are answered."""
    while _thread.get_ident() != _main:
        time.sleep(3600)


atexit.register(_wait_for_calls)


def guarded(call: Callable[..., Any], *arguments: Any) -> Any:
    """Runs a call that may take long; the interpreter's exit waits for it."""
    me = _thread.get_ident()
    if me in _inside:
        return call(*arguments)
    try:
        _inside[me] = NULL
        try:
            _stop_at_the_end()
            return call(*arguments)
        finally:
            _inside.pop(me, None)
    finally:
        if _ends:
            _wait_for_the_end()


# Mutual exclusion

_all_turns: weakref.WeakSet[Turns] = weakref.WeakSet()


class Turns:
    """Lets one thread at a time in; `cancel` ends its call."""

    __slots__ = ("cancel", "_lock", "_owner", "__weakref__")

    def __init__(self) -> None:
        self.cancel = made("cancel", lib.vxt_cancel_create)
        self._lock = _thread.allocate_lock()
        self._owner = 0
        _all_turns.add(self)

    def forget(self) -> None:
        """Resets the lock in a forked child, where a missing thread may hold it."""
        if self._owner != _thread.get_ident():
            self._lock = _thread.allocate_lock()
            self._owner = 0


def in_turn(method: Method) -> Method:
    """Decorates a method of an object with `_turns`: the method waits for its turn."""

    identity, inside, outside = _thread.get_ident, _inside.get, _inside.pop

    @functools.wraps(method)
    def call(self: Any, *arguments: Any) -> Any:
        me = identity()
        turns = self._turns
        lock = turns._lock
        if turns._owner == me and lock.locked():
            raise NotReadyError("the scene is at work for this very thread: a progress callback or a signal handler "
                                "cannot use it; let it take notes, and use the scene when the call is done")
        try:
            with lock:
                turns._owner = me
                before = inside(me)
                _inside[me] = turns.cancel
                try:
                    if _ends:
                        _stop_at_the_end()
                    return method(self, *arguments)
                finally:
                    turns._owner = 0
                    if before is None:
                        outside(me, None)
                    else:
                        _inside[me] = before
        finally:
            if _ends:
                _wait_for_the_end()

    return call  # type: ignore[return-value]


def _after_fork() -> None:
    global _main, _worker
    me = _thread.get_ident()
    _main, _worker = me, None
    for thread in list(_inside):
        if thread != me:
            del _inside[thread]
    for turns in list(_all_turns):
        turns.forget()


os.register_at_fork(after_in_child=_after_fork)


# Calls that Ctrl-C ends


class _Job:
    """A call on its own thread."""

    __slots__ = ("_call", "_gate", "_begun", "_given_up", "_ended", "_done", "_answer", "_error")

    def __init__(self, call: Callable[[], Any]) -> None:
        self._call = call
        self._gate = _thread.allocate_lock()
        self._begun = self._given_up = self._ended = False
        self._done = _thread.allocate_lock()
        self._done.acquire()
        self._answer: Any = None
        self._error: Optional[BaseException] = None

    def work(self, worker: Optional[_Worker] = None) -> None:
        with self._gate:
            if self._given_up:
                return
            self._begun = True
        try:
            self._answer = self._call()
        except BaseException as error:
            self._error = error
        finally:
            self._ended = True
            if worker is not None:
                worker.is_free = True
            self._done.release()

    def give_up(self, cancel: CData) -> None:
        """Returns when the thread has left the call, regardless of further interrupts."""
        while True:
            try:
                with self._gate:
                    self._given_up = True
                while self._begun and not self._ended:
                    lib.vxt_cancel_set(cancel, 1)
                    self._done.acquire(timeout=_PATIENCE)
                lib.vxt_cancel_set(cancel, 0)
                return
            except BaseException:
                pass

    def answer(self, cancel: CData) -> Any:
        worker = _worker_of_main()
        try:
            if worker is None:
                _thread.start_new_thread(self.work, ())
            else:
                worker.take(self)
            while not self._done.acquire(timeout=_PATIENCE):
                pass
        except BaseException:
            self.give_up(cancel)
            if worker is not None:
                worker.retire()
            raise
        error, self._error = self._error, None  # it holds a reference to this frame
        if error is not None:
            raise error
        return self._answer


class _Worker:
    """The thread that runs the main thread's calls, one after the other; starting one per call takes longer."""

    __slots__ = ("is_free", "_go", "_job", "_retired")

    def __init__(self) -> None:
        self.is_free = True
        self._go = _thread.allocate_lock()
        self._go.acquire()
        self._job: Optional[_Job] = None
        self._retired = False
        _thread.start_new_thread(self._work, ())

    def _work(self) -> None:
        while True:
            self._go.acquire()
            job, self._job = self._job, None
            if job is not None:
                job.work(self)
            del job
            if self._retired:
                return

    def take(self, job: _Job) -> None:
        self.is_free = False
        self._job = job
        self._go.release()

    def retire(self) -> None:
        """Retires a worker that was interrupted, at any point."""
        global _worker
        _worker = None
        self._retired = True
        if self._go.locked():
            self._go.release()


_worker: Optional[_Worker] = None


def _worker_of_main() -> Optional[_Worker]:
    """Returns the main thread's worker, or None while it is busy: a signal handler may ask while the main thread waits.
    """
    global _worker
    if _worker is None:
        _worker = _Worker()
    return _worker if _worker.is_free else None


def interruptibly(call: Callable[[], Any], cancel: CData) -> Any:
    """Runs a call that `cancel` ends; it is reset before and after. Calls of the main thread, which alone receives
    signals, run on another thread, and an exception of a signal handler ends the call."""
    return call() if _ends or _thread.get_ident() != _main else _Job(call).answer(cancel)


def tell(progress: Callable[[int, int], object], done: int, total: int) -> None:
    """Calls back outside the library call, so the interpreter's exit does not wait for it."""
    me = _thread.get_ident()
    mine = _inside.pop(me)
    try:
        progress(done, total)
    finally:
        _inside[me] = mine
        _stop_at_the_end()


def in_pieces(total: int, first: int, most: int, progress: Tell, work: Callable[[int, int], None]) -> None:
    """Calls `work(first, count)` for `total` items in order, in pieces of about a tenth of a second; the first piece
    has `first` items, none more than `most`."""
    count = max(min(first, most), 1)
    begin = 0
    while begin < total:
        count = min(count, most, total - begin)
        start = time.perf_counter()
        work(begin, count)
        took = max(time.perf_counter() - start, 1e-6)
        begin += count
        count = max(int(count * min(_PIECE_SECONDS / took, _MAX_GROWTH)), 1)
        if progress is not None:
            tell(progress, begin, total)
