// SPDX-License-Identifier: MIT
#include "bench/distance_map.h"

#include <algorithm>
#include <cmath>
#include <itkImage.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>
#include <itkVersion.h>

namespace voxtact::bench {

namespace {

using Mask = itk::Image<unsigned char, 3>;
using Distances = itk::Image<float, 3>;

Mask::Pointer maskOf(const std::array<std::uint32_t, 3>& size, double side, const std::vector<bool>& opaque) {
    Mask::RegionType region;
    Mask::SpacingType spacing;
    for (unsigned axis = 0; axis < 3; ++axis) {
        region.SetSize(axis, size[axis]);
        spacing[axis] = side;
    }
    const Mask::Pointer mask = Mask::New();
    mask->SetRegions(region);
    mask->SetSpacing(spacing);
    mask->Allocate();
    std::transform(opaque.begin(), opaque.end(), mask->GetBufferPointer(),
                   [](bool is) { return static_cast<unsigned char>(is ? 1 : 0); });
    return mask;
}

} // namespace

DistanceMap::DistanceMap(const std::array<std::uint32_t, 3>& size, double side, const std::vector<bool>& opaque)
    : size_(size) {
    using Filter = itk::SignedMaurerDistanceMapImageFilter<Mask, Distances>;
    const Filter::Pointer filter = Filter::New();
    filter->SetInput(maskOf(size, side, opaque));
    filter->SetSquaredDistance(false);
    filter->SetUseImageSpacing(true);
    filter->SetInsideIsPositive(false);
    filter->SetNumberOfWorkUnits(1);
    filter->Update();
    const float* found = filter->GetOutput()->GetBufferPointer();
    distance_.assign(found, found + opaque.size());
}

double DistanceMap::at(const std::array<double, 3>& place) const {
    std::array<std::size_t, 3> first{};
    std::array<double, 3> part{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double centre = std::clamp(place[axis] - 0.5, 0.0, size_[axis] - 1.0);
        first[axis] = static_cast<std::size_t>(std::min(std::floor(centre), std::max(0.0, size_[axis] - 2.0)));
        part[axis] = centre - static_cast<double>(first[axis]);
    }
    double sum = 0;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        double weight = 1;
        std::array<std::size_t, 3> cell = first;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool far = (corner >> axis & 1U) != 0;
            weight *= far ? part[axis] : 1 - part[axis];
            cell[axis] += far && part[axis] > 0 ? 1U : 0U;
        }
        sum +=
            weight * static_cast<double>(distance_[cell[0] + size_[0] * (cell[1] + std::size_t{size_[1]} * cell[2])]);
    }
    return sum;
}

std::string DistanceMap::version() {
    return std::string("ITK ") + itk::Version::GetITKVersion();
}

} // namespace voxtact::bench
