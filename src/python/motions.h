// SPDX-License-Identifier: MIT
#pragma once

#include "request.h"
#include "voxtact/motion.h"

#include <array>
#include <memory>
#include <vector>

namespace voxtact::python {

/// How motions are checked.
struct Way {
    Interpolation interpolation = Interpolation::Screw;
    double resolution = 0;
    std::uint64_t mostSteps = 0;

    [[nodiscard]] auto key() const noexcept { return std::tuple(interpolation, inKey(resolution), mostSteps); }
    using Key = std::tuple<Interpolation, std::uint64_t, std::uint64_t>;
};

/// A row of Motions::touches, a touch or the lack of one.
struct TouchRow {
    double at;             ///< NaN: there is none, and so is what follows but for the numbers
    std::int64_t triangle; ///< -1: there is none
    std::array<double, 3> position;
    std::int32_t label;
    std::int32_t between = 0;                               ///< so that equal rows are equal as bytes
    std::array<std::array<double, 4>, 4> world_from_object; ///< row by row
};

/// The ways of a request, a row for each.
struct Motions {
    std::shared_ptr<const Request> request;
    std::vector<std::uint8_t> hit;
    std::vector<std::uint8_t> possible;
    std::vector<double> freeUntil;
    std::vector<std::uint8_t> end; ///< MotionEnd
    std::vector<TouchRow> touches;
    double milliseconds = 0;

    /// `labels` may be null.
    void add(const MotionAnswer& piece, const LabelData* labels);
};

/// By its name on the command line.
[[nodiscard]] Interpolation interpolationOf(const std::string& name);
/// Refuses an item of fewer than two poses, and two poses that no rigid motion joins. All are looked at before any
/// work, which counts from the first pose of each piece.
void checkWays(const Request& request, Interpolation interpolation);

void defineMotions(py::module_& module);

} // namespace voxtact::python
