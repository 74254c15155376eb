// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>
#include <vector>

/// The transfer function while it is edited: at least one point, values ascending, opacities 0..1.
namespace voxtact::view {

using Curve = std::vector<ControlPoint>;

/// Returns true if the points are equal.
[[nodiscard]] bool sameCurve(const Curve& a, const Curve& b) noexcept;
[[nodiscard]] bool sameColours(const std::vector<ColourPoint>& a, const std::vector<ColourPoint>& b) noexcept;

/// Returns the opacity of a value: linear between the points, constant outside; at a step, that of its right side.
[[nodiscard]] double opacityAt(const Curve& curve, double value) noexcept;

/// Inserts a point by value, and returns its number. Clamps the opacity to 0..1.
std::size_t addPoint(Curve& curve, const ControlPoint& point);

/// Moves a point, between its neighbours' values and within the domain, and keeps its number.
void movePoint(Curve& curve, std::size_t number, const ControlPoint& to, const ValueRange& domain) noexcept;

/// Removes a point; returns false for the last one, which stays.
bool removePoint(Curve& curve, std::size_t number);

/// Rounds to the precision of a pointer: thousandths of the domain and of the opacity, in decimal steps.
[[nodiscard]] ControlPoint rounded(const ControlPoint& point, const ValueRange& domain) noexcept;

/// Returns the ranges of the domain in which the curve reaches the threshold: ascending, disjoint.
[[nodiscard]] std::vector<ValueRange> opaqueRanges(const Curve& curve, double threshold, const ValueRange& domain);

} // namespace voxtact::view
