// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace voxtact::cpu {

/// When a call's other threads are woken.
enum class WakeOthers : std::uint8_t {
    AtOnce,
    /// Wakes threads late if the last two calls, with at least as many pieces, took less time than waking a thread:
    /// after this time, and the first piece. Otherwise at once. A call of a few long pieces after two short calls may
    /// take twice as long.
    Predicted
};

/// Threads that wait for work between calls. The caller is one of them.
class ThreadPool {
  public:
    /// Does one of the pieces that are left on the thread of that number, 0 for the caller's; false: none was left.
    /// Any number of threads call it at once.
    using Step = std::function<bool(std::uint32_t thread)>;

    /// Throws std::system_error where the system has no more threads.
    explicit ThreadPool(std::uint32_t threads);
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;
    ~ThreadPool();

    [[nodiscard]] std::uint32_t threads() const noexcept { return static_cast<std::uint32_t>(workers_.size()) + 1; }
    /// Calls `step` for all pieces; returns when all threads have stopped. Does not wait for a thread that wakes after
    /// the last piece has begun. Rethrows the first exception of a thread, such as std::bad_alloc.
    void run(std::uint64_t pieces, const Step& step, WakeOthers when = WakeOthers::AtOnce);

  private:
    using Clock = std::chrono::steady_clock;

    void work(std::uint32_t thread);
    /// The caller's part.
    void lead(std::uint32_t others, const Step& step, bool alone);
    void wake(std::uint32_t others, const Step& step);
    /// Waits for those that have joined, and returns how long all pieces took; from then on none joins.
    Clock::duration rest();
    template <class Call> void attempt(const Call& call) noexcept;
    void stop() noexcept;

    std::mutex mutex_;
    std::condition_variable start_;
    std::condition_variable finished_;
    const Step* step_ = nullptr;
    std::uint64_t round_ = 0;
    std::uint32_t wanted_ = 0;  ///< threads that may join this round
    std::uint32_t running_ = 0; ///< joined threads that have not stopped
    std::exception_ptr thrown_; ///< in this round
    Clock::duration spent_{};   ///< by all threads
    /// Pieces of the last call and of the one before it, 0 where all of its pieces together took as long as waking.
    std::array<std::uint64_t, 2> brief_{};
    bool stopping_ = false;
    std::vector<std::thread> workers_;
};

} // namespace voxtact::cpu
