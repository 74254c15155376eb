// SPDX-License-Identifier: MIT
#include "cli/output/progress.h"

#include "cli/output/standard_streams.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace voxtact::app {

namespace {

constexpr auto kFirst = std::chrono::milliseconds(500);
constexpr auto kBetween = std::chrono::milliseconds(100);
constexpr auto kBetweenLines = std::chrono::minutes(1);
constexpr std::size_t kWidth = 30;

} // namespace

std::string roughly(double seconds) {
    constexpr double kMinute = 60;
    constexpr std::uint64_t kHour = 60; // minutes
    if (seconds < 1.5 * kMinute) {
        return std::to_string(std::llround(std::max(seconds, 1.0))) + " s";
    }
    const auto minutes = static_cast<std::uint64_t>(std::llround(std::min(seconds / kMinute, 1e9)));
    if (minutes < 2 * kHour) {
        return std::to_string(minutes) + " min";
    }
    return std::to_string(minutes / kHour) + " h " + std::to_string(minutes % kHour) + " min";
}

std::string withCommas(std::uint64_t number) {
    std::string text = std::to_string(number);
    for (std::size_t at = text.size(); at > 3; at -= 3) {
        text.insert(at - 3, ",");
    }
    return text;
}

std::string timeLeft(std::uint64_t done, std::uint64_t total, double secondsSoFar) {
    constexpr double kSoonest = 1; // s: earlier estimates are too inaccurate
    if (done == 0 || done >= total || secondsSoFar < kSoonest) {
        return {};
    }
    const double each = secondsSoFar / static_cast<double>(done);
    return ", about " + roughly(each * static_cast<double>(total - done)) + " left";
}

Progress::Progress(bool wanted, std::string title, std::uint64_t total)
    : wanted_(wanted), terminal_(errorIsTerminal()), title_(std::move(title)), total_(total), begun_(Clock::now()),
      next_(begun_ + (terminal_ ? std::chrono::milliseconds(kFirst) : std::chrono::milliseconds(kBetweenLines))) {}

Progress::~Progress() {
    if (lineLength_ > 0) {
        const std::string blank(lineLength_, ' ');
        std::fprintf(stderr, "\r%s\r", blank.c_str());
    }
}

void Progress::update(std::uint64_t done) {
    const auto now = Clock::now();
    if (!wanted_ || now < next_) {
        return;
    }
    next_ = now + (terminal_ ? std::chrono::milliseconds(kBetween) : std::chrono::milliseconds(kBetweenLines));
    const double seconds = std::chrono::duration<double>(now - begun_).count();
    const std::string rest =
        doing_ + withCommas(done) + (total_ > 0 ? " of " + withCommas(total_) : "") + timeLeft(done, total_, seconds);
    if (terminal_) {
        drawBar(done, rest);
    } else {
        std::fprintf(stderr, "%s: %s\n", title_.c_str(), rest.c_str());
    }
}

void Progress::drawBar(std::uint64_t done, const std::string& rest) {
    std::string line = title_ + " ";
    if (total_ > 0) {
        const auto filled = static_cast<std::size_t>(static_cast<double>(std::min(done, total_)) /
                                                     static_cast<double>(total_) * static_cast<double>(kWidth));
        line += "[" + std::string(filled, '#') + std::string(kWidth - filled, '.') + "] ";
    }
    line += rest;
    // Erases the rest of a longer line.
    const std::size_t length = line.size();
    line.append(lineLength_ > length ? lineLength_ - length : 0, ' ');
    lineLength_ = std::max(lineLength_, length);
    std::fprintf(stderr, "\r%s", line.c_str());
}

} // namespace voxtact::app
