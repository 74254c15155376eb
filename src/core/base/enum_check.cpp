// SPDX-License-Identifier: MIT
#include "core/base/enum_check.h"
#include "core/base/refuse.h"

#include <algorithm>
#include <array>

namespace voxtact {

namespace {

constexpr std::array kFilters{Filter::Hardware, Filter::Exact};
constexpr std::array kBoundaries{Boundary::Auto, Boundary::Range, Boundary::Clamp};
constexpr std::array kInterpolations{Interpolation::Screw, Interpolation::Slerp};
constexpr std::array kTypes{ScalarType::UInt8, ScalarType::Int16, ScalarType::UInt16, ScalarType::Float32};

template <class Values, class Value> Result<void> checkOneOf(const Values& values, Value value, const char* what) {
    if (std::ranges::find(values, value) != values.end()) {
        return {};
    }
    return refuse(std::string("there is no ") + what + " number " + std::to_string(static_cast<std::uint32_t>(value)));
}

} // namespace

Result<void> checkProjection(Projection projection) {
    return checkOneOf(projections(), projection, "projection");
}

Result<void> checkFilter(Filter filter) {
    return checkOneOf(kFilters, filter, "filter");
}

Result<void> checkBoundary(Boundary boundary) {
    return checkOneOf(kBoundaries, boundary, "boundary");
}

Result<void> checkScalarType(ScalarType type) {
    return checkOneOf(kTypes, type, "scalar type");
}

Result<void> checkInterpolation(Interpolation interpolation) {
    return checkOneOf(kInterpolations, interpolation, "interpolation");
}

} // namespace voxtact
