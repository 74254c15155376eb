// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/facts/facts.h"
#include "core/geometry/projection.h"
#include "core/method/method_table.h"

#include <array>
#include <limits>

/// Checks common to the batches of device and host.
namespace voxtact {

/// Width and height of a viewport; 64 bits, so that a request may exceed every limit.
using WideExtent = std::array<std::uint64_t, 2>;

/// Limits of one side, device or host.
template <class Side, class Item>
concept BatchSide = requires(const Side& side, const Item& item, const WideExtent& extent, const std::string& text) {
    /// Checks the size of a viewport. `text` begins the error and states the size.
    { side.checkExtent(extent, text) } -> std::same_as<Result<void>>;
    /// Checks that the parts of an item are not null. `text` names the item.
    { side.checkItem(item, text) } -> std::same_as<Result<void>>;
    /// True if areSingle() holds for the constants of a checked item.
    { side.holdsValues(item) } -> std::same_as<bool>;
};

namespace detail {

template <class View, class Side> Result<void> checkView(const View& view, const Side& side) {
    const std::string size = "the viewport is " + std::to_string(view.width) + "x" + std::to_string(view.height);
    if (view.width == 0 || view.height == 0) {
        return refuse(size + ", it needs at least one pixel");
    }
    VOXTACT_TRY(side.checkExtent({view.width, view.height}, size));
    if (const Result<Mat4> world_from_clip = inverse(view.clip_from_world); !world_from_clip.ok()) {
        return refuse("the camera's clip_from_world cannot be used: " + world_from_clip.error().text);
    }
    return {};
}

/// Number of an item's poses, in host memory or on the device.
template <class Item> std::size_t pairsOf(const Item& item) {
    if constexpr (requires { item.pairs(); }) {
        return item.pairs();
    } else {
        return item.world_from_object.size();
    }
}

template <class Item> Result<void> checkPoses(const Item& item, const std::string& which) {
    for (std::size_t pose = 0; pose < item.world_from_object.size(); ++pose) {
        // The text is made for a bad pose only: this is the hot loop of recording.
        if (const Result<void> checked = checkAffine(item.world_from_object[pose], {}); !checked.ok()) {
            return checkAffine(item.world_from_object[pose], which + ", pose " + std::to_string(pose));
        }
    }
    return {};
}

} // namespace detail

/// Checks one item of a batch, which errors call `which`.
template <class Item, class Side>
Result<void> checkBatchItem(const ProjectionRow& projection, std::uint32_t samplesPerVoxel, const Item& item,
                            const std::string& which, const Side& side) {
    if (item.mesh == nullptr || item.volume == nullptr || item.transferFunction == nullptr) {
        return refuse(which + ": mesh, volume or transferFunction is null");
    }
    VOXTACT_TRY(side.checkItem(item, which));
    VOXTACT_TRY(detail::checkPoses(item, which));
    if (!projection.certified && !side.holdsValues(item)) {
        return refuse(which + ": single precision cannot hold the volume's values in the transfer function's domain; "
                              "the projection certified says what can be said");
    }
    if (projection.voxelGrid) {
        const Grid& grid = item.volume->grid();
        const std::uint64_t length = dominantSide(grid, samplesPerVoxel);
        VOXTACT_TRY(side.checkExtent({length, length}, which + ": " + dominantNeeds(grid, samplesPerVoxel)));
    }
    return {};
}

/// Refuses null objects, poses and cameras that are not finite or not affine, a singular camera, a viewport of 0, a
/// threshold outside [0,1], more pairs than 32 bits can number, values that floats do not hold, and what the side
/// refuses. The camera counts only where the projection has one, the values only where it is not certified. Returns the
/// number of pairs.
template <class Batch, class Side>
Result<std::uint32_t> checkBatch(Projection projection, std::uint32_t samplesPerVoxel, const Batch& batch,
                                 const Side& side) {
    VOXTACT_TRY(checkFact(factOf("scene", "opacity_threshold"), batch.threshold));
    const ProjectionRow& row = rowOf(projection);
    if (row.camera) {
        VOXTACT_TRY(detail::checkView(batch.view, side));
    }
    std::uint64_t pairs = 0;
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        const auto& item = batch.items[i];
        static_assert(BatchSide<Side, std::remove_cvref_t<decltype(item)>>);
        VOXTACT_TRY(checkBatchItem(row, samplesPerVoxel, item, "batch item " + std::to_string(i), side));
        pairs += detail::pairsOf(item);
    }
    if (pairs > std::numeric_limits<std::uint32_t>::max()) {
        return refuse("the batch has " + std::to_string(pairs) + " pairs, more than 32 bits can number");
    }
    return static_cast<std::uint32_t>(pairs);
}

} // namespace voxtact
