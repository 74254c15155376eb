// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/facts/facts.h"
#include "host/batch_check.h"
#include "host/search/workers.h"

#include <array>
#include <cmath>

namespace voxtact::cpu {

namespace {

/// The scene of a tracked distance.
struct TrackedScene {
    std::uint64_t mesh = 0;
    std::uint64_t volume = 0;
    std::uint64_t function = 0;
    double threshold = 0;

    [[nodiscard]] bool operator==(const TrackedScene&) const = default;
};

/// Upper bound, mm, of the displacement of a point of a box of object space between two poses. The difference of two
/// affine maps is affine, and its length is largest at a corner.
double movedBy(const Mat4& from, const Mat4& to, const Box& box) {
    constexpr double kRounding = 1e-14;
    double most = 0;
    double terms = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        std::array<double, 3> moved{};
        for (std::size_t row = 0; row < 3; ++row) {
            moved[row] = to[12 + row] - from[12 + row];
            terms = std::max(terms, std::abs(moved[row]));
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double at = (corner >> axis & 1U) != 0 ? box.hi[axis] : box.lo[axis];
                const double term = (to[4 * axis + row] - from[4 * axis + row]) * at;
                moved[row] += term;
                terms = std::max(terms, std::abs(term));
            }
        }
        most = std::max(most, std::hypot(moved[0], moved[1], moved[2]));
    }
    return most + kRounding * (most + 16 * terms);
}

Result<void> checkDesc(const TrackerDesc& desc) {
    VOXTACT_TRY(checkFact(factOf("distance", "max"), desc.maximum));
    if (desc.maxSteps == 0) {
        return refuse("at most 0 steps are allowed, a search takes at least one step");
    }
    return checkFact(factOf("count", "resolution"), desc.resolution);
}

} // namespace

struct DistanceTrackerImpl {
    explicit DistanceTrackerImpl(const TrackerDesc& chosen) : desc(chosen) {}

    TrackedDistance track(const BatchItem& item, double threshold);

  private:
    [[nodiscard]] TrackedDistance search(const BatchItem& item, double threshold, double ahead);

    TrackerDesc desc;
    ThreadMemory memory;
    OccupancyCache<OpaquePart, 2> parts;
    TrackedScene scene; ///< of all members below; no object has the id 0
    Mat4 lastPose{};
    Mat4 lookedAt{}; ///< the pose of the last search
    Bounds known;    ///< of that pose
};

TrackedDistance DistanceTrackerImpl::track(const BatchItem& item, double threshold) {
    /// Number of moves like the last one, mm, that a search covers.
    constexpr double kAhead = 32;
    const Mat4& pose = item.world_from_object[0];
    const Box& box = item.mesh->impl().facts.bounds;
    const TrackedScene now{item.mesh->impl().id, item.volume->impl().id, item.transferFunction->impl().id, threshold};
    const bool isSame = now == scene;
    const double moved = isSame ? movedBy(lookedAt, pose, box) : kInfinity;
    const double step = isSame ? movedBy(lastPose, pose, box) : kInfinity;
    lastPose = pose;
    if (isSame && known.lower > moved) {
        TrackedDistance out;
        out.bounds = {known.lower - moved, known.upper + moved};
        return out;
    }
    scene = {}; // a failed search leaves no known distance
    const TrackedDistance out = search(item, threshold, kAhead * step);
    scene = now;
    lookedAt = pose;
    known = out.bounds;
    return out;
}

TrackedDistance DistanceTrackerImpl::search(const BatchItem& item, double threshold, double ahead) {
    constexpr double kLeastAhead = 0.25; // mm
    constexpr double kRelative = 0.25;
    TrackedDistance out;
    out.searched = true;
    const std::shared_ptr<const OpaquePart> part =
        parts.get(item.volume->impl(), item.transferFunction->impl(), threshold, desc.resolution);
    const PairAt at{item, *part, item.world_from_object[0]};
    std::optional<TouchPoint> point;
    const CertifiedTally touch = at.touch(point);
    out.hit = touch.certain > 0;
    out.possible = !out.hit && touch.undecided;
    if (out.hit) {
        return out;
    }
    const double maximum = std::min(desc.maximum, std::max(ahead, kLeastAhead));
    const Found found = at.search(memory, {.tolerance = kDefaultTolerance,
                                           .relative = kRelative,
                                           .maximum = maximum,
                                           .finest = kDefaultTolerance / 4,
                                           .maxSteps = desc.maxSteps});
    out.bounds = {out.possible ? 0 : found.lo, found.hi};
    return out;
}

DistanceTracker::DistanceTracker(std::unique_ptr<DistanceTrackerImpl> impl) noexcept : impl_(std::move(impl)) {}
DistanceTracker::DistanceTracker(DistanceTracker&&) noexcept = default;
DistanceTracker& DistanceTracker::operator=(DistanceTracker&&) noexcept = default;
DistanceTracker::~DistanceTracker() = default;

Result<DistanceTracker> DistanceTracker::create(const TrackerDesc& desc) {
    return guard([&]() -> Result<DistanceTracker> {
        VOXTACT_TRY(checkDesc(desc));
        return DistanceTracker(std::make_unique<DistanceTrackerImpl>(desc));
    });
}

Result<TrackedDistance> DistanceTracker::track(const BatchItem& item, double threshold) {
    return guard([&]() -> Result<TrackedDistance> {
        VOXTACT_TRY(checkCertifiedItem(item, threshold));
        if (item.world_from_object.size() != 1) {
            return refuse("a tracker takes one pose at a time, not " + std::to_string(item.world_from_object.size()));
        }
        return impl_->track(item, threshold);
    });
}

} // namespace voxtact::cpu
