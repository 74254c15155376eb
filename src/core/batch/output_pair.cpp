// SPDX-License-Identifier: MIT
#include "core/batch/output_pair.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace voxtact {

namespace {

/// A label's number has 16 bits.
constexpr std::size_t kMostLabels = 65536;

void setRows(shader::vec4 (&rows)[3], const Mat4& matrix) {
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 4; ++column) {
            rows[row][column] = static_cast<float>(matrix[4 * column + row]);
        }
    }
}

/// The steps of the gradient: from one voxel, doubled until they are maxDepth long, or as long as the image.
void setGradientSteps(shader::OutputPair& pair, const Grid& grid, double maxDepth) {
    double most = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double side = grid.size[axis];
        const double voxels = std::clamp(maxDepth / grid.spacing[axis], 1.0, std::max(side, 1.0));
        pair.voxel[axis] = static_cast<float>(1 / side);
        pair.farthest[axis] = static_cast<float>(voxels / side);
        most = std::max(most, voxels);
    }
    pair.doublings = static_cast<std::uint32_t>(std::ceil(std::log2(most)));
}

/// Upper bound of distances in the image, mm.
double acrossImage(const Grid& grid) {
    constexpr double kBeyond = 1.001; // more than rounding
    double sides = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        sides += grid.size[axis] * grid.spacing[axis];
    }
    return kBeyond * sides;
}

void setDepthSteps(shader::OutputPair& pair, const Grid& grid, double maxDepth) {
    const double half = 0.5 * *std::min_element(grid.spacing.begin(), grid.spacing.end());
    const double way = std::min(maxDepth, acrossImage(grid));
    const double step = std::max(half, way / CONTACT_MOST_STEPS);
    pair.maxDepth = static_cast<float>(maxDepth);
    pair.depthWay = static_cast<float>(way);
    pair.depthStep = static_cast<float>(step);
    pair.depthSteps = static_cast<std::uint32_t>(std::clamp(std::ceil(way / step), 1.0, double{CONTACT_MOST_STEPS}));
}

} // namespace

shader::OutputPair outputPair(const Grid& grid, const Mat4& texture_from_world, const shader::ItemConstants& item,
                              double valueScale, double valueBias, const Outputs& outputs) {
    const double maxDepth = outputs.contacts ? outputs.maxDepth : kDefaultMaxDepth;
    shader::OutputPair pair{};
    setRows(pair.world_from_texture, worldFromTexture(grid));
    setRows(pair.texture_from_world, texture_from_world);
    setGradientSteps(pair, grid, maxDepth);
    setDepthSteps(pair, grid, maxDepth);
    pair.item = item;
    pair.valueScale = static_cast<float>(valueScale);
    pair.valueBias = static_cast<float>(valueBias);
    return pair;
}

void addLabelMap(shader::OutputPair& pair, const Grid& grid, const Grid& labelGrid,
                 std::span<const std::int32_t> values) {
    setRows(pair.label_from_texture, multiply(textureFromWorld(labelGrid).value(), worldFromTexture(grid)));
    pair.labelCount = static_cast<std::uint32_t>(values.size());
    pair.outsideLabel = static_cast<std::uint32_t>(std::lower_bound(values.begin(), values.end(), 0) - values.begin());
    pair.labelSizeX = labelGrid.size[0];
    pair.labelSizeY = labelGrid.size[1];
    pair.labelSizeZ = labelGrid.size[2];
}

Result<void> checkOutputs(const Outputs& outputs, bool stopAtFirst) {
    if (outputs.any() && stopAtFirst) {
        return refuse("a yes or no ends at the first survivor, the outputs need all of them");
    }
    const auto depth = static_cast<float>(outputs.maxDepth);
    if (outputs.contacts && !(std::isnormal(depth) && depth > 0)) {
        return refuse("the largest depth of contacts is " + number(outputs.maxDepth) +
                      " mm, it must be positive and finite");
    }
    return {};
}

Result<void> checkLabelValues(const LabelData& labels) {
    if (Result<void> grid = checkGrid(labels.grid); !grid.ok()) {
        return refuse("the label map: " + grid.error().text);
    }
    if (labels.indices.size() != voxelCount(labels.grid)) {
        return refuse("the label map has " + std::to_string(labels.indices.size()) + " indices, its grid has " +
                      std::to_string(voxelCount(labels.grid)) + " voxels");
    }
    const std::vector<std::int32_t>& values = labels.values;
    if (std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) != values.end()) {
        return refuse("the label map's values are not ascending");
    }
    if (!std::binary_search(values.begin(), values.end(), 0)) {
        return refuse("the label map's values do not hold 0");
    }
    if (values.size() > kMostLabels) {
        return refuse("the label map has " + std::to_string(values.size()) + " labels, at most " +
                      std::to_string(kMostLabels) + " can be numbered");
    }
    return {};
}

Result<void> checkLabels(const LabelData& labels) {
    VOXTACT_TRY(checkLabelValues(labels));
    const auto largest = std::max_element(labels.indices.begin(), labels.indices.end());
    if (*largest >= labels.values.size()) {
        return refuse("the label map's voxel " + std::to_string(largest - labels.indices.begin()) + " has the index " +
                      std::to_string(*largest) + ", there are " + std::to_string(labels.values.size()) + " values");
    }
    return {};
}

} // namespace voxtact
