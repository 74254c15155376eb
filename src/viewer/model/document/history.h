// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <utility>
#include <vector>

namespace voxtact::view {

/// Undo and redo of a value: what it was before each command. `Value` needs ==.
template <class Value> class History {
  public:
    /// A command that made `before` to `now`. Those with one `merge`, where it is not empty, are one command as long
    /// as nothing else comes between them and end() is not called: the steps of one drag. Nothing where both are equal.
    void add(const Value& before, const Value& now, const std::string& merge) {
        if (before == now) {
            return;
        }
        undone_.clear();
        if (!merge.empty() && merge == merge_ && !done_.empty()) {
            return; // the state before the first of them is already kept
        }
        done_.push_back(before);
        merge_ = merge;
        if (done_.size() > kMost) {
            done_.pop_front();
        }
    }
    /// The next command is one of its own.
    void end() { merge_.clear(); }

    [[nodiscard]] bool canUndo() const { return !done_.empty(); }
    [[nodiscard]] bool canRedo() const { return !undone_.empty(); }
    /// `value` becomes what it was. Nothing where there is nothing to undo.
    void undo(Value& value) { step(done_, undone_, value); }
    void redo(Value& value) { step(undone_, done_, value); }

  private:
    static constexpr std::size_t kMost = 1000;

    void step(std::deque<Value>& from, std::deque<Value>& to, Value& value) {
        if (from.empty()) {
            return;
        }
        to.push_back(std::move(value));
        value = std::move(from.back());
        from.pop_back();
        merge_.clear();
    }

    std::deque<Value> done_;
    std::deque<Value> undone_;
    std::string merge_;
};

} // namespace voxtact::view
