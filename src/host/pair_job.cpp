// SPDX-License-Identifier: MIT
#include "host/pair_job.h"
#include "exact/exact.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

/// Covers the rounding of seven operations in float, and of an interpolation between corners, many times over.
constexpr float kFormMargin = 0x1p-18F;
constexpr float kLargestForm = 1e30F;

/// The largest absolute values of its floats along each axis.
std::array<float, 3> reachOf(const MeshImpl& mesh) {
    std::array<float, 3> reach{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double offset = mesh.origin.offset[axis];
        const double most =
            std::max(std::abs(mesh.facts.bounds.lo[axis] - offset), std::abs(mesh.facts.bounds.hi[axis] - offset));
        reach[axis] = static_cast<float>(most);
    }
    return reach;
}

Form formOf(const shader::vec4& row, const std::array<float, 3>& reach) {
    const float most =
        std::abs(row[0]) * reach[0] + std::abs(row[1]) * reach[1] + std::abs(row[2]) * reach[2] + std::abs(row[3]);
    return {row[0], row[1], row[2], row[3], most * kFormMargin};
}

/// a + sign * b
Form combined(const Form& a, const Form& b, float sign) {
    return {a.x + sign * b.x, a.y + sign * b.y, a.z + sign * b.z, a.constant + sign * b.constant, a.margin + b.margin};
}

constexpr int kHalfPixel = EXACT_SUBPIXEL / 2;

} // namespace

ViewFacts::ViewFacts(const View& view, bool withRangeTest)
    : width(static_cast<int>(view.width)), height(static_cast<int>(view.height)),
      guardX(shader::exactGuard(view.width)), guardY(shader::exactGuard(view.height)),
      scaleX(static_cast<float>(width * kHalfPixel)), scaleY(static_cast<float>(height * kHalfPixel)),
      rangeTest(withRangeTest) {}

CullForms::CullForms(const MeshImpl& mesh, const shader::PairTransform& transform) {
    const std::array<float, 3> reach = reachOf(mesh);
    const Form x = formOf(transform.clip_from_object[0], reach);
    const Form y = formOf(transform.clip_from_object[1], reach);
    const Form z = formOf(transform.clip_from_object[2], reach);
    w = formOf(transform.clip_from_object[3], reach);
    outside[0] = z;
    outside[1] = combined(w, z, -1);
    outside[2] = combined(w, x, 1);
    outside[3] = combined(w, x, -1);
    outside[4] = combined(w, y, 1);
    outside[5] = combined(w, y, -1);
    usable = true;
    for (const Form* form : {&x, &y, &z, static_cast<const Form*>(&w)}) {
        usable = usable && form->margin < kLargestForm * kFormMargin;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        texture[axis] = formOf(transform.texture_from_object[axis], reach);
        usable = usable && texture[axis].margin < kLargestForm * kFormMargin;
    }
}

bool isOrthographic(const shader::PairTransform& transform) noexcept {
    return transform.clip_from_object[3] == shader::vec4{0, 0, 0, 1};
}

} // namespace voxtact::cpu
