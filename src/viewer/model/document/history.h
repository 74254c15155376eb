// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <utility>
#include <vector>

namespace voxtact::view {

/// Undo and redo of a value: its states before each command. `Value` needs ==.
template <class Value> class History {
  public:
    /// Adds a command that changed `before` to `now`; ignores equal ones. Consecutive commands with the same `merge`,
    /// if not empty, are one command until end(): the steps of a drag.
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
    /// Separates the next command.
    void end() { merge_.clear(); }

    [[nodiscard]] bool canUndo() const { return !done_.empty(); }
    [[nodiscard]] bool canRedo() const { return !undone_.empty(); }
    /// Restores the previous `value`, if any.
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
