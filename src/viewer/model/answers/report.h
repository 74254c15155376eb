// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/answers/comparison.h"
#include "viewer/model/answers/live_answer.h"
#include "viewer/model/answers/live_measures.h"
#include "viewer/model/document/labels.h"
#include "viewer/model/document/question.h"
#include "viewer/model/files/loading.h"
#include "viewer/model/shown/view_cube.h"

#include <array>
#include <string>
#include <vector>

namespace voxtact::view {

/// Contents of --report-state.
struct StateReport {
    const LiveAnswer* answer = nullptr;     ///< null where there is none yet
    const Times* times = nullptr;           ///< must be given
    const Document* document = nullptr;     ///< must be given
    std::vector<std::string> commands;      ///< commandFor() of each of its instruments; empty without an answer
    const LiveMeasures* measures = nullptr; ///< null where there is none yet
    const Labels* labels = nullptr;         ///< null where there is no label map
    std::array<double, 4> picture{};        ///< where it is in the window: corner and size, points
    ViewDirection direction;                ///< direction of the view
    std::optional<ViewCube> cube;           ///< in the picture; null: it is too small for it
    std::array<double, 4> chart{};          ///< where the curve's chart is, the same
    ValueRange chartRange;                  ///< the values that it shows
    std::string device;                     ///< that answered; "host" for cpu
    std::string error;                      ///< text of the open dialog; empty: none
    const Question* question = nullptr;     ///< open dialog with a choice; null: none
    std::optional<std::string> field;       ///< text of the focused path field; null: none
    const Loading* loading = nullptr;       ///< null: nothing is being loaded
    const Loading* loaded = nullptr;        ///< statistics of the last loading; null: not known yet
    const Comparison* comparison = nullptr; ///< of the methods; null where it is not shown
    std::optional<double> saving;           ///< progress of a picture for a file
    std::vector<std::string> notes;         ///< notes on the contents
    std::string status;                     ///< last action
    std::uint64_t frame = 0;                ///< frames shown until then
    const Times* frameTimes = nullptr;      ///< from one frame to the next, of the last ones; must be given
    bool settled = false;                   ///< the answer matches the contents, and the fine picture is complete
};

/// One JSON object.
[[nodiscard]] std::string reportText(const StateReport& report);

} // namespace voxtact::view
