// SPDX-License-Identifier: MIT
#include "cpu/thread_pool.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>

namespace voxtact::cpu {

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

void ThreadPool::run(std::uint32_t threads, const std::function<void(std::uint32_t)>& body) {
    const std::uint32_t others = std::min<std::uint32_t>(threads, this->threads()) - 1;
    if (others > 0) {
        {
            const std::lock_guard lock(mutex_);
            body_ = &body;
            wanted_ = others;
            running_ = others;
            ++round_;
        }
        start_.notify_all();
    }
    attempt(body, 0);
    std::unique_lock lock(mutex_);
    finished_.wait(lock, [this] { return running_ == 0; });
    if (thrown_ != nullptr) {
        std::rethrow_exception(std::exchange(thrown_, nullptr));
    }
}

void ThreadPool::attempt(const std::function<void(std::uint32_t)>& body, std::uint32_t thread) noexcept {
    try {
        body(thread);
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
        const std::function<void(std::uint32_t)>& body = *body_;
        lock.unlock();
        attempt(body, thread);
        lock.lock();
        if (--running_ == 0) {
            finished_.notify_one();
        }
    }
}

} // namespace voxtact::cpu
