// SPDX-License-Identifier: MIT
#include "viewer/model/answers/comparison.h"

#include <utility>

namespace voxtact::view {

void Comparison::begin(const Edit& edit, std::span<const MethodChoice> methods) {
    edit_ = edit;
    methods_.clear();
    for (const MethodChoice& method : methods) {
        methods_.push_back({method, std::nullopt, {}});
    }
    answered_ = 0;
    ++serial_;
}

std::optional<LiveQuestion> Comparison::next() {
    if (waiting_ != 0 || answered_ == methods_.size()) {
        return std::nullopt;
    }
    waiting_ = serial_;
    return LiveQuestion{serial_, edit_, methods_[answered_].method};
}

void Comparison::take(Result<LiveAnswer> answer) {
    const bool ofThis = std::exchange(waiting_, 0) == serial_;
    const bool cancelled = !answer.ok() && answer.error().code == ErrorCode::Cancelled;
    if (!ofThis || cancelled || answered_ == methods_.size()) {
        return;
    }
    ComparedMethod& method = methods_[answered_++];
    if (answer.ok()) {
        method.answer = std::move(*answer);
    } else {
        method.refused = answer.error().text;
    }
}

} // namespace voxtact::view
