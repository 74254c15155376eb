// SPDX-License-Identifier: MIT
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/geometry/glm_bridge.h"

#include <glm/matrix.hpp>

#include <cmath>

namespace voxtact {

namespace {

/// The last row is exactly 0 0 0 1.
bool isAffine(const Mat4& matrix) {
    return matrix[3] == 0 && matrix[7] == 0 && matrix[11] == 0 && matrix[15] == 1;
}

} // namespace

Mat4 identity() noexcept {
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
}

Mat4 translation(const Vec3& offset) noexcept {
    Mat4 out = identity();
    out[12] = offset[0];
    out[13] = offset[1];
    out[14] = offset[2];
    return out;
}

Mat4 multiply(const Mat4& c_from_b, const Mat4& b_from_a) noexcept {
    return fromGlm(toGlm(c_from_b) * toGlm(b_from_a));
}

Result<Mat4> inverse(const Mat4& b_from_a) {
    double largest = 0;
    for (const double element : b_from_a) {
        if (!std::isfinite(element)) {
            return refuse("the matrix has an element that is not finite");
        }
        largest = std::max(largest, std::abs(element));
    }
    const glm::dmat4 a_from_b = glm::inverse(toGlm(b_from_a));
    Mat4 out = fromGlm(a_from_b);
    // A residual and not the determinant: the determinant's size depends on the units of the columns.
    const glm::dmat4 product = toGlm(b_from_a) * a_from_b;
    double residual = 0;
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) {
            const double off = product[c][r] - (c == r ? 1.0 : 0.0);
            residual = std::isfinite(off) ? std::max(residual, std::abs(off)) : 1.0;
        }
    }
    if (largest == 0 || residual > 1e-6) {
        return refuse("the matrix is singular, as far as doubles can tell");
    }
    if (isAffine(b_from_a)) { // of a pose it is a pose: rounding must not get into the last row
        out[3] = out[7] = out[11] = 0;
        out[15] = 1;
    }
    return out;
}

Vec3 transformPoint(const Mat4& b_from_a, const Vec3& point) noexcept {
    const glm::dvec4 out = toGlm(b_from_a) * glm::dvec4(point[0], point[1], point[2], 1.0);
    return {out.x / out.w, out.y / out.w, out.z / out.w};
}

Mat4 fromFloats(const float (&columnMajor)[16]) noexcept {
    Mat4 out{};
    for (std::size_t i = 0; i < 16; ++i) {
        out[i] = static_cast<double>(columnMajor[i]);
    }
    return out;
}

Result<void> checkAffine(const Mat4& matrix, const std::string& what) {
    for (std::size_t i = 0; i < 16; ++i) {
        if (!std::isfinite(matrix[i])) {
            return refuse(what + ": row " + std::to_string(i % 4 + 1) + ", column " + std::to_string(i / 4 + 1) +
                          " of the matrix is not finite");
        }
    }
    if (!isAffine(matrix)) {
        return refuse(what + ": the last row of the matrix is " + number(matrix[3]) + " " + number(matrix[7]) + " " +
                      number(matrix[11]) + " " + number(matrix[15]) + ", it must be 0 0 0 1");
    }
    return {};
}

} // namespace voxtact
