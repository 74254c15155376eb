// SPDX-License-Identifier: MIT
#pragma once

#include "core/transfer/opaque_numbers.h"
#include "host/count/brick_sums.h"
#include "host/touch/cells/certified_bricks.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// One volume under one transfer function, threshold and resolution, for the projection `certified`: bricks bound the
/// real interpolant, not the samples of the exact arithmetic.
class CertifiedOccupancy {
  public:
    CertifiedOccupancy(const VolumeImpl& volume, const TransferFunctionImpl& function, double threshold,
                       double resolution);
    CertifiedOccupancy(const CertifiedOccupancy&) = delete;
    CertifiedOccupancy& operator=(const CertifiedOccupancy&) = delete;
    ~CertifiedOccupancy() = default;

    [[nodiscard]] const shader::CertifiedItem& item() const noexcept { return item_; }
    /// Valid while this object lives.
    [[nodiscard]] const shader::OpaqueValues& opaque() const noexcept { return opaque_; }
    /// Bricks along each axis.
    [[nodiscard]] const std::array<std::int32_t, 3>& bricks() const noexcept { return count_; }
    [[nodiscard]] std::size_t brickNumber(const std::array<std::int32_t, 3>& brick) const noexcept {
        return (static_cast<std::size_t>(brick[2]) * static_cast<std::size_t>(count_[1]) +
                static_cast<std::size_t>(brick[1])) *
                   static_cast<std::size_t>(count_[0]) +
               static_cast<std::size_t>(brick[0]);
    }
    /// Returns true if a brick may have an opaque point.
    [[nodiscard]] bool mayBeOpaque(std::size_t number) const noexcept { return mixed_[number] != 0; }
    /// Returns true if some brick of a box may have an opaque point.
    [[nodiscard]] bool mayBeOpaque(const BrickBox& box) const noexcept { return sums_.within(box) != 0; }
    /// Returns true if some cell of a box may have an opaque point; tests a few bricks only. `volume` is that of the
    /// constructor.
    [[nodiscard]] bool mayBeOpaque(const VolumeImpl& volume, const CellBox& cells) const;
    [[nodiscard]] bool nothingOpaque() const noexcept { return sums_.all() == 0; }
    /// The cells of a brick that may have an opaque point. `volume` is the one of the constructor.
    [[nodiscard]] const BrickCells& cells(const VolumeImpl& volume, const std::array<std::int32_t, 3>& brick) const {
        return bricks_.at(volume, item_, opaque_, brickNumber(brick), brick);
    }

    /// Returns the cells that are entirely opaque.
    [[nodiscard]] const CellBits& allOpaque(const VolumeImpl& volume, const std::array<std::int32_t, 3>& brick) const {
        return bricks_.allOpaqueAt(volume, item_, opaque_, brickNumber(brick), brick);
    }

  private:
    /// Like mayBeOpaque(volume, cells), for cells in one brick.
    [[nodiscard]] bool mayBeOpaque(const VolumeImpl& volume, const std::array<std::int32_t, 3>& brick,
                                   const CellBox& cells) const;

    OpaqueNumbers numbers_;
    shader::OpaqueValues opaque_; ///< opaque values of the item
    shader::CertifiedItem item_;
    std::array<std::int32_t, 3> count_;
    std::vector<std::uint8_t> mixed_;
    CertifiedBricks bricks_;
    BrickSums<std::uint32_t> sums_; ///< of mixed_
};

} // namespace voxtact::cpu
