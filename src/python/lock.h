// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <exception>

/// The interpreter's lock, and its end while other threads are in a call. Python lets the main thread go on to the end
/// while threads that are daemons run, and whoever of them asks for the lock then has their stack unwound through
/// whatever C++ is on it (before Python 3.14), or finds an interpreter that is gone. Here the end of the interpreter
/// waits until no thread works outside of the lock any more: calls are cancelled as by Ctrl-C, and their threads wait
/// for the end of the process, as threads that ask for the lock do from Python 3.14 on.
namespace voxtact::python {

namespace py = pybind11;

/// What unwinds a call of another thread when the interpreter ends. Unlocked stops it.
class InterpreterEnds : public std::exception {};

/// Lets the end of the interpreter wait for calls; once, when the module is loaded.
void watchEnd();
/// In a child of a fork: threads that were in a call are not there. Safe in a handler of pthread_atfork().
void forgetOtherThreads() noexcept;

/// Gives the lock back for as long as it lives. Expects that the thread holds it. Where the interpreter has ended in
/// the meantime, its destructor does not return.
class Unlocked {
  public:
    Unlocked();
    ~Unlocked();
    Unlocked(const Unlocked&) = delete;
    Unlocked& operator=(const Unlocked&) = delete;

  private:
    PyThreadState* state_ = nullptr;
};

/// Holds the lock for as long as it lives, whether or not the thread had it before. Its constructor throws
/// InterpreterEnds where there is no lock to be had any more.
class Locked {
  public:
    Locked();
    ~Locked();
    Locked(const Locked&) = delete;
    Locked& operator=(const Locked&) = delete;

  private:
    bool taken_ = false;
    PyGILState_STATE state_ = PyGILState_UNLOCKED;
};

/// Calls `callback(done, all)`. The lock must be held. What it raises leaves as an exception.
void tell(const py::object& callback, std::size_t done, std::size_t all);

} // namespace voxtact::python
