// SPDX-License-Identifier: MIT
#include "lab/engines/localize.h"
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "detect/batch.h"
#include "detect/recording.h"
#include "detect/view.h"
#include "gpu/debug.h"
#include "gpu/scene_impl.h"
#include "gpu/submit.h"
#include "lab/measure/stopwatch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace voxtact {

struct Localizer::State {
    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    ViewPass pass;
    Results results; ///< for the transform and the timestamps; counts nothing
    Owned<VkQueryPool> queries;
    Submitter submitter;
};

namespace {

/// Queries of a submission.
constexpr std::uint32_t kQueries = 4096;
/// What prepareResults() and publishResults() are to do: nothing about queries.
constexpr DetectorDesc kDesc{.method = CountingMethod::Atomic, .boundary = Boundary::Range};
/// How much larger boxes are made, beside what the device's float arithmetic can be off by, relative to coordinates.
constexpr double kVoxels = 0.5;
constexpr double kFloatError = 0x1p-18;

Result<Owned<VkQueryPool>> makeQueries(ContextImpl& context) {
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_OCCLUSION;
    info.queryCount = kQueries;
    VkQueryPool pool = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateQueryPool(context.device, &info, context.allocator, &pool);
        result != VK_SUCCESS) {
        return context.failure(result, "making a query pool");
    }
    nameObject(context, VK_OBJECT_TYPE_QUERY_POOL, pool, "queries of triangles");
    return Owned<VkQueryPool>(context, pool, [](ContextImpl& c, VkQueryPool handle) {
        c.vk.DestroyQueryPool(c.device, handle, c.allocator);
    });
}

/// Whether a node of the tree may touch, by the margins around its bounds in texture space.
bool mayTouch(const ObbNode& node, const Mat4& texture_from_object, const Grid& grid, const LocalizeAids& aids,
              bool bricks) {
    // But for rounding, which is far below the margin.
    const Box box = transformBox(multiply(texture_from_object, frameOf(node)), {{-1, -1, -1}, {1, 1, 1}});
    Box within;
    Box grown;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double size = std::max(std::abs(box.lo[axis]), std::abs(box.hi[axis]));
        const double margin = kVoxels / grid.size[axis] + kFloatError * size;
        grown.lo[axis] = -margin;
        grown.hi[axis] = 1 + margin;
        within.lo[axis] = std::clamp(box.lo[axis] - margin, 0.0, 1.0);
        within.hi[axis] = std::clamp(box.hi[axis] + margin, 0.0, 1.0);
    }
    return obbMeetsBox(node, texture_from_object, grown) && (!bricks || aids.mayBeOpaque(within));
}

/// The triangles that get a query, by number.
std::vector<std::uint32_t> candidates(const BatchItem& item, Localization way, const LocalizeAids& aids,
                                      lab::Pass& out) {
    if (way == Localization::Polygon) {
        std::vector<std::uint32_t> all(item.mesh->triangles());
        std::iota(all.begin(), all.end(), 0U);
        return all;
    }
    const Mat4 texture_from_object = multiply(item.volume->impl().texture_from_world, item.world_from_object.front());
    std::uint64_t boxes = 0;
    std::vector<std::uint32_t> found = touchingTriangles(*aids.tree, [&](const ObbNode& node) {
        ++boxes;
        return mayTouch(node, texture_from_object, item.volume->grid(), aids, way == Localization::LeafBricks);
    });
    out.boxes = boxes;
    std::ranges::sort(found);
    return found;
}

Result<void> checkAids(const BatchItem& item, Localization way, const LocalizeAids& aids) {
    if (way == Localization::Polygon) {
        return {};
    }
    if (aids.tree == nullptr || aids.tree->triangles.size() != item.mesh->triangles()) {
        return refuse("LocalizeAids::tree must be the tree of the mesh, which has " +
                      std::to_string(item.mesh->triangles()) + " triangles; it has " +
                      (aids.tree == nullptr ? "none" : std::to_string(aids.tree->triangles.size())));
    }
    if (way == Localization::LeafBricks && !aids.mayBeOpaque) {
        return refuse("LocalizeAids::mayBeOpaque is empty, leaf-bricks asks it");
    }
    return {};
}

/// One submission: the survivors of at most kQueries triangles.
Result<std::vector<std::uint64_t>> count(Localizer::State& localizer, const Batch& batch,
                                         std::span<const std::uint32_t> triangles,
                                         std::optional<double>& gpuMilliseconds) {
    ContextImpl& context = localizer.context;
    const Result<VkCommandBuffer> commandBuffer = localizer.submitter.begin();
    VOXTACT_TRY(commandBuffer);
    const auto queries = static_cast<std::uint32_t>(triangles.size());
    ResultsImpl& results = localizer.results.impl();
    results.pairs = 1;
    results.detectRecorded = true;
    {
        const Label label(context, *commandBuffer, "voxtact localize");
        VOXTACT_TRY(prepareResults(context, *commandBuffer, batch, results, kDesc));
        context.vk.CmdResetQueryPool(*commandBuffer, localizer.queries.get(), 0, queries);
        localizer.pass.recordTriangles(*commandBuffer, batch, results, triangles, localizer.queries.get());
        publishResults(context, *commandBuffer, results, kDesc);
    }
    VOXTACT_TRY(localizer.submitter.submitAndWait());
    std::vector<std::uint64_t> counts(queries);
    const VkResult read = context.vk.GetQueryPoolResults(
        context.device, localizer.queries.get(), 0, queries, counts.size() * sizeof counts[0], counts.data(),
        sizeof counts[0], VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
    if (read != VK_SUCCESS) {
        return context.failure(read, "reading queries");
    }
    if (results.timestamps) {
        const Result<double> time = localizer.results.gpuMilliseconds();
        VOXTACT_TRY(time);
        gpuMilliseconds = gpuMilliseconds && *time > 0 ? std::optional(*gpuMilliseconds + *time) : std::nullopt;
    }
    return counts;
}

Result<lab::Pass> localize(Localizer::State& localizer, const Batch& batch, const BatchItem& item, Localization way,
                           const LocalizeAids& aids) {
    const lab::Stopwatch watch;
    lab::Pass out;
    out.gpuMilliseconds = localizer.results.impl().timestamps ? std::optional(0.0) : std::nullopt;
    const std::vector<std::uint32_t> all = candidates(item, way, aids, out);
    out.queries = all.size();
    for (std::size_t first = 0; first < all.size(); first += kQueries) {
        const auto some = std::span(all).subspan(first, std::min<std::size_t>(kQueries, all.size() - first));
        const Result<std::vector<std::uint64_t>> counts = count(localizer, batch, some, out.gpuMilliseconds);
        VOXTACT_TRY(counts);
        for (std::size_t i = 0; i < some.size(); ++i) {
            if ((*counts)[i] > 0) {
                out.triangles.push_back({0, some[i], static_cast<std::uint32_t>((*counts)[i])});
            }
        }
    }
    out.wallMilliseconds = watch.milliseconds();
    return out;
}

} // namespace

const char* toString(Localization way) noexcept {
    constexpr std::array kNames{"polygon", "leaf", "leaf-bricks"};
    return kNames.at(static_cast<std::size_t>(way));
}

Result<Localizer> Localizer::create(const Context& context, Filter filter, const QueueAccess& queue) {
    return guard([&]() -> Result<Localizer> {
        ContextImpl& c = context.impl();
        if (!c.features.occlusionQueryPrecise) {
            return Error{ErrorCode::Unsupported, 0,
                         "counting the survivors of a triangle needs occlusionQueryPrecise to be enabled"};
        }
        Result<Submitter> submitter = Submitter::create(c, queue);
        VOXTACT_TRY(submitter);
        Result<ViewPass> pass = ViewPass::create(c, {.method = CountingMethod::Query, .filter = filter});
        VOXTACT_TRY(pass);
        Result<Results> results = Results::create(context, {.maxPairs = 1,
                                                            .readBack = false,
                                                            .timestamps = c.timestampBits(queue.family) > 0,
                                                            .queueFamily = queue.family});
        VOXTACT_TRY(results);
        Result<Owned<VkQueryPool>> queries = makeQueries(c);
        VOXTACT_TRY(queries);
        return Localizer(std::make_shared<State>(State{.context = c,
                                                       .pass = std::move(*pass),
                                                       .results = std::move(*results),
                                                       .queries = std::move(*queries),
                                                       .submitter = std::move(*submitter)}));
    });
}

Result<lab::Pass> Localizer::triangles(const Batch& batch, Localization way, const LocalizeAids& aids) {
    return guard([&]() -> Result<lab::Pass> {
        const Result<std::uint32_t> pairs = checkBatch(state_->context, kDesc, batch);
        VOXTACT_TRY(pairs);
        if (*pairs != 1) {
            return refuse("triangles are found for one pair, the batch has " + std::to_string(*pairs));
        }
        const BatchItem& item =
            *std::ranges::find_if(batch.items, [](const BatchItem& i) { return !i.world_from_object.empty(); });
        VOXTACT_TRY(checkAids(item, way, aids));
        return localize(*state_, batch, item, way, aids);
    });
}

} // namespace voxtact
