// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <vector>

namespace voxtact::view {

/// Letters and editing keys in the order of typing, for any number between two frames. Dear ImGui takes a frame's
/// letters before its keys, so a frame has the letters up to the first key.
class Keystrokes {
  public:
    struct Frame {
        std::vector<unsigned> letters; ///< Unicode
        std::optional<int> key;        ///< as GLFW numbers it: it goes down now
    };

    void addLetter(unsigned letter) { waiting_.push_back({letter, std::nullopt}); }
    void addKey(int key) { waiting_.push_back({0, key}); }
    /// Removes and returns the keystrokes of the next frame.
    [[nodiscard]] Frame next() {
        Frame frame;
        while (!waiting_.empty() && !frame.key) {
            const Stroke stroke = waiting_.front();
            waiting_.pop_front();
            if (stroke.key) {
                frame.key = stroke.key;
            } else {
                frame.letters.push_back(stroke.letter);
            }
        }
        return frame;
    }
    /// True if a later frame has keystrokes.
    [[nodiscard]] bool behind() const { return !waiting_.empty(); }
    /// True if a key press is pending.
    [[nodiscard]] bool waits(int key) const {
        return std::ranges::any_of(waiting_, [key](const Stroke& stroke) { return stroke.key == key; });
    }

  private:
    struct Stroke {
        unsigned letter = 0;
        std::optional<int> key;
    };

    std::deque<Stroke> waiting_;
};

} // namespace voxtact::view
