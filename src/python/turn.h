// SPDX-License-Identifier: MIT
#pragma once

#include "process.h"

#include <pybind11/pybind11.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

/// Long work beside an interpreter: whose turn it is, and pieces between which Python lives on.
namespace voxtact::python {

namespace py = pybind11;

/// Lets Python handle signals; the interpreter's lock may be held or not. What a handler raises leaves as an exception.
void handleSignals();

/// One thread at a time.
class Turns {
    struct Lock {
        std::uint64_t born = forks();
        std::timed_mutex mutex;
        std::atomic<std::thread::id> owner;
    };

  public:
    Turns() = default;
    Turns(const Turns&) = delete;
    Turns& operator=(const Turns&) = delete;
    ~Turns();

    /// Waits for the turn, and lets Python handle signals meanwhile. The interpreter's lock must not be held. Refuses a
    /// thread whose turn it is already: a callback of its own call.
    class Turn {
      public:
        explicit Turn(Turns& turns);
        ~Turn();
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

      private:
        Lock& lock_;
    };

  private:
    /// That of this process: in a child, a thread that is not there may hold the old one, which is left alone.
    [[nodiscard]] Lock& lock();

    std::atomic<Lock*> lock_ = nullptr;
};

/// Who hears how far it is: called with the interpreter's lock held.
using Progress = std::function<void(std::size_t done)>;

/// Calls `work(first, count)` for `total` things in order, in pieces of about a tenth of a second; the first piece has
/// `first` of them, none more than `most`. In between Python handles signals, and `progress`, which may be empty, is
/// called. The interpreter's lock must not be held.
void inPieces(std::size_t total, std::size_t first, std::size_t most, const Progress& progress,
              const std::function<void(std::size_t first, std::size_t count)>& work);

} // namespace voxtact::python
