// SPDX-License-Identifier: MIT
#include "host/thread_pool.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>
#include <utility>

namespace voxtact::cpu {

namespace {

/// About the time to wake a thread: 20 to 40 us. Starting alone and waking others later therefore at most doubles the
/// time.
constexpr std::chrono::microseconds kWaking{30};

} // namespace

ThreadPool::ThreadPool(std::uint32_t threads) {
    try {
        for (std::uint32_t thread = 1; thread < threads; ++thread) {
            workers_.emplace_back([this, thread] { work(thread); });
        }
    } catch (const std::system_error& error) {
        stop();
        throw std::system_error(error.code(), "thread " + std::to_string(workers_.size() + 2) + " of " +
                                                  std::to_string(threads) +
                                                  " cannot be started (ask for fewer: threads, --threads)");
    } catch (...) {
        stop();
        throw;
    }
}

ThreadPool::~ThreadPool() {
    stop();
}

void ThreadPool::stop() noexcept {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    start_.notify_all();
    for (std::thread& worker : workers_) {
        worker.join();
    }
}

void ThreadPool::run(std::uint64_t pieces, const Step& step, WakeOthers when) {
    if (pieces == 0) {
        return;
    }
    const auto others = static_cast<std::uint32_t>(std::min<std::uint64_t>(threads(), pieces)) - 1;
    const bool alone = when == WakeOthers::Predicted && pieces <= std::min(brief_[0], brief_[1]);
    attempt([&] { lead(others, step, alone); });
    const bool isBrief = rest() < kWaking && thrown_ == nullptr;
    brief_ = {isBrief ? pieces : 0, brief_[0]};
    if (thrown_ != nullptr) {
        std::rethrow_exception(std::exchange(thrown_, nullptr));
    }
}

void ThreadPool::lead(std::uint32_t others, const Step& step, bool alone) {
    if (others > 0 && !alone) {
        wake(others, step);
    }
    const Clock::time_point start = Clock::now();
    bool waits = others > 0 && alone;
    while (step(0)) {
        if (waits && Clock::now() - start >= kWaking) {
            wake(others, step);
            waits = false;
        }
    }
    const Clock::duration spent = Clock::now() - start;
    const std::lock_guard lock(mutex_);
    spent_ += spent;
}

ThreadPool::Clock::duration ThreadPool::rest() {
    std::unique_lock lock(mutex_);
    wanted_ = 0;
    finished_.wait(lock, [this] { return running_ == 0; });
    return std::exchange(spent_, {});
}

void ThreadPool::wake(std::uint32_t others, const Step& step) {
    {
        const std::lock_guard lock(mutex_);
        step_ = &step;
        wanted_ = others;
        ++round_;
    }
    start_.notify_all();
}

template <class Call> void ThreadPool::attempt(const Call& call) noexcept {
    try {
        call();
    } catch (...) {
        const std::lock_guard lock(mutex_);
        if (thrown_ == nullptr) {
            thrown_ = std::current_exception();
        }
    }
}

void ThreadPool::work(std::uint32_t thread) {
    std::uint64_t seen = 0;
    std::unique_lock lock(mutex_);
    while (true) {
        start_.wait(lock, [&] { return stopping_ || (round_ != seen && thread <= wanted_); });
        if (stopping_) {
            return;
        }
        seen = round_;
        ++running_;
        const Step& step = *step_;
        lock.unlock();
        const Clock::time_point start = Clock::now();
        attempt([&] {
            while (step(thread)) {
            }
        });
        const Clock::duration spent = Clock::now() - start;
        lock.lock();
        spent_ += spent;
        if (--running_ == 0) {
            finished_.notify_one();
        }
    }
}

} // namespace voxtact::cpu
