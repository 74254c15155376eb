// SPDX-License-Identifier: MIT
#include "host/plan/entry_surface.h"
#include "core/base/infinity.h"
#include "core/base/try.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

constexpr double kStep = 0.25; // voxels along the ray: thinner layers may be missed

/// A ray from a target, in the voxels of a grid.
struct VoxelRay {
    dvec3 from{}; ///< centred voxel coordinates
    dvec3 way{};  ///< for each mm
    double begin = 0;
    double end = 0; ///< mm: where it is in the grid's box; before begin where it misses it

    VoxelRay(const VolumeSpace& space, const dvec3& local, const dvec3& direction)
        : from(space.toVoxel(local)), way(space.toVoxel(direction)), end(kInfinity) {
        for (int axis = 0; axis < 3; ++axis) {
            if (way[axis] == 0) {
                end = std::abs(from[axis]) <= space.reach[axis] ? end : -1;
                continue;
            }
            const double one = (-space.reach[axis] - from[axis]) / way[axis];
            const double other = (space.reach[axis] - from[axis]) / way[axis];
            begin = std::max(begin, std::min(one, other));
            end = std::min(end, std::max(one, other));
        }
    }
};

/// The outermost point of a region on a ray from the target.
struct Outermost {
    double distance = 0;  ///< mm; 0: the ray misses the region
    bool isAtEnd = false; ///< the grid ends there, or in air inside the region: no entry
};

/// The largest distance at which `inside(centred voxel)`, examined in steps from outside.
template <class Inside> Outermost outermost(const VoxelRay& ray, const Inside& inside) {
    constexpr int kHalvings = 12;
    const double step = kStep / glm::length(ray.way);
    const double nearest = std::max(ray.begin, kNearestEntry);
    double outside = ray.end;
    double number = 0;
    // Steps stay above the rounding of the distance, so they end.
    for (double at = ray.end; at > nearest; at = ray.end - ++number * step) {
        if (!inside(ray.from + at * ray.way)) {
            outside = at;
            continue;
        }
        const bool isAtEnd = outside == at;
        for (int i = 0; i < kHalvings && !isAtEnd; ++i) {
            const double middle = 0.5 * (at + outside);
            (inside(ray.from + middle * ray.way) ? at : outside) = middle;
        }
        return {at, isAtEnd};
    }
    return {};
}

/// Returns true if a point is opaque, up to rounding.
bool isOpaque(const OpaquePart& part, const VolumeImpl& volume, const dvec3& voxel) {
    NodePlace padded{};
    NodePlace brick{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double number = std::floor(voxel[static_cast<int>(axis)] + part.space.centre[static_cast<int>(axis)]) + 1;
        padded[axis] = std::clamp(static_cast<std::int32_t>(number), 0, volume.image.size[axis]);
        brick[axis] = padded[axis] >> kBrickShift;
    }
    if (!part.pyramid.has(0, brick)) {
        return false;
    }
    const PartCell cell = part.cell(volume, padded);
    const double value = valueAt(cell.terms, 2.0 * (voxel - cell.middle));
    return part.intervals.contain(value - cell.error, value + cell.error);
}

/// Marks the border voxels outside the region that connect, over other such voxels, to an edge of the image. Air that
/// the region encloses at the border, such as the windpipe where a scan ends at the neck, is inside the body.
class Outside {
  public:
    /// `inside(centred voxel)`
    template <class Inside>
    Outside(const VolumeSpace& space, const std::array<std::uint32_t, 3>& size, const Inside& inside)
        : space_(space), size_{size[0], size[1], size[2]}, reached_(size_[0] * size_[1] * size_[2]) {
        std::vector<Place> open;
        const auto visit = [&](const Place& place) {
            if (!reached_[number(place)] && !inside(dvec3(place[0], place[1], place[2]) - space_.centre)) {
                reached_[number(place)] = true;
                open.push_back(place);
            }
        };
        for (std::size_t axis = 0; axis < 3; ++axis) { // the four edges along it
            for (std::size_t corner = 0; corner < 4; ++corner) {
                Place place{};
                place[(axis + 1) % 3] = corner % 2 == 0 ? 0 : size_[(axis + 1) % 3] - 1;
                place[(axis + 2) % 3] = corner / 2 == 0 ? 0 : size_[(axis + 2) % 3] - 1;
                for (; place[axis] < size_[axis]; ++place[axis]) {
                    visit(place);
                }
            }
        }
        while (!open.empty()) {
            const Place from = open.back();
            open.pop_back();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (const std::size_t step : {std::size_t{1}, ~std::size_t{0}}) {
                    Place place = from;
                    place[axis] += step;
                    if (place[axis] < size_[axis] && isOutermost(place)) {
                        visit(place);
                    }
                }
            }
        }
    }

    /// Returns the border voxel at a position, in centred voxel coordinates; for an inner position, an adjacent one.
    template <class Inside> [[nodiscard]] bool has(const dvec3& voxel, const Inside& inside) const {
        Place place{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<int>(axis);
            place[axis] = static_cast<std::size_t>(
                std::clamp(std::round(voxel[i] + space_.centre[i]), 0.0, static_cast<double>(size_[axis]) - 1));
        }
        if (reached_[number(place)] || !inside(dvec3(place[0], place[1], place[2]) - space_.centre)) {
            return reached_[number(place)];
        }
        for (std::size_t beside = 0; beside < 27; ++beside) {
            const Place at{place[0] + beside % 3 - 1, place[1] + beside / 3 % 3 - 1, place[2] + beside / 9 - 1};
            if (at[0] < size_[0] && at[1] < size_[1] && at[2] < size_[2] && reached_[number(at)]) {
                return true;
            }
        }
        return false;
    }

  private:
    using Place = std::array<std::size_t, 3>;

    [[nodiscard]] std::size_t number(const Place& place) const {
        return (place[2] * size_[1] + place[1]) * size_[0] + place[0];
    }
    [[nodiscard]] bool isOutermost(const Place& place) const {
        bool is = false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            is = is || place[axis] == 0 || place[axis] == size_[axis] - 1;
        }
        return is;
    }

    const VolumeSpace& space_;
    Place size_;
    std::vector<bool> reached_;
};

class EntrySearch {
  public:
    EntrySearch(const PlanScene& scene, Workers& workers)
        : surface_(scene.task.surface), target_(scene.task.target[0], scene.task.target[1], scene.task.target[2]) {
        if (surface_.volume != nullptr) {
            part_ = workers.part(surface_.volume->impl(), surface_.transferFunction->impl(), surface_.threshold);
        } else if (surface_.labels != nullptr) {
            space_.emplace(surface_.labels->grid);
            const auto& values = surface_.labels->values;
            const auto found = std::lower_bound(values.begin(), values.end(), surface_.label);
            index_ = found != values.end() && *found == surface_.label
                         ? static_cast<std::size_t>(found - values.begin())
                         : values.size();
        }
        if (!surface_.borderEntries && (part_ || space_)) {
            const Grid& grid = part_ ? surface_.volume->grid() : surface_.labels->grid;
            outside_.emplace(space(), grid.size, [this](const dvec3& voxel) { return isInside(voxel); });
        }
    }

    /// Finds the outermost point in a direction from the target.
    [[nodiscard]] Outermost along(const dvec3& direction) const {
        if (!part_ && !space_) {
            return {surface_.radius, false};
        }
        const VoxelRay ray(space(), target_ - space().middle, direction);
        Outermost found = outermost(ray, [this](const dvec3& voxel) { return isInside(voxel); });
        found.isAtEnd =
            outside_ && (found.isAtEnd || !outside_->has(ray.from + ray.end * ray.way,
                                                         [this](const dvec3& voxel) { return isInside(voxel); }));
        return found;
    }

  private:
    [[nodiscard]] const VolumeSpace& space() const { return part_ ? part_->space : *space_; }
    [[nodiscard]] bool isInside(const dvec3& voxel) const {
        return part_ ? isOpaque(*part_, surface_.volume->impl(), voxel) : hasLabel(voxel);
    }
    [[nodiscard]] bool hasLabel(const dvec3& voxel) const {
        const auto& size = surface_.labels->grid.size;
        std::array<std::size_t, 3> at{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<int>(axis);
            at[axis] = static_cast<std::size_t>(
                std::clamp(std::floor(voxel[i] + space_->reach[i]), 0.0, static_cast<double>(size[axis]) - 1));
        }
        return surface_.labels->indices[(at[2] * size[1] + at[1]) * size[0] + at[0]] == index_;
    }

    const EntrySurface& surface_;
    dvec3 target_;
    std::shared_ptr<const OpaquePart> part_;
    std::optional<VolumeSpace> space_; ///< of the labels
    std::size_t index_ = 0;            ///< of the label; none has the number of labels
    std::optional<Outside> outside_;   ///< empty if entries on the border are allowed
};

/// Normal of the surface at an entry: the mean over the adjacent entry triangles, weighted by area.
std::vector<dvec3> normalsOf(const PlanScene& scene) {
    std::vector<dvec3> normals(scene.entries.size());
    forEntryTriangles(scene, [&](auto, auto, auto, auto, const std::array<std::uint32_t, 3>& triangle) {
        const dvec3 a = scene.entries[triangle[0]].position;
        const dvec3 normal =
            glm::cross(scene.entries[triangle[1]].position - a, scene.entries[triangle[2]].position - a);
        for (const std::uint32_t corner : triangle) {
            normals[corner] += normal;
        }
    });
    return normals;
}

} // namespace

Result<void> findEntries(PlanScene& scene, Workers& workers, PlanAnswer& answer) {
    const EntrySearch search(scene, workers);
    const dvec3 target(scene.task.target[0], scene.task.target[1], scene.task.target[2]);
    scene.entries.resize(scene.grid.count());
    for (std::uint32_t number = 0; number < scene.grid.count(); ++number) {
        scene.entries[number].number = number;
    }
    VOXTACT_TRY(workers.forEach(scene.entries, scene.cancel, [&](EntryPoint& entry, ThreadMemory& /*memory*/) {
        const dvec3 direction = scene.grid.direction(entry.number);
        const Outermost found = search.along(direction);
        entry.length = found.distance;
        entry.isOnBorder = found.distance > kNearestEntry && found.isAtEnd;
        entry.isThere = found.distance > kNearestEntry && !entry.isOnBorder;
        entry.position = target + entry.length * direction;
    }));
    const std::vector<dvec3> normals = normalsOf(scene);
    answer.directions = scene.grid.count();
    for (EntryPoint& entry : scene.entries) {
        const dvec3& normal = normals[entry.number];
        if (const double size = glm::length(normal); entry.isThere && size > 0) {
            const double cosine = glm::dot(normal, scene.grid.direction(entry.number)) / size;
            entry.angle = glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0)));
        }
        const bool tooLong = scene.task.longest && entry.length > *scene.task.longest;
        const bool tooOblique = scene.task.steepest && !(entry.angle && *entry.angle <= *scene.task.steepest);
        const bool isLeft = entry.isThere && !tooLong && !tooOblique;
        (entry.isOnBorder ? answer.onBorder
         : !entry.isThere ? answer.noSurface
         : tooLong        ? answer.tooLong
                          : answer.tooOblique) += isLeft ? 0 : 1;
        entry.isThere = isLeft;
    }
    return {};
}

} // namespace voxtact::cpu
