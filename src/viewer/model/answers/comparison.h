// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/answers/live_answer.h"
#include "voxtact/error.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

/// The counts of all methods side by side: every method is asked the same question, one after the other.
namespace voxtact::view {

struct ComparedMethod {
    MethodChoice method;
    std::optional<LiveAnswer> answer; ///< empty: pending or refused
    std::string refused;              ///< reason of a refusal; empty: none, or pending
};

class Comparison {
  public:
    /// Starts a comparison of these methods on an edit. Discards pending answers.
    void begin(const Edit& edit, std::span<const MethodChoice> methods);
    /// True if the comparison is about this edit, whichever mesh is chosen.
    [[nodiscard]] bool isOf(const Edit& edit) const { return serial_ > 0 && edit_ == edit; }

    /// Returns the next question, whose answer goes to take(); empty while an answer is pending, and after the last
    /// one.
    [[nodiscard]] std::optional<LiveQuestion> next();
    /// Takes the answer to the last question of next(). A cancelled question is asked again.
    void take(Result<LiveAnswer> answer);

    /// Returns the answers in the order of begin(); those of the previous edit until new ones exist.
    [[nodiscard]] const std::vector<ComparedMethod>& methods() const { return methods_; }
    /// Number of methods that have answered or failed.
    [[nodiscard]] std::size_t answered() const { return answered_; }
    /// Returns true if no question is left or pending.
    [[nodiscard]] bool complete() const { return !waiting_ && answered_ == methods_.size(); }
    /// Returns the number of calls of begin().
    [[nodiscard]] std::uint64_t serial() const { return serial_; }

  private:
    Edit edit_;
    std::vector<ComparedMethod> methods_;
    std::size_t answered_ = 0;  ///< the first methods have answered
    std::uint64_t serial_ = 0;  ///< the revision of its questions
    std::uint64_t waiting_ = 0; ///< of the pending question; 0: none
};

} // namespace voxtact::view
