// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/results.h"
#include "voxtact/voxtact.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

/// The C interface as tests want it: handles that end themselves, and the C++ interface's data in C's structs.
namespace voxtact::test {

/// A handle, ended by its own function.
template <class Handle> using Owned = std::unique_ptr<Handle, void (*)(Handle*)>;

/// What must succeed.
inline void need(vxt_result result) {
    if (result != VXT_OK) {
        throw std::runtime_error(std::string("unexpected error: ") + vxt_last_error(nullptr));
    }
}

/// The object that `make(&handle)` makes.
template <class Handle, class Make> Owned<Handle> made(void (*destroy)(Handle*), Make&& make) {
    Handle* handle = nullptr;
    need(make(&handle));
    EXPECT_NE(handle, nullptr);
    return {handle, destroy};
}

/// What the views of read or built data are, which must be there.
[[nodiscard]] inline vxt_volume_view dataView(const Owned<vxt_volume_data>& data) {
    vxt_volume_view view = vxt_volume_view_init();
    need(vxt_volume_data_view(data.get(), &view));
    return view;
}
[[nodiscard]] inline vxt_mesh_view dataView(const Owned<vxt_mesh_data>& data) {
    vxt_mesh_view view = vxt_mesh_view_init();
    need(vxt_mesh_data_view(data.get(), &view));
    return view;
}

[[nodiscard]] vxt_grid cGrid(const Grid& grid);
[[nodiscard]] vxt_volume_view cVolume(const VolumeData& volume);
[[nodiscard]] vxt_mesh_view cMesh(const MeshData& mesh);
[[nodiscard]] vxt_view cView(const View& view);
[[nodiscard]] std::vector<vxt_control_point> cPoints(const std::vector<ControlPoint>& points);
/// Looks at `points`.
[[nodiscard]] vxt_transfer_function_desc cFunction(const std::vector<vxt_control_point>& points,
                                                   const ValueRange& domain, std::uint32_t tableSize);
[[nodiscard]] std::uint32_t cOutputs(const Outputs& outputs);
[[nodiscard]] Owned<vxt_answer> newAnswer();
/// An answer as C++ has it.
[[nodiscard]] BatchAnswer answerOf(const vxt_answer& answer);
/// As differenceOf() of contact_scenes.h, and every member of the pairs too.
[[nodiscard]] std::string wholeDifferenceOf(const BatchAnswer& a, const BatchAnswer& b);

} // namespace voxtact::test
