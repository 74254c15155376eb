// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>
#include <variant>
#include <vector>

namespace voxtact::python {

/// A region gets one value.
struct SetEdit {
    VoxelRegion region;
    double value = 0;
};
/// A box gets voxels of the volume's type.
struct WriteEdit {
    VoxelBox box;
    std::vector<std::byte> voxels;
};
using Edit = std::variant<SetEdit, WriteEdit>;

/// What a scene is made of.
struct OpacityDesc {
    std::vector<ControlPoint> points;
    ValueRange domain;
    std::uint32_t tableSize = kDefaultTableSize;

    [[nodiscard]] TransferFunctionDesc desc() const noexcept { return {points, domain, tableSize}; }
};

} // namespace voxtact::python
