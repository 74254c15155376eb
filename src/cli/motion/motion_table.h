// SPDX-License-Identifier: MIT
#pragma once

#include "io/text/table.h"
#include "voxtact/data.h"
#include "voxtact/motion.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace voxtact::app {

/// One segment of one mesh against one volume.
struct MotionRow {
    std::uint32_t mesh = 0; ///< indices in their lists
    std::uint32_t volume = 0;
    SegmentMotion motion;
    bool halfTurn = false; ///< within rounding, so that rounding decides the sense of rotation
};

/// Inputs of the rows.
struct MotionTable {
    const std::vector<std::string>& meshes; ///< as given
    const std::vector<std::string>& volumes;
    const std::optional<LabelData>& labels;
    const std::map<std::int32_t, std::string>& labelNames;
    const std::vector<char>* isResampled; ///< of each volume; null: no column
    std::span<const MotionRow> rows;
    const io::NamedCells& facts; ///< JSON members before the rows

    /// Returns the table, which references all members.
    [[nodiscard]] io::Table table() const;
};

} // namespace voxtact::app
