// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace voxtact::cpu {

/// Threads that wait for work between calls. The caller is one of them.
class ThreadPool {
  public:
    /// Throws std::system_error where the system has no more threads.
    explicit ThreadPool(std::uint32_t threads);
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;
    ~ThreadPool();

    [[nodiscard]] std::uint32_t threads() const noexcept { return static_cast<std::uint32_t>(workers_.size()) + 1; }
    /// Calls `body(thread)` on `threads` of the pool's threads, numbered from 0 (the caller's), and waits for all. What
    /// one of them throws, the first of several, is thrown then: no memory, say.
    void run(std::uint32_t threads, const std::function<void(std::uint32_t)>& body);

  private:
    void work(std::uint32_t thread);
    void attempt(const std::function<void(std::uint32_t)>& body, std::uint32_t thread) noexcept;
    void stop() noexcept;

    std::mutex mutex_;
    std::condition_variable start_;
    std::condition_variable finished_;
    const std::function<void(std::uint32_t)>* body_ = nullptr;
    std::uint64_t round_ = 0;
    std::uint32_t wanted_ = 0;  ///< threads of this round
    std::uint32_t running_ = 0; ///< of them, those that have not finished
    std::exception_ptr thrown_; ///< in this round
    bool stopping_ = false;
    std::vector<std::thread> workers_;
};

} // namespace voxtact::cpu
