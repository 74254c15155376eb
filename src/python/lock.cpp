// SPDX-License-Identifier: MIT
#include "lock.h"

#include <atomic>
#include <chrono>
#include <thread>

namespace voxtact::python {

namespace {

constexpr std::chrono::milliseconds kPatience{1};

// No mutex and no condition variable: a child of a fork could not use them.
std::atomic<bool> ends{false};
std::atomic<std::size_t> threadsOutside{0};

/// Whether this thread is in an Unlocked, and in no Locked within it.
thread_local bool isOutside = false;
/// The thread that ends the interpreter may go on using it.
thread_local bool isTheLast = false;

bool tooLate() noexcept {
    return ends.load() && !isTheLast;
}

[[noreturn]] void waitForTheEnd() noexcept {
    for (;;) {
        std::this_thread::sleep_for(std::chrono::hours(1));
    }
}

/// Calls what asks Python for the lock. Python may end the thread in there, by something that is caught like an
/// exception, is none, and must not go further.
template <class Ask> auto askedFor(const Ask& ask) noexcept {
    try {
        return ask();
    } catch (...) {
        waitForTheEnd();
    }
}

// Both are called with the lock held, as is what begins the end and looks at the count: so whoever goes outside either
// knows of the end, or is waited for.
void goOutside() noexcept {
    isOutside = true;
    ++threadsOutside;
}

void comeBack() noexcept {
    isOutside = false;
    --threadsOutside;
}

/// Called by Python's atexit, before anything is taken down.
void waitForCalls() {
    isTheLast = true;
    ends = true;
    while (threadsOutside.load() != 0) {
        {
            // Those who asked for the lock before it ended get it now.
            const py::gil_scoped_release released;
            std::this_thread::sleep_for(kPatience);
        }
        if (PyErr_CheckSignals() != 0) {
            throw py::error_already_set();
        }
    }
}

} // namespace

void watchEnd() {
    py::module_::import("atexit").attr("register")(py::cpp_function(&waitForCalls));
}

void forgetOtherThreads() noexcept {
    threadsOutside = isOutside ? 1 : 0;
}

Unlocked::Unlocked() {
    if (tooLate()) {
        PyEval_SaveThread();
        waitForTheEnd();
    }
    goOutside();
    state_ = PyEval_SaveThread();
}

Unlocked::~Unlocked() {
    if (tooLate()) {
        --threadsOutside;
        waitForTheEnd();
    }
    askedFor([this] { PyEval_RestoreThread(state_); });
    comeBack();
}

Locked::Locked() {
    if (!isOutside) {
        return; // the thread holds it
    }
    if (tooLate()) {
        throw InterpreterEnds();
    }
    state_ = askedFor([] { return PyGILState_Ensure(); });
    taken_ = true;
    comeBack();
}

Locked::~Locked() {
    if (taken_) {
        goOutside();
        PyGILState_Release(state_);
    }
}

void tell(const py::object& callback, std::size_t done, std::size_t all) {
    // Nothing of pybind11 is on the stack meanwhile: what it holds would be let go without the lock.
    PyObject* const function = callback.ptr();
    PyObject* const answer = askedFor([function, done, all] {
        return PyObject_CallFunction(function, "nn", static_cast<Py_ssize_t>(done), static_cast<Py_ssize_t>(all));
    });
    if (answer == nullptr) {
        throw py::error_already_set();
    }
    Py_DECREF(answer);
}

} // namespace voxtact::python
