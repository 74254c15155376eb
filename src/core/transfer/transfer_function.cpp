// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/geometry/domain.h"
#include "voxtact/data.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

Result<void> checkPoints(std::span<const ControlPoint> points) {
    if (points.empty()) {
        return refuse("the transfer function has no control points");
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::string which = "control point " + std::to_string(i + 1) + " of the transfer function: ";
        if (!std::isfinite(points[i].value)) {
            return refuse(which + "the value is not finite");
        }
        if (!(points[i].opacity >= 0 && points[i].opacity <= 1)) {
            return refuse(which + "the opacity " + number(points[i].opacity) + " is outside [0, 1]");
        }
        if (i > 0 && points[i].value < points[i - 1].value) {
            return refuse(which + "the value " + number(points[i].value) + " comes after " +
                          number(points[i - 1].value) + ", values must ascend");
        }
        if (i > 0 && !std::isfinite(points[i].value - points[i - 1].value)) {
            return refuse(which + "the value " + number(points[i].value) + " is too far from " +
                          number(points[i - 1].value) + ", their difference overflows");
        }
    }
    return {};
}

double opacityAt(std::span<const ControlPoint> points, double value) {
    const auto after = std::upper_bound(points.begin(), points.end(), value,
                                        [](double v, const ControlPoint& point) { return v < point.value; });
    if (after == points.begin()) {
        return points.front().opacity;
    }
    if (after == points.end()) {
        return points.back().opacity;
    }
    const ControlPoint& a = *(after - 1);
    const ControlPoint& b = *after;
    return a.opacity + (b.opacity - a.opacity) * ((value - a.value) / (b.value - a.value));
}

} // namespace

ValueRange tableDomain(const TransferFunctionDesc& desc) noexcept {
    if (desc.domain.lo != 0 || desc.domain.hi != 0 || desc.points.empty() || desc.tableSize < 2) {
        return desc.domain;
    }
    constexpr double kPart = 1.0 / 4096;
    const double lo = desc.points.front().value;
    const double hi = desc.points.back().value;
    const double beyond =
        lo < hi ? (hi - lo) / (desc.tableSize - 1) / 2 : (lo != 0 ? std::max(std::abs(lo), 1e-300) * kPart : kPart);
    return {lo - beyond, hi + beyond};
}

Result<std::vector<float>> sampleTable(const TransferFunctionDesc& desc) {
    return guard([&]() -> Result<std::vector<float>> {
        // The domain first: its ends become the default points.
        const bool isGiven = desc.domain.lo != 0 || desc.domain.hi != 0;
        VOXTACT_TRY(isGiven ? checkDomain(desc.domain, "the transfer function's domain") : Result<void>());
        VOXTACT_TRY(checkPoints(desc.points));
        if (desc.tableSize < 2) {
            return refuse("the transfer function's table has " + std::to_string(desc.tableSize) +
                          " entries, it needs at least 2");
        }
        if (desc.tableSize > kMaxTableSize) {
            return Error{ErrorCode::LimitExceeded, 0,
                         "the transfer function's table has " + std::to_string(desc.tableSize) +
                             " entries, the most is " + std::to_string(kMaxTableSize)};
        }
        const ValueRange domain = tableDomain(desc);
        VOXTACT_TRY(checkDomain(domain, "the range of the transfer function's points"));
        std::vector<float> table(desc.tableSize);
        for (std::uint32_t i = 0; i < desc.tableSize; ++i) {
            const double s = (i + 0.5) / desc.tableSize;
            table[i] = static_cast<float>(opacityAt(desc.points, domain.lo + s * (domain.hi - domain.lo)));
        }
        return table;
    });
}

} // namespace voxtact
