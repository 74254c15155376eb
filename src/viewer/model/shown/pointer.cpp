// SPDX-License-Identifier: MIT
#include "viewer/model/shown/pointer.h"

#include <algorithm>
#include <cmath>

namespace voxtact::view {

namespace {

constexpr double kSoon = 0.3; // s, between two clicks that belong together

} // namespace

void Pointer::press(std::size_t button, double seconds, double reach) {
    if (button >= kButtons) {
        return;
    }
    Click& last = last_[button];
    // A press reaches the next frame: it may be as early as the previous one.
    const bool soon = std::min(looked_, seconds) - last.seconds < kSoon;
    const bool near = std::hypot(place_[0] - last.at[0], place_[1] - last.at[1]) < reach;
    last = {place_, seconds, last.number > 0 && soon && near ? last.number + 1 : 1};
    steps_.push_back({place_, button, true, last.number});
    told_ = place_;
}

void Pointer::release(std::size_t button) {
    if (button >= kButtons) {
        return;
    }
    // A drag has its whole way before it ends.
    if (told_ != place_) {
        steps_.push_back({place_, button, true, 0});
    }
    steps_.push_back({place_, button, false, 0});
    told_ = place_;
}

Pointer::Seen Pointer::next(double seconds) {
    looked_ = seconds;
    Seen seen;
    if (!steps_.empty()) {
        const Step step = steps_.front();
        steps_.pop_front();
        down_[step.button] = step.down;
        seen.at = step.at;
        seen.clicks[step.button] = step.clicks;
    } else {
        told_ = place_;
    }
    seen.down = down_;
    return seen;
}

} // namespace voxtact::view
