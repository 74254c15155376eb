// SPDX-License-Identifier: MIT
#include "lab/engines/principal_axes.h"

#include <cmath>

namespace voxtact {

namespace {

using Matrix3 = std::array<Vec3, 3>;

double areaOf(const MeshView& mesh, std::uint32_t triangle) {
    const Vec3 a = vertexOf(mesh, triangle, 0);
    const Vec3 b = vertexOf(mesh, triangle, 1);
    const Vec3 c = vertexOf(mesh, triangle, 2);
    const Vec3 u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const Vec3 v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const Vec3 doubled{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    // No float is so large or small that its fourth power is not a double.
    return std::sqrt(doubled[0] * doubled[0] + doubled[1] * doubled[1] + doubled[2] * doubled[2]) / 2;
}

/// Weights of triangles that sum up to 1.
class Weights {
  public:
    Weights(const MeshView& mesh, std::span<const std::uint32_t> triangles) : mesh_(mesh) {
        for (const std::uint32_t triangle : triangles) {
            total_ += areaOf(mesh, triangle);
        }
        alike_ = 1 / static_cast<double>(triangles.size());
    }
    [[nodiscard]] double of(std::uint32_t triangle) const {
        return total_ > 0 ? areaOf(mesh_, triangle) / total_ : alike_;
    }

  private:
    const MeshView& mesh_;
    double total_ = 0;
    double alike_ = 0;
};

Vec3 meanOf(const MeshView& mesh, std::span<const std::uint32_t> triangles, const Weights& weights) {
    Vec3 mean{};
    for (const std::uint32_t triangle : triangles) {
        const double weight = weights.of(triangle) / 3;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec3 vertex = vertexOf(mesh, triangle, corner);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                mean[axis] += weight * vertex[axis];
            }
        }
    }
    return mean;
}

void addOuter(Matrix3& matrix, const Vec3& vector, double weight) {
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            matrix[row][column] += weight * vector[row] * vector[column];
        }
    }
}

Matrix3 covarianceOf(const MeshView& mesh, std::span<const std::uint32_t> triangles) {
    const Weights weights(mesh, triangles);
    const Vec3 mean = meanOf(mesh, triangles, weights);
    Matrix3 covariance{};
    for (const std::uint32_t triangle : triangles) {
        const double weight = weights.of(triangle) / 12;
        Vec3 sum{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec3 vertex = vertexOf(mesh, triangle, corner);
            const Vec3 from{vertex[0] - mean[0], vertex[1] - mean[1], vertex[2] - mean[2]};
            sum = {sum[0] + from[0], sum[1] + from[1], sum[2] + from[2]};
            addOuter(covariance, from, weight);
        }
        // The integral over a triangle with the corners p, q, r and the centroid m is
        // area / 12 * (9 m m' + p p' + q q' + r r').
        addOuter(covariance, sum, weight);
    }
    return covariance;
}

/// Turns the plane of axes p and q so that the matrix has a zero at (p, q) (Golub, Van Loan, "Matrix Computations",
/// section 8.5). The columns of `turned` follow.
void rotate(Matrix3& matrix, Matrix3& turned, std::size_t p, std::size_t q) {
    const double ratio = (matrix[q][q] - matrix[p][p]) / (2 * matrix[p][q]);
    const double tangent = std::copysign(1 / (std::abs(ratio) + std::hypot(ratio, 1.0)), ratio);
    const double cosine = 1 / std::hypot(tangent, 1.0);
    const double sine = tangent * cosine;
    const auto turn = [&](double& a, double& b) {
        const double old = a;
        a = cosine * a - sine * b;
        b = sine * old + cosine * b;
    };
    for (std::size_t i = 0; i < 3; ++i) {
        turn(matrix[i][p], matrix[i][q]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        turn(matrix[p][i], matrix[q][i]);
        turn(turned[i][p], turned[i][q]);
    }
}

/// Columns: the eigenvectors of a symmetric matrix, by Jacobi's method. It converges quadratically: a few sweeps do,
/// and whatever is left when it stops makes a box larger, not wrong.
Matrix3 eigenvectors(Matrix3 matrix) {
    constexpr int kSweeps = 12;
    constexpr double kNothing = 0x1p-50;
    Matrix3 turned{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (const auto& [p, q] : {std::pair{0U, 1U}, std::pair{0U, 2U}, std::pair{1U, 2U}}) {
            const double size = std::abs(matrix[p][p]) + std::abs(matrix[q][q]);
            if (std::abs(matrix[p][q]) > kNothing * size) {
                rotate(matrix, turned, p, q);
            }
        }
    }
    return turned;
}

} // namespace

std::array<Vec3, 3> principalAxes(const MeshView& mesh, std::span<const std::uint32_t> triangles) noexcept {
    const Matrix3 columns = eigenvectors(covarianceOf(mesh, triangles));
    std::array<Vec3, 3> axes{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        axes[axis] = {columns[0][axis], columns[1][axis], columns[2][axis]};
    }
    return axes;
}

} // namespace voxtact
