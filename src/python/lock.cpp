// SPDX-License-Identifier: MIT
#include "lock.h"

#include <unistd.h>

namespace voxtact::python {

namespace {

/// What takes the lock, or never comes back.
template <class Take> void takeOrWait(const Take& take) noexcept {
    try {
        take();
    } catch (...) { // not an exception, but the end of this thread; it must not leave this block
        for (;;) {
            pause();
        }
    }
}

} // namespace

Unlocked::~Unlocked() {
    takeOrWait([this] { PyEval_RestoreThread(state_); });
}

Locked::Locked() {
    takeOrWait([this] { state_ = PyGILState_Ensure(); });
}

} // namespace voxtact::python
