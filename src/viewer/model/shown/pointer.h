// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/shown/slice.h"

#include <array>
#include <cstddef>
#include <deque>
#include <optional>

namespace voxtact::view {

/// Pointer events between two frames, in order and with positions: a slow frame neither misses a click nor mistakes
/// earlier motion for a drag.
class Pointer {
  public:
    static constexpr std::size_t kButtons = 3;

    /// Pointer state of a frame.
    struct Seen {
        std::optional<Point2> at; ///< position of a button's change; empty: the pointer's position
        std::array<bool, kButtons> down{};
        std::array<int, kButtons>
            clicks{}; ///< number of presses in quick succession at one position, including this one; 0: no press
    };

    void moveTo(const Point2& at) { place_ = at; }
    /// `reach`: maximum distance of consecutive clicks of a double click.
    void press(std::size_t button, double seconds, double reach);
    void release(std::size_t button);

    /// Returns the state for a frame that begins now: up to the next change of a button.
    [[nodiscard]] Seen next(double seconds);
    /// True if events are pending.
    [[nodiscard]] bool behind() const noexcept { return !steps_.empty(); }

  private:
    struct Step {
        Point2 at{};
        std::size_t button = 0;
        bool down = false;
        int clicks = 0; ///< of a press
    };
    struct Click {
        Point2 at{};
        double seconds = 0;
        int number = 0;
    };

    std::deque<Step> steps_;
    std::array<bool, kButtons> down_{}; ///< as the last frame saw them
    std::array<Click, kButtons> last_{};
    Point2 place_{};
    Point2 told_{};     ///< position in the last step, else in the last frame
    double looked_ = 0; ///< when the last frame began
};

} // namespace voxtact::view
