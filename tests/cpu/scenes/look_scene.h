// SPDX-License-Identifier: MIT
#pragma once

#include "core/transfer/opaque_numbers.h"
#include "exact/certified.h"

#include <array>
#include <cstdint>
#include <random>
#include <vector>

namespace voxtact::test {

/// A transfer function, drawn, for cells of 40 voxels along each side whose values are drawn around it.
class LookScene {
  public:
    static constexpr int kSide = 40;

    explicit LookScene(std::mt19937_64& random);

    [[nodiscard]] const shader::CertifiedItem& item() const { return item_; }
    [[nodiscard]] shader::OpaqueValues opaque() const { return numbers_.values(); }
    [[nodiscard]] shader::CertifiedCorners corners(std::mt19937_64& random) const;
    /// What certifiedSettle() finds of a triangle in a cell; none where no point of the cell may be opaque.
    [[nodiscard]] int verdict(const shader::CertifiedCorners& corners,
                              const std::array<shader::CertifiedVertex, 3>& vertices,
                              const std::array<std::int32_t, 3>& place) const;

  private:
    OpaqueNumbers numbers_;
    shader::CertifiedItem item_;
};

} // namespace voxtact::test
