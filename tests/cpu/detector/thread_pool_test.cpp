// SPDX-License-Identifier: MIT
#include "host/thread_pool.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

namespace voxtact::test {
namespace {

using cpu::ThreadPool;
using cpu::WakeOthers;

/// Pieces that are numbered, and done by the thread that asks for one.
class Pieces {
  public:
    explicit Pieces(std::size_t count) : times_(count) {}

    template <class Do> bool step(const Do& make) {
        const std::size_t piece = next_++;
        const bool some = piece < times_.size();
        if (some) {
            ++times_[piece];
            make(piece);
        }
        return some;
    }
    /// How often each was done.
    [[nodiscard]] const std::vector<std::atomic<int>>& times() const { return times_; }

  private:
    std::atomic<std::size_t> next_{0};
    std::vector<std::atomic<int>> times_;
};

/// Two that wait until both are there, or for 20 seconds.
class Meeting {
  public:
    /// Whether the other came.
    bool come() {
        ++there_;
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (there_ < 2 && std::chrono::steady_clock::now() < end) {
            std::this_thread::yield();
        }
        return there_ >= 2;
    }

  private:
    std::atomic<int> there_{0};
};

/// A call of so many pieces; each takes `each`, without sleeping.
void spend(ThreadPool& pool, std::size_t count, std::chrono::microseconds each, WakeOthers when) {
    Pieces pieces(count);
    pool.run(
        count,
        [&](std::uint32_t) {
            return pieces.step([&](std::size_t) {
                const auto end = std::chrono::steady_clock::now() + each;
                while (std::chrono::steady_clock::now() < end) {
                }
            });
        },
        when);
}

/// A call of two pieces that wait for each other: whether another thread came.
bool meets(ThreadPool& pool, WakeOthers when) {
    Meeting meeting;
    Pieces pieces(2);
    std::atomic<int> met{0};
    pool.run(
        2, [&](std::uint32_t) { return pieces.step([&](std::size_t) { met += meeting.come() ? 1 : 0; }); }, when);
    return met == 2;
}

constexpr std::chrono::microseconds kLong{100};
constexpr std::array kWhen{WakeOthers::AtOnce, WakeOthers::Predicted};

TEST(ThreadPoolTest, EveryPieceIsDoneOnce) {
    std::mt19937_64 random(testSeed());
    for (std::uint32_t threads = 1; threads <= 5; ++threads) {
        ThreadPool pool(threads);
        ASSERT_EQ(pool.threads(), threads);
        for (int round = 0; round < 400; ++round) {
            Pieces pieces(std::uniform_int_distribution<std::size_t>(0, 40)(random));
            const bool slow = random() % 8 == 0;
            std::atomic<std::uint32_t> most{0};
            pool.run(
                pieces.times().size(),
                [&](std::uint32_t thread) {
                    return pieces.step([&](std::size_t) {
                        if (slow) {
                            std::this_thread::sleep_for(std::chrono::microseconds(20));
                        }
                        for (std::uint32_t seen = most; thread > seen && !most.compare_exchange_weak(seen, thread);) {
                        }
                    });
                },
                kWhen[random() % 2]);
            for (const std::atomic<int>& times : pieces.times()) {
                ASSERT_EQ(times, 1) << round;
            }
            ASSERT_LT(most, threads);
        }
    }
}

// The second piece waits for the third one: no thread could do both.
TEST(ThreadPoolTest, OthersComeWhereItTakesLonger) {
    ThreadPool pool(2);
    for (const WakeOthers when : kWhen) {
        for (const int brief : {0, 20}) { // calls before it, after which a brief one is expected
            for (int i = 0; i < brief; ++i) {
                Pieces pieces(8);
                pool.run(
                    8, [&](std::uint32_t) { return pieces.step([](std::size_t) {}); }, when);
            }
            Meeting meeting;
            Pieces pieces(3);
            std::atomic<int> met{0};
            pool.run(
                3,
                [&](std::uint32_t) {
                    return pieces.step([&](std::size_t piece) {
                        if (piece == 0) {
                            std::this_thread::sleep_for(std::chrono::milliseconds(1));
                        } else {
                            met += meeting.come() ? 1 : 0;
                        }
                    });
                },
                when);
            EXPECT_EQ(met, 2) << brief;
        }
    }
}

// The first of two pieces waits for the second one: alone, the caller could not go on.
TEST(ThreadPoolTest, OthersComeAtOnceWhereThereAreMorePieces) {
    ThreadPool pool(2);
    for (int i = 0; i < 20; ++i) {
        spend(pool, 1, {}, WakeOthers::Predicted);
    }
    EXPECT_TRUE(meets(pool, WakeOthers::Predicted));
}

// Whichever thread did the pieces of the calls before, even if it was not the caller.
TEST(ThreadPoolTest, OthersComeAtOnceAfterLongCalls) {
    ThreadPool pool(2);
    for (int round = 0; round < 200; ++round) {
        spend(pool, 2, kLong, kWhen[static_cast<std::size_t>(round) % 2]);
        spend(pool, 2, kLong, WakeOthers::AtOnce);
        ASSERT_TRUE(meets(pool, WakeOthers::Predicted)) << round;
    }
}

TEST(ThreadPoolTest, OthersComeAtOnceAfterASingleBriefCall) {
    ThreadPool pool(2);
    for (int round = 0; round < 50; ++round) {
        spend(pool, 2, kLong, WakeOthers::Predicted);
        spend(pool, 2, {}, WakeOthers::Predicted);
        ASSERT_TRUE(meets(pool, WakeOthers::Predicted)) << round;
    }
}

// The step of a call is gone with it: who wakes up later must not ask it. Here it stays, and would see that.
TEST(ThreadPoolTest, WhoComesTooLateDoesNothing) {
    ThreadPool pool(4);
    std::atomic<bool> called{false};
    std::atomic<int> late{0};
    const ThreadPool::Step step = [&](std::uint32_t) {
        late += called ? 0 : 1;
        return false;
    };
    for (int round = 0; round < 300; ++round) {
        called = true;
        pool.run(4, step);
        called = false;
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    EXPECT_EQ(late, 0);
}

// Whatever piece it is, and whichever thread does it; the pool goes on after that.
TEST(ThreadPoolTest, WhatAPieceThrowsComesOutWhenAllAreAtRest) {
    std::mt19937_64 random(testSeed());
    ThreadPool pool(3);
    for (int round = 0; round < 300; ++round) {
        const std::size_t bad = random() % 12;
        Pieces pieces(12);
        std::atomic<int> inside{0};
        const auto run = [&] {
            pool.run(
                12,
                [&](std::uint32_t) {
                    return pieces.step([&](std::size_t piece) {
                        ++inside;
                        std::this_thread::sleep_for(std::chrono::microseconds(piece % 2 == 0 ? 0 : 15));
                        --inside;
                        if (piece == bad) {
                            throw std::runtime_error("bad");
                        }
                    });
                },
                kWhen[static_cast<std::size_t>(round) % 2]);
        };
        EXPECT_THROW(run(), std::runtime_error) << round;
        ASSERT_EQ(inside, 0) << round;
        Pieces after(6);
        pool.run(6, [&](std::uint32_t) { return after.step([](std::size_t) {}); });
        for (const std::atomic<int>& times : after.times()) {
            ASSERT_EQ(times, 1) << round;
        }
    }
}

} // namespace
} // namespace voxtact::test
