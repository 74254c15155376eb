// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace voxtact {

/// Some poses of one item, in a part of a batch.
struct Piece {
    std::uint32_t item = 0;
    std::uint32_t firstPose = 0;
};

/// Cuts a batch (of the device's items or of the host's) into parts.
template <class Item> class BatchCutter {
  public:
    explicit BatchCutter(std::span<const Item> items) : items_(items) {}

    /// Takes the items of the next `pairs`, and their origin; returns false after the last.
    bool next(std::uint32_t pairs, std::vector<Item>& part, std::vector<Piece>& pieces) {
        part.clear();
        pieces.clear();
        std::size_t left = pairs;
        while (left > 0 && item_ < items_.size()) {
            const std::span<const Mat4> poses = items_[item_].world_from_object.subspan(pose_);
            const std::size_t taken = std::min(left, poses.size());
            if (taken > 0) {
                part.push_back(items_[item_]);
                part.back().world_from_object = poses.first(taken);
                pieces.push_back({static_cast<std::uint32_t>(item_), static_cast<std::uint32_t>(pose_)});
            }
            left -= taken;
            pose_ += taken;
            if (pose_ == items_[item_].world_from_object.size()) {
                ++item_;
                pose_ = 0;
            }
        }
        return !part.empty();
    }

  private:
    std::span<const Item> items_;
    std::size_t item_ = 0;
    std::size_t pose_ = 0;
};

} // namespace voxtact
