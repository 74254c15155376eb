// SPDX-License-Identifier: MIT
#include "turn.h"

#include "failure.h"
#include "lock.h"

#include <algorithm>
#include <chrono>
#include <memory>

namespace voxtact::python {

namespace {

constexpr std::chrono::milliseconds kPatience{50};
constexpr double kPieceSeconds = 0.1;
/// A piece has at most so many times as many as the one before.
constexpr double kMostGrowth = 8;

using Clock = std::chrono::steady_clock;

std::size_t nextPiece(std::size_t count, Clock::duration took) {
    const double seconds = std::max(std::chrono::duration<double>(took).count(), 1e-6);
    const double wanted = static_cast<double>(count) * std::min(kPieceSeconds / seconds, kMostGrowth);
    return std::max<std::size_t>(static_cast<std::size_t>(wanted), 1);
}

} // namespace

void handleSignals() {
    const Locked locked;
    if (PyErr_CheckSignals() != 0) {
        throw py::error_already_set();
    }
}

Turns::~Turns() {
    const Lock* const last = lock_.load();
    if (last != nullptr && last->born == forks()) {
        delete last;
    }
}

Turns::Lock& Turns::lock() {
    Lock* known = lock_.load();
    if (known != nullptr && known->born == forks()) {
        return *known;
    }
    auto made = std::make_unique<Lock>();
    if (lock_.compare_exchange_strong(known, made.get())) {
        return *made.release();
    }
    return *known; // another thread was first
}

Turns::Turn::Turn(Turns& turns) : lock_(turns.lock()) {
    if (lock_.owner.load() == std::this_thread::get_id()) {
        refuse(ErrorCode::NotReady,
               "the scene is at work for this very thread: a progress callback or a signal handler "
               "cannot use it; let it take notes, and use the scene when the call is done");
    }
    while (!lock_.mutex.try_lock_for(kPatience)) {
        handleSignals();
    }
    lock_.owner.store(std::this_thread::get_id());
}

Turns::Turn::~Turn() {
    lock_.owner.store(std::thread::id());
    lock_.mutex.unlock();
}

void inPieces(std::size_t total, std::size_t first, std::size_t most, const Progress& progress,
              const std::function<void(std::size_t, std::size_t)>& work) {
    std::size_t count = std::clamp<std::size_t>(first, 1, most);
    for (std::size_t begin = 0; begin < total;) {
        count = std::min({count, most, total - begin});
        const Clock::time_point start = Clock::now();
        work(begin, count);
        const Clock::duration took = Clock::now() - start;
        begin += count;
        count = nextPiece(count, took);
        if (progress) {
            const Locked locked;
            progress(begin);
        }
        if (begin < total) {
            handleSignals();
        }
    }
}

} // namespace voxtact::python
