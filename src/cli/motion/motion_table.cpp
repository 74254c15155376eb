// SPDX-License-Identifier: MIT
#include "cli/motion/motion_table.h"

#include "cli/output/output.h"
#include "cli/output/text_for_messages.h"

#include <array>
#include <cmath>

namespace voxtact::app {

namespace {

/// Steps per mm: more digits than a nanometre have no meaning.
constexpr double kParts = 1e6;

io::Cell millimetres(double value) {
    return std::round(value * kParts) / kParts + 0.0;
}

io::Cell verdictOf(const SegmentMotion& motion) {
    return motion.touch      ? io::NumberWord{1, "yes"}
           : motion.possible ? io::NumberWord{2, "undecided"}
                             : io::NumberWord{0, "no"};
}

/// A label may be negative, which the integer of a cell cannot.
io::Cell labelCell(std::int32_t label) {
    return label < 0 ? io::Cell(static_cast<double>(label)) : io::Cell(static_cast<std::uint64_t>(label));
}

constexpr std::array kColumns{"pose", "mesh", "volume", "touch",    "toi_lower", "toi_upper",
                              "x",    "y",    "z",      "triangle", "label"};

/// A cell of the columns from toi_upper on.
io::Cell touchCell(const MotionTable& about, const MotionTouch& touch, std::size_t column) {
    const auto label = [&] { return about.labels->values[labelAt(*about.labels, touch.position)]; };
    switch (column) {
    case 5:
        return touch.at;
    case 6:
    case 7:
    case 8:
        return millimetres(touch.position[column - 6]);
    case 9:
        return std::uint64_t{touch.triangle};
    case 10:
        return about.labels ? labelCell(label()) : io::Cell();
    default: {
        const auto name = about.labelNames.find(label());
        return name == about.labelNames.end() ? std::to_string(label()) : name->second;
    }
    }
}

io::Cell cellOf(const MotionTable& about, const MotionRow& row, std::size_t column) {
    switch (column) {
    case 0:
        return std::uint64_t{row.motion.pose};
    case 1:
        return io::PathName{about.meshes[row.mesh], fileNameOf(about.meshes[row.mesh])};
    case 2:
        return io::PathName{about.volumes[row.volume], fileNameOf(about.volumes[row.volume])};
    case 3:
        return verdictOf(row.motion);
    case 4:
        return row.motion.freeUntil;
    default:
        return row.motion.touch ? touchCell(about, *row.motion.touch, column) : io::Cell();
    }
}

} // namespace

io::Table MotionTable::table() const {
    io::Table out;
    out.columns = {kColumns.begin(), kColumns.end()};
    if (labels && !labelNames.empty()) {
        out.columns.emplace_back("label_name");
    }
    if (isResampled != nullptr) {
        out.columns.emplace_back(kResampledColumn);
    }
    out.rows = rows.size();
    out.cell = [this, columns = out.columns.size()](std::size_t row, std::size_t column) {
        return isResampled != nullptr && column + 1 == columns ? resampledCell((*isResampled)[rows[row].volume] != 0)
                                                               : cellOf(*this, rows[row], column);
    };
    out.facts = facts;
    return out;
}

} // namespace voxtact::app
