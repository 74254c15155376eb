// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

/// The interpreter's lock. Where a thread wants it back from an interpreter that is about to end, Python before 3.14
/// ends the thread by unwinding its stack, through whatever C++ is on it, which std::terminate() answers. Here such a
/// thread waits for the end of the process, as it does from 3.14 on.
namespace voxtact::python {

/// Gives the lock back for as long as it lives. Expects that the thread holds it.
class Unlocked {
  public:
    Unlocked() : state_(PyEval_SaveThread()) {}
    ~Unlocked();
    Unlocked(const Unlocked&) = delete;
    Unlocked& operator=(const Unlocked&) = delete;

  private:
    PyThreadState* state_;
};

/// Holds the lock for as long as it lives, whether or not the thread had it before.
class Locked {
  public:
    Locked();
    ~Locked() { PyGILState_Release(state_); }
    Locked(const Locked&) = delete;
    Locked& operator=(const Locked&) = delete;

  private:
    PyGILState_STATE state_ = PyGILState_UNLOCKED;
};

} // namespace voxtact::python
