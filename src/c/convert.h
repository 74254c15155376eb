// SPDX-License-Identifier: MIT
#pragma once

#include "c/structs.h"
#include "voxtact/results.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

/// Converts data between the C and the C++ interface. Arrays are used in place, never copied, except control points.
namespace voxtact::c {

/// A number of an enumeration; the C++ interface refuses those that are none.
template <class To, class From> To number(From from) noexcept {
    return static_cast<To>(static_cast<std::uint32_t>(from));
}

[[nodiscard]] Grid toGrid(const vxt_grid& grid);
/// Refuses what checkGrid() refuses, and null.
[[nodiscard]] Grid checkedGrid(const vxt_grid* grid);
[[nodiscard]] vxt_grid fromGrid(const Grid& grid) noexcept;
[[nodiscard]] VolumeView toVolumeView(const vxt_volume_view* view);
[[nodiscard]] vxt_volume_view fromVolumeView(const VolumeView& view) noexcept;
[[nodiscard]] MeshView toMeshView(const vxt_mesh_view* view);
[[nodiscard]] vxt_mesh_view fromMeshView(const MeshView& view) noexcept;
[[nodiscard]] vxt_mesh_facts fromFacts(const MeshFacts& facts) noexcept;
[[nodiscard]] Box toBox(const vxt_box& box) noexcept;
[[nodiscard]] vxt_box fromBox(const Box& box) noexcept;
[[nodiscard]] VoxelBox toVoxelBox(const vxt_voxel_box* box);
[[nodiscard]] Ball toBall(const double* centre, double radius);
[[nodiscard]] ValueRange toRange(const vxt_range& range) noexcept;
[[nodiscard]] vxt_range fromRange(const ValueRange& range) noexcept;
[[nodiscard]] Vec3 toVec3(const double* vector, const char* what);
[[nodiscard]] Mat4 toMat4(const double* matrix, const char* what);
[[nodiscard]] Colour toColour(const double (&colour)[3]) noexcept;
/// Refuses a view without a pixel.
void checkPixels(std::uint32_t width, std::uint32_t height);
void writeMat4(double* out, const Mat4& matrix, const char* what);
void writeVec3(double* out, const Vec3& vector, const char* what);
/// A view that no projection with a camera accepts where there is none.
[[nodiscard]] View toView(const vxt_view* view) noexcept;
/// 0, as in a struct that is all zero, stands for the default, and -0 for 0.
[[nodiscard]] inline double numberOr(double given, double standard) noexcept {
    const double zero = std::signbit(given) ? 0 : standard;
    return given == 0 ? zero : given;
}
[[nodiscard]] inline double thresholdOf(double given) noexcept {
    return numberOr(given, kDefaultThreshold);
}
/// Numbers that are all 0 stand for the default; one -0 makes them zeros.
template <std::size_t N>
[[nodiscard]] std::array<double, N> numbersOr(const double (&given)[N],
                                              const std::array<double, N>& standard) noexcept {
    const auto isUnset = [](double number) { return number == 0 && !std::signbit(number); };
    std::array<double, N> out = standard;
    if (!std::ranges::all_of(given, isUnset)) {
        std::ranges::transform(given, out.begin(), [](double number) { return numberOr(number, 0); });
    }
    return out;
}
/// Inverts numberOr().
[[nodiscard]] inline double explicitNumber(double number) noexcept {
    return number == 0 ? -0.0 : number;
}
[[nodiscard]] Outputs toOutputs(std::uint32_t outputs, double maxDepth);
/// Returns the matrices in place; 16 doubles per pose.
[[nodiscard]] std::span<const Mat4> toPoses(const double* poses, std::size_t count, const char* what);
[[nodiscard]] std::span<const std::byte> toBytes(const void* bytes, std::size_t count, const char* what);

/// A TransferFunctionDesc with the points that it references.
class TransferFunctionOf {
  public:
    explicit TransferFunctionOf(const vxt_transfer_function_desc* given);
    [[nodiscard]] TransferFunctionDesc desc() const noexcept;

  private:
    std::vector<ControlPoint> points_;
    vxt_transfer_function_desc given_;
};

/// Number of elements: `count` times `each`. Refuses an array whose size in bytes overflows.
std::size_t times(std::size_t count, std::size_t each, const char* what);

/// An array of the caller's. Refuses one that no memory holds.
template <class T> std::span<const T> toSpan(const T* first, std::size_t count, const char* what) {
    if (count > std::numeric_limits<std::ptrdiff_t>::max() / sizeof(T)) {
        refuse(ErrorCode::InvalidArgument, std::string(what) + ": " + std::to_string(count) + " are too many");
    }
    return count == 0 ? std::span<const T>() : std::span<const T>(&need(first, what), count);
}

/// Hands out an array of an object's, which may be null; `count` may be null too.
template <class T> const T* handOut(std::span<const T> array, std::size_t* count) noexcept {
    if (count != nullptr) {
        *count = array.size();
    }
    return array.data();
}

} // namespace voxtact::c
