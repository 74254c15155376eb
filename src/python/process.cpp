// SPDX-License-Identifier: MIT
#include "process.h"

#include "lock.h"

#include <pthread.h>

namespace voxtact::python {

namespace {

std::atomic<std::uint64_t> forkCount{0};

} // namespace

std::uint64_t forks() noexcept {
    return forkCount.load(std::memory_order_relaxed);
}

void watchForks() {
    pthread_atfork(nullptr, nullptr, [] {
        forkCount.fetch_add(1, std::memory_order_relaxed);
        forgetOtherThreads();
    });
}

} // namespace voxtact::python
