// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/method/certified_constants.h"
#include "cpu/batch_check.h"
#include "cpu/certified/certified_pair.h"
#include "cpu/clearance/search.h"
#include "cpu/raster/occupancy_cache.h"
#include "cpu/tasks.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLeastTolerance = 1e-6;

/// What a thread keeps from pair to pair.
struct ThreadMemory {
    MeshPlace mesh;
    ClosestSearch search;
};

} // namespace

struct ClearanceMeterImpl {
    ClearanceMeterImpl(const ClearanceDesc& chosen, std::uint32_t threads)
        : desc(chosen), pool(threads), memories(pool.threads()) {}

    ClearanceDesc desc;
    ThreadPool pool;
    std::vector<ThreadMemory> memories;
    OccupancyCache<OpaquePart, 2> parts;
};

namespace {

Error refuse(const std::string& text) {
    return Error{ErrorCode::InvalidArgument, 0, text};
}

Result<void> checkDesc(const ClearanceDesc& desc) {
    if (!(desc.tolerance >= kLeastTolerance && desc.tolerance < kInfinity)) {
        return refuse("the tolerance " + number(desc.tolerance) + " mm is not a number from " +
                      number(kLeastTolerance) + " mm on");
    }
    if (!(desc.maximum > 0)) {
        return refuse("the maximum clearance " + number(desc.maximum) + " mm is not above 0");
    }
    if (desc.mostSteps == 0) {
        return refuse("mostSteps is 0, a clearance takes at least one step");
    }
    return checkResolution(desc.resolution);
}

Vec3 toVec3(const dvec3& v) {
    return {v.x, v.y, v.z};
}

/// One pair on one thread.
struct PairAt {
    const BatchItem& item;
    const OpaquePart& part;
    std::uint32_t pose;

    [[nodiscard]] const VolumeImpl& volume() const { return item.volume->impl(); }
    [[nodiscard]] const MeshImpl& mesh() const { return item.mesh->impl(); }
    [[nodiscard]] const Mat4& world_from_object() const { return item.world_from_object[pose]; }

    [[nodiscard]] CertifiedTally touch(const CertifiedSink& sink = {}) const {
        const VolumeImpl& in = volume();
        const CertifiedJob job{mesh(),
                               in,
                               part.occupancy,
                               certifiedPair(in.grid, in.texture_from_world, world_from_object()),
                               0,
                               static_cast<std::uint32_t>(mesh().clusters.size()),
                               true};
        return decide(job, sink);
    }
    [[nodiscard]] Found search(ThreadMemory& memory, const SearchGoal& goal) const {
        memory.mesh.begin(mesh(), part.space, world_from_object());
        return memory.search.run(memory.mesh, volume(), part, goal);
    }
};

ClosestPoints closestOf(const Found& found, const MeshPlace& mesh, const VolumeSpace& space) {
    ClosestPoints out;
    out.triangle = mesh.mesh().numbers[found.triangle];
    out.mesh = toVec3(found.onMesh + space.middle);
    out.volume = toVec3(found.inVolume + space.middle);
    const dvec3 off = found.inVolume - found.onMesh;
    const double distance = glm::length(off);
    if (distance > 0) {
        const dvec3 towards = off / distance;
        out.perTranslation = toVec3(-towards);
        out.perRotation = toVec3(-glm::cross(found.onMesh - mesh.origin(), towards));
    }
    return out;
}

/// A touch, and its witness.
bool touches(const PairAt& at, CertifiedTally& tally, PairClearance& out) {
    ClosestPoints closest;
    tally = at.touch([&](std::uint32_t triangle, const shader::CertifiedProof& proof) {
        closest.triangle = triangle;
        const Vec3 texture{static_cast<double>(proof.texture.x), static_cast<double>(proof.texture.y),
                           static_cast<double>(proof.texture.z)};
        closest.mesh = closest.volume = transformPoint(worldFromTexture(at.volume().grid), texture);
    });
    if (tally.certain == 0) {
        return false;
    }
    out.closest = closest;
    return true;
}

void measurePair(const PairAt& at, const ClearanceDesc& desc, ThreadMemory& memory, PairClearance& out) {
    CertifiedTally touch;
    if (touches(at, touch, out)) {
        return;
    }
    const Found found = at.search(memory, {.tolerance = desc.tolerance,
                                           .maximum = desc.maximum,
                                           .finest = desc.tolerance / 4,
                                           .mostSteps = desc.mostSteps});
    out.bounds = {touch.undecided ? 0 : found.lo, found.hi};
    if (out.bounds.lo >= desc.maximum && out.bounds.lo < kInfinity) {
        out.bounds = {desc.maximum, kInfinity};
        out.end = ClearanceEnd::Beyond;
        return;
    }
    const bool closed = out.bounds.lo == kInfinity || out.bounds.hi - out.bounds.lo <= desc.tolerance;
    out.end = closed ? ClearanceEnd::Closed : (found.exhausted ? ClearanceEnd::Budget : ClearanceEnd::Rounding);
    if (found.hi < kInfinity) {
        out.closest = closestOf(found, memory.mesh, at.part.space);
    }
}

void decideMargin(const PairAt& at, double margin, const ClearanceDesc& desc, ThreadMemory& memory, PairAnswer& out) {
    // What touches is within every margin, and that is soon known.
    const CertifiedTally touch = at.touch();
    out.hit = touch.certain > 0;
    out.possible = !out.hit && touch.undecided;
    if (!out.hit && margin > 0) {
        const Found found = at.search(memory, {.tolerance = 0,
                                               .maximum = std::nextafter(margin, kInfinity),
                                               .enough = margin,
                                               .finest = kDefaultTolerance / 4,
                                               .mostSteps = desc.mostSteps});
        out.hit = found.hi <= margin;
        out.possible = !out.hit && (touch.undecided || found.lo <= margin);
    }
    out.count = out.hit ? 1 : 0;
}

/// Calls `answer(at, pair, memory)` for each pair, on all threads. `pairs` has their numbers.
template <class Answers, class Answer>
void forEachPair(ClearanceMeterImpl& impl, const Batch& batch, Answers& pairs, const Answer& answer) {
    std::vector<std::shared_ptr<const OpaquePart>> parts;
    for (const BatchItem& item : batch.items) {
        parts.push_back(
            impl.parts.get(item.volume->impl(), item.transferFunction->impl(), batch.threshold, impl.desc.resolution));
        for (std::uint32_t pose = 0; pose < item.world_from_object.size(); ++pose) {
            auto& pair = pairs.emplace_back();
            pair.pair = static_cast<std::uint32_t>(pairs.size() - 1);
            pair.item = static_cast<std::uint32_t>(parts.size() - 1);
            pair.pose = pose;
        }
    }
    if (pairs.empty()) {
        return;
    }
    std::atomic<std::size_t> next{0};
    const auto threads = static_cast<std::uint32_t>(std::min<std::size_t>(impl.pool.threads(), pairs.size()));
    impl.pool.run(threads, [&](std::uint32_t thread) {
        for (std::size_t i = next++; i < pairs.size(); i = next++) {
            auto& pair = pairs[i];
            answer(PairAt{batch.items[pair.item], *parts[pair.item], pair.pose}, pair, impl.memories[thread]);
        }
    });
}

Result<void> checkClearanceBatch(const Batch& batch) {
    DetectorDesc desc;
    desc.projection = Projection::Conservative;
    VOXTACT_TRY(checkBatch(desc, batch));
    return {};
}

} // namespace

ClearanceMeter::ClearanceMeter(std::unique_ptr<ClearanceMeterImpl> impl) noexcept : impl_(std::move(impl)) {}
ClearanceMeter::ClearanceMeter(ClearanceMeter&&) noexcept = default;
ClearanceMeter& ClearanceMeter::operator=(ClearanceMeter&&) noexcept = default;
ClearanceMeter::~ClearanceMeter() = default;

Result<ClearanceMeter> ClearanceMeter::create(const ClearanceDesc& desc) {
    return guard([&]() -> Result<ClearanceMeter> {
        VOXTACT_TRY(checkDesc(desc));
        const std::uint32_t processors = std::max(std::thread::hardware_concurrency(), 1U);
        return ClearanceMeter(
            std::make_unique<ClearanceMeterImpl>(desc, desc.threads == 0 ? processors : desc.threads));
    });
}

Result<ClearanceAnswer> ClearanceMeter::measure(const Batch& batch) {
    return guard([&]() -> Result<ClearanceAnswer> {
        const auto start = std::chrono::steady_clock::now();
        VOXTACT_TRY(checkClearanceBatch(batch));
        ClearanceAnswer answer;
        forEachPair(*impl_, batch, answer.pairs, [&](const PairAt& at, PairClearance& pair, ThreadMemory& memory) {
            measurePair(at, impl_->desc, memory, pair);
        });
        answer.wallMilliseconds =
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        return answer;
    });
}

Result<BatchAnswer> ClearanceMeter::within(const Batch& batch, double margin) {
    return guard([&]() -> Result<BatchAnswer> {
        const auto start = std::chrono::steady_clock::now();
        VOXTACT_TRY(checkClearanceBatch(batch));
        if (!(margin >= 0 && margin < kInfinity)) {
            return refuse("the margin " + number(margin) + " mm is not a number from 0 on");
        }
        BatchAnswer answer;
        forEachPair(*impl_, batch, answer.pairs, [&](const PairAt& at, PairAnswer& pair, ThreadMemory& memory) {
            pair.exactness = Exactness::LowerBound;
            pair.method = CountingMethod::Cpu;
            pair.projection = Projection::Conservative;
            decideMargin(at, margin, impl_->desc, memory, pair);
        });
        answer.wallMilliseconds =
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        return answer;
    });
}

std::uint32_t ClearanceMeter::threads() const noexcept {
    return impl_->pool.threads();
}

} // namespace voxtact::cpu
