// SPDX-License-Identifier: MIT
#pragma once

#include "core/geometry/glm_bridge.h"
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <vector>

/// Plans among boxes, whose distance from a line is known.
namespace voxtact::test {

using glm::dvec3;

struct AxisBox {
    dvec3 lo{};
    dvec3 hi{};

    [[nodiscard]] double distance(const dvec3& from) const {
        return glm::length(glm::max(glm::max(lo - from, from - hi), dvec3(0)));
    }
    /// From a line: it is a convex function along it.
    [[nodiscard]] double distance(const dvec3& from, const dvec3& to) const {
        double begin = 0;
        double end = 1;
        for (int i = 0; i < 200; ++i) {
            const double first = begin + (end - begin) / 3;
            const double second = end - (end - begin) / 3;
            (distance(glm::mix(from, to, first)) < distance(glm::mix(from, to, second)) ? end : begin) =
                distance(glm::mix(from, to, first)) < distance(glm::mix(from, to, second)) ? second : first;
        }
        return distance(glm::mix(from, to, 0.5 * (begin + end)));
    }
};

/// Boxes of labels 1, 2, ... in a grid of 1 x 1.5 x 2 mm, about the world's origin.
struct BoxScene {
    explicit BoxScene(std::mt19937_64& random, int boxCount) {
        Grid grid;
        grid.size = {48, 32, 24};
        grid.spacing = {1, 1.5, 2};
        grid.origin = {-23.5, -23.25, -23};
        std::vector<VoxelBox> voxels;
        for (int i = 0; i < boxCount || voxels.empty(); ++i) {
            VoxelBox box;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                box.size[axis] = 1 + static_cast<std::uint32_t>(uniform(random, 0, 0.3) * grid.size[axis]);
                box.first[axis] =
                    static_cast<std::uint32_t>(uniform(random, 0, 1) * (grid.size[axis] - box.size[axis]));
            }
            AxisBox real;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto at = static_cast<int>(axis);
                real.lo[at] = grid.origin[axis] + grid.spacing[axis] * (box.first[axis] - 0.5);
                real.hi[at] = real.lo[at] + grid.spacing[axis] * box.size[axis];
            }
            // The target is apart from all, and there is one at least.
            if (real.distance(dvec3(0)) > 4) {
                voxels.push_back(box);
                boxes.push_back(real);
            }
        }
        const auto labelOf = [&](auto x, auto y, auto z) {
            for (std::size_t i = voxels.size(); i-- > 0;) {
                const VoxelBox& box = voxels[i];
                if (x - box.first[0] < box.size[0] && y - box.first[1] < box.size[1] &&
                    z - box.first[2] < box.size[2]) {
                    return static_cast<double>(i + 1);
                }
            }
            return 0.0;
        };
        image = makeBytes(grid, [](auto...) { return 0; });
        labels = take(makeLabels(makeBytes(grid, labelOf).view()));
        volume.emplace(take(cpu::Volume::create(image.view())));
        obstacle.volume = &*volume;
        obstacle.labels = &labels;
        // One that others cover has no voxel of its label.
        std::ranges::copy_if(labels.values, std::back_inserter(obstacle.avoid), [](auto label) { return label != 0; });
        task.surface.radius = 30;
        task.surface.entries = 162;
        task.needle = {2, 40};
        task.obstacles = std::span(&obstacle, 1);
    }
    BoxScene(const BoxScene&) = delete;
    BoxScene& operator=(const BoxScene&) = delete;

    /// Of the needle, on its way from an entry.
    [[nodiscard]] double clearance(const dvec3& entry) const {
        const dvec3 target = toGlm(task.target);
        const dvec3 direction = glm::normalize(entry - target);
        const double radius = task.needle.diameter / 2;
        double least = std::numeric_limits<double>::infinity();
        for (const AxisBox& box : boxes) {
            least = std::min(
                least, box.distance(target + radius * direction, entry + (task.needle.length - radius) * direction));
        }
        return std::max(least - radius, 0.0);
    }

    std::vector<AxisBox> boxes;
    VolumeData image;
    LabelData labels;
    std::optional<cpu::Volume> volume;
    cpu::PlanObstacle obstacle;
    cpu::Plan task;
};

} // namespace voxtact::test
