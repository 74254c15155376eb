// SPDX-License-Identifier: MIT
#pragma once

#include "app/chunks/run_chunks.h"
#include "app/mpi/chunk_deck.h"

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>

/// How the ranks of an MPI job share a run: the first one has the deck, and the others ask it.
namespace voxtact::app {

/// What a rank did.
struct RankWork {
    std::uint64_t chunks = 0;
    double seconds = 0; ///< between being dealt a chunk and asking for the next
};

/// A rank says one of these to the first one, which answers the first two with a number.
struct RankMessage {
    enum Kind : std::uint64_t {
        Hello, ///< may it begin? kGo, or kNone: no
        Ask,   ///< the next chunk? Its number, or kNone
        Done,  ///< it has asked for the last time; `work` is what it did
    };
    std::uint64_t kind = Hello;
    RankWork work;
};
constexpr std::int64_t kNone = -1;
constexpr std::int64_t kGo = 1;

/// Of the first rank. The program runs in one thread, which deals to itself; another one deals to the other ranks.
class DeckHolder : public ChunkDealer {
  public:
    [[nodiscard]] bool leads() const override { return true; }
    void begin(const RunFolder* folder, const ChunkCut& cut) override;
    [[nodiscard]] std::optional<std::uint64_t> next() override { return deal(0); }
    [[nodiscard]] std::uint64_t rowsElsewhere() const override;
    /// Until othersEnded().
    void end(const std::function<void()>& tick) override;

    // For the other thread:
    /// Whether there is a folder and a deck.
    [[nodiscard]] bool ready() const { return ready_; }
    /// To any rank, which has done what it had.
    [[nodiscard]] std::optional<std::uint64_t> deal(int rank);
    void othersEnded() { othersEnded_ = true; }
    /// Chunks that were there before.
    [[nodiscard]] std::uint64_t found() const { return found_; }
    /// Of this rank; and from begin() to end(), of all.
    [[nodiscard]] const RankWork& work() const { return work_; }
    [[nodiscard]] double seconds() const { return seconds_; }

  private:
    using Clock = std::chrono::steady_clock;

    mutable std::mutex mutex_;
    std::optional<ChunkCut> cut_;
    std::optional<ChunkDeck> deck_;
    std::map<int, std::uint64_t> busy_; ///< the chunk that a rank has
    std::uint64_t rowsElsewhere_ = 0;
    std::uint64_t found_ = 0;
    RankWork work_;
    Clock::time_point begun_;
    Clock::time_point dealt_;
    double seconds_ = 0;
    std::atomic<bool> ready_{false};
    std::atomic<bool> othersEnded_{false};
};

/// Of every other rank. All calls of MPI are its thread's.
class DeckAsker : public ChunkDealer {
  public:
    [[nodiscard]] bool leads() const override { return false; }
    void begin(const RunFolder* folder, const ChunkCut& cut) override;
    [[nodiscard]] std::optional<std::uint64_t> next() override;
    void end(const std::function<void()>& tick) override;

    /// Whether the first rank knows that this one has ended.
    [[nodiscard]] bool ended() const { return ended_; }

  private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] std::int64_t ask(RankMessage::Kind kind) const;

    bool mayBegin_ = false;
    bool hasChunk_ = false;
    bool ended_ = false;
    RankWork work_;
    Clock::time_point dealt_;
};

/// Tags of messages.
constexpr int kMessageTag = 1; ///< a RankMessage to the first rank
constexpr int kAnswerTag = 2;  ///< a number from there
constexpr int kEndTag = 3;     ///< a RankEnd, once the program of the rank has ended

/// Waits without using the processor, which others may need: for a message, or an interrupt (false).
[[nodiscard]] bool waitForMessage(int from, int tag);

} // namespace voxtact::app
