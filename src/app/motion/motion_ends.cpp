// SPDX-License-Identifier: MIT
#include "app/motion/motion_run.h"

#include <algorithm>

namespace voxtact::app {

void MotionEnds::add(std::span<const MotionRow> rows) {
    for (const MotionRow& row : rows) {
        grazing += row.motion.end == MotionEnd::Grazes ? 1 : 0;
        cut += row.motion.end == MotionEnd::Budget ? 1 : 0;
        if (row.halfTurn && row.mesh == 0 && row.volume == 0) { // once for all meshes and volumes
            firstHalfTurn = halfTurns == 0 ? row.motion.pose : std::min(firstHalfTurn, row.motion.pose);
            ++halfTurns;
        }
    }
}

void MotionEnds::add(const MotionEnds& more) {
    if (more.halfTurns > 0) {
        firstHalfTurn = halfTurns == 0 ? more.firstHalfTurn : std::min(firstHalfTurn, more.firstHalfTurn);
    }
    grazing += more.grazing;
    cut += more.cut;
    halfTurns += more.halfTurns;
}

void MotionEnds::addTo(std::vector<std::string>& notes) const {
    if (halfTurns > 0) {
        notes.push_back("segments that turn by 180 degrees to within 0.0001: " + std::to_string(halfTurns) +
                        ", the first of them " + std::to_string(firstHalfTurn) +
                        "; the poses' last digits decide which way round they go, and a pose in between would say it");
    }
    if (grazing > 0) {
        notes.push_back("segments that graze: " + std::to_string(grazing) +
                        "; their free_until and touch_at are farther apart than "
                        "--resolution-mm, or there is no touch_at");
    }
    if (cut > 0) {
        notes.push_back("segments that took too many steps: " + std::to_string(cut) +
                        "; they are free until free_until, and of the rest of them nothing "
                        "is known but the touch at touch_at, where there is one");
    }
}

} // namespace voxtact::app
