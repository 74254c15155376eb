// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace voxtact::io {

/// Cuts a polygon of n corners (3 or more, finite) into n-2 triangles of its corners, numbered from 0 and turning as it
/// does: a fan around its first corner where that stays inside, else ear by ear. A polygon that is not flat is cut like
/// its largest projection along an axis. Otherwise the reason is returned: it crosses itself, or has more than 4096
/// corners and is no fan.
[[nodiscard]] std::optional<std::string> cutPolygon(std::span<const Vec3> corners,
                                                    std::vector<std::array<std::uint32_t, 3>>& triangles);

} // namespace voxtact::io
