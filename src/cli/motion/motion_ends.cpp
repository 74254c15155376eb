// SPDX-License-Identifier: MIT
#include "cli/motion/motion_run.h"

#include <algorithm>

namespace voxtact::app {

void MotionEnds::add(std::span<const MotionRow> rows) {
    for (const MotionRow& row : rows) {
        firstTouch = row.motion.touch && (touches == 0 || row.motion.pose < firstTouch) ? row.motion.pose : firstTouch;
        touches += row.motion.touch ? 1 : 0;
        undecided += row.motion.possible ? 1 : 0;
        ++segments;
        grazing += row.motion.end == MotionEnd::Grazes ? 1 : 0;
        cut += row.motion.end == MotionEnd::Budget ? 1 : 0;
        if (row.halfTurn && row.mesh == 0 && row.volume == 0) { // once for all meshes and volumes
            firstHalfTurn = halfTurns == 0 ? row.motion.pose : std::min(firstHalfTurn, row.motion.pose);
            ++halfTurns;
        }
    }
}

void MotionEnds::addTo(std::vector<std::string>& notes) const {
    if (halfTurns > 0) {
        notes.push_back("segments within 0.0001 degrees of half a turn: " + std::to_string(halfTurns) +
                        ", first: " + std::to_string(firstHalfTurn) +
                        "; rounding decides the sense of rotation; add a pose in between");
    }
    if (grazing > 0) {
        notes.push_back("segments that graze: " + std::to_string(grazing) +
                        "; toi_lower and toi_upper are farther apart than --resolution, or toi_upper is unknown");
    }
    if (cut > 0) {
        notes.push_back("segments that reached the iteration limit: " + std::to_string(cut) +
                        "; undecided between toi_lower and toi_upper");
    }
}

std::string MotionEnds::summary() const {
    return std::to_string(segments) + " segments: " + std::to_string(touches) + " touch, " +
           std::to_string(segments - touches - undecided) + " do not, " + std::to_string(undecided) + " undecided" +
           (touches > 0 ? "; first touch after pose " + std::to_string(firstTouch) : "");
}

} // namespace voxtact::app
