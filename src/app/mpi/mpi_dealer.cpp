// SPDX-License-Identifier: MIT
#include "app/mpi/mpi_dealer.h"

#include "app/output/interrupt.h"

#include <mpi.h>

#include <thread>

namespace voxtact::app {

namespace {

constexpr auto kWait = std::chrono::microseconds(500);

double secondsSince(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

} // namespace

bool waitForMessage(int from, int tag) {
    for (int there = 0; there == 0;) {
        MPI_Iprobe(from, tag, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
        if (there == 0) {
            if (interrupted()) {
                return false;
            }
            std::this_thread::sleep_for(kWait);
        }
    }
    return true;
}

void DeckHolder::begin(const RunFolder* folder, const ChunkCut& cut) {
    std::vector<std::uint64_t> chunks;
    std::uint64_t rows = 0;
    for (std::uint64_t chunk = 0; chunk < cut.chunks(); ++chunk) {
        if (folder->stateOf(chunk) == ChunkState::Whole) {
            rows += cut.at(chunk).count;
        } else {
            chunks.push_back(chunk);
        }
    }
    const std::lock_guard lock(mutex_);
    cut_ = cut;
    deck_.emplace(*cut_, chunks);
    found_ = cut.chunks() - chunks.size();
    rowsElsewhere_ = rows;
    begun_ = Clock::now();
    ready_ = true;
}

std::optional<std::uint64_t> DeckHolder::deal(int rank) {
    const std::lock_guard lock(mutex_);
    if (const auto had = busy_.find(rank); had != busy_.end()) {
        if (rank == 0) {
            ++work_.chunks;
            work_.seconds += secondsSince(dealt_);
        } else {
            rowsElsewhere_ += cut_->at(had->second).count;
        }
        busy_.erase(had);
    }
    const std::optional<std::uint64_t> chunk = deck_->deal(rank);
    if (chunk) {
        busy_.emplace(rank, *chunk);
        dealt_ = rank == 0 ? Clock::now() : dealt_;
    }
    return chunk;
}

std::uint64_t DeckHolder::rowsElsewhere() const {
    const std::lock_guard lock(mutex_);
    return rowsElsewhere_;
}

void DeckHolder::end(const std::function<void()>& tick) {
    while (!othersEnded_ && !interrupted()) {
        tick();
        std::this_thread::sleep_for(kWait);
    }
    seconds_ = secondsSince(begun_);
}

std::int64_t DeckAsker::ask(RankMessage::Kind kind) const {
    const RankMessage message{kind, work_};
    MPI_Send(&message, sizeof message, MPI_BYTE, 0, kMessageTag, MPI_COMM_WORLD);
    std::int64_t answer = kNone;
    if (kind != RankMessage::Done && waitForMessage(0, kAnswerTag)) {
        MPI_Recv(&answer, 1, MPI_INT64_T, 0, kAnswerTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    }
    return answer;
}

void DeckAsker::begin(const RunFolder* /*folder*/, const ChunkCut& /*cut*/) {
    mayBegin_ = ask(RankMessage::Hello) == kGo;
}

std::optional<std::uint64_t> DeckAsker::next() {
    if (hasChunk_) {
        ++work_.chunks;
        work_.seconds += secondsSince(dealt_);
    }
    const std::int64_t chunk = mayBegin_ ? ask(RankMessage::Ask) : kNone;
    dealt_ = Clock::now();
    hasChunk_ = chunk != kNone;
    return hasChunk_ ? std::optional(static_cast<std::uint64_t>(chunk)) : std::nullopt;
}

void DeckAsker::end(const std::function<void()>& /*tick*/) {
    if (!interrupted()) {
        static_cast<void>(ask(RankMessage::Done));
        ended_ = true;
    }
}

} // namespace voxtact::app
