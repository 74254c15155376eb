// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/answers/live_answer.h"
#include "voxtact/error.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

/// The counts of all methods side by side: every way to answer is asked the same question, one after the other.
namespace voxtact::view {

struct ComparedMethod {
    MethodChoice method;
    std::optional<LiveAnswer> answer; ///< nothing: not yet, or refused
    std::string refused;              ///< why it cannot answer; empty: it can, or is not asked yet
};

class Comparison {
  public:
    /// Asks these methods about an edit from the first on. Answers to what was asked before are none any more.
    void begin(const Edit& edit, std::span<const MethodChoice> methods);
    /// Whether it is about this, whatever is chosen.
    [[nodiscard]] bool isOf(const Edit& edit) const { return serial_ > 0 && edit_ == edit; }

    /// What is to be asked next, whose answer is to be given to take(); nothing while an answer is waited for, and
    /// where all have answered.
    [[nodiscard]] std::optional<LiveQuestion> next();
    /// The answer to what next() gave last. One that was cancelled is asked for again.
    void take(Result<LiveAnswer> answer);

    /// In the order of begin(). Those of the edit before until there is another.
    [[nodiscard]] const std::vector<ComparedMethod>& methods() const { return methods_; }
    /// How many of them have answered, or were refused.
    [[nodiscard]] std::size_t answered() const { return answered_; }
    /// Nothing is left to ask, and nothing is waited for.
    [[nodiscard]] bool complete() const { return !waiting_ && answered_ == methods_.size(); }
    /// One more with each begin().
    [[nodiscard]] std::uint64_t serial() const { return serial_; }

  private:
    Edit edit_;
    std::vector<ComparedMethod> methods_;
    std::size_t answered_ = 0;  ///< the first so many
    std::uint64_t serial_ = 0;  ///< the revision of its questions
    std::uint64_t waiting_ = 0; ///< of the question whose answer is waited for; 0: none
};

} // namespace voxtact::view
