// SPDX-License-Identifier: MIT
#include "app/progress.h"

#include <algorithm>
#include <cstdio>

namespace voxtact::app {

namespace {

constexpr auto kFirst = std::chrono::milliseconds(500);
constexpr auto kBetween = std::chrono::milliseconds(100);
constexpr std::size_t kWidth = 30;

} // namespace

Progress::Progress(bool shown, std::string title, std::uint64_t total)
    : shown_(shown && total > 0), title_(std::move(title)), total_(total),
      next_(std::chrono::steady_clock::now() + kFirst) {}

Progress::~Progress() {
    if (lineLength_ > 0) {
        const std::string blank(lineLength_, ' ');
        std::fprintf(stderr, "\r%s\r", blank.c_str());
    }
}

void Progress::update(std::uint64_t done) {
    const auto now = std::chrono::steady_clock::now();
    if (!shown_ || now < next_) {
        return;
    }
    next_ = now + kBetween;
    const auto filled = static_cast<std::size_t>(std::min(done, total_) * kWidth / total_);
    const std::string line = title_ + " [" + std::string(filled, '#') + std::string(kWidth - filled, '.') + "] " +
                             std::to_string(done) + "/" + std::to_string(total_);
    lineLength_ = std::max(lineLength_, line.size());
    std::fprintf(stderr, "\r%s", line.c_str());
}

} // namespace voxtact::app
