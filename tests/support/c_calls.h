// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/results.h"
#include "voxtact/voxtact.h"

#include <gtest/gtest.h>

#include <array>
#include <concepts>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

/// The C interface as tests want it: handles that end themselves, and the C++ interface's data in C's structs.
namespace voxtact::test {

/// A handle, ended by its own function.
template <class Handle> using Owned = std::unique_ptr<Handle, void (*)(Handle*)>;

/// Fails the test unless the call succeeds.
inline void need(vxt_result result) {
    if (result != VXT_OK) {
        throw std::runtime_error(std::string("unexpected error: ") + vxt_last_error(nullptr));
    }
}

/// A struct that is all defaults.
template <class T> [[nodiscard]] T sized() {
    T out{};
    out.struct_size = sizeof out;
    return out;
}

/// Address of an argument, during the call.
template <class T> const T* at(const T& argument) {
    return &argument;
}

/// The object that `make(arguments..., &handle)` makes.
template <class Handle, class Make, class... Arguments>
Owned<Handle> made(void (*destroy)(Handle*), const Make& make, Arguments... arguments) {
    Handle* handle = nullptr;
    need(make(arguments..., &handle));
    EXPECT_NE(handle, nullptr);
    return {handle, destroy};
}

/// Returns the view of read or built data, which must exist.
[[nodiscard]] inline vxt_volume_view dataView(const Owned<vxt_volume_data>& data) {
    vxt_volume_view view = sized<vxt_volume_view>();
    need(vxt_volume_data_view(data.get(), &view));
    return view;
}
[[nodiscard]] inline vxt_mesh_view dataView(const Owned<vxt_mesh_data>& data) {
    vxt_mesh_view view = sized<vxt_mesh_view>();
    need(vxt_mesh_data_view(data.get(), &view));
    return view;
}

[[nodiscard]] vxt_grid cGrid(const Grid& grid);
[[nodiscard]] vxt_volume_view cVolume(const VolumeData& volume);
[[nodiscard]] vxt_mesh_view cMesh(const MeshData& mesh);
[[nodiscard]] vxt_view cView(const View& view);
[[nodiscard]] std::vector<vxt_control_point> cPoints(const std::vector<ControlPoint>& points);
/// References `points`.
[[nodiscard]] vxt_transfer_function_desc cFunction(const std::vector<vxt_control_point>& points,
                                                   const ValueRange& domain, std::uint32_t tableSize);
[[nodiscard]] std::uint32_t cOutputs(const Outputs& outputs);
[[nodiscard]] Owned<vxt_answer> newAnswer();

/// A column that must be there.
[[nodiscard]] inline vxt_column findColumn(const vxt_answer& answer, const char* table, const char* name) {
    vxt_column found = sized<vxt_column>();
    need(vxt_answer_find(&answer, table, name, &found));
    return found;
}

template <class T> struct CElement {
    using Type = T;
    static constexpr std::uint32_t kCount = 1;
};
template <class T, std::size_t size> struct CElement<std::array<T, size>> {
    using Type = T;
    static constexpr std::uint32_t kCount = size;
};

/// A column whose elements are `T`, a number or an array of numbers.
template <class T>
[[nodiscard]] std::vector<T> readColumn(const vxt_answer& answer, const char* table, const char* name) {
    using Element = typename CElement<T>::Type;
    constexpr vxt_type kType = std::same_as<Element, double>          ? VXT_TYPE_DOUBLE
                               : std::same_as<Element, std::uint64_t> ? VXT_TYPE_UINT64
                               : std::same_as<Element, std::int32_t>  ? VXT_TYPE_INT32
                                                                      : VXT_TYPE_UINT32;
    static_assert(kType != VXT_TYPE_UINT32 || std::same_as<Element, std::uint32_t>);
    const vxt_column found = findColumn(answer, table, name);
    if (found.type != kType || found.elements != CElement<T>::kCount || found.stride < sizeof(T) ||
        (found.data == nullptr) != (found.rows == 0)) {
        throw std::runtime_error(std::string("another kind of column: ") + table + " " + name);
    }
    std::vector<T> out(found.rows);
    for (std::size_t row = 0; row < out.size(); ++row) {
        std::memcpy(&out[row], static_cast<const std::byte*>(found.data) + row * found.stride, sizeof(T));
    }
    return out;
}

/// Converts an answer about fragments to C++.
[[nodiscard]] BatchAnswer answerOf(const vxt_answer& answer);
/// Like differenceOf() of contact_scenes.h, including every member of the pairs.
[[nodiscard]] std::string wholeDifferenceOf(const BatchAnswer& a, const BatchAnswer& b);

} // namespace voxtact::test
