// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

namespace voxtact {

/// labelAt() for many points: prepares the map once. The map must outlive it.
class LabelLookup {
  public:
    /// Expects what makeLabels() returns.
    explicit LabelLookup(const LabelData& labels);

    /// Number of the label of a world point in LabelData::values.
    [[nodiscard]] std::uint32_t at(const Vec3& world) const noexcept;

  private:
    const LabelData& labels_;
    Mat4 texture_from_world_;
    std::uint32_t none_; ///< the number of the label 0
};

} // namespace voxtact
