// SPDX-License-Identifier: MIT
#include "bench/engines/localize.h"

#include "bench/measure/numbers.h"
#include "bench/measure/stopwatch.h"
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "device/detector/batch.h"
#include "device/detector/detector_impl.h"
#include "device/detector/recording.h"
#include "device/results/result_store.h"
#include "device/scene/scene_impl.h"
#include "host/touch/cells/brick_occupancy.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"
#include "vulkan/layouts.h"
#include "vulkan/query_pool.h"
#include "vulkan/submit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <span>
#include <tuple>

namespace voxtact {

struct Localizer::State {
    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    std::optional<Detector> detector{}; ///< whose pass draws
    std::optional<Results> results{};   ///< for the transform and the timestamps; counts nothing
    Owned<VkQueryPool> queries{};
    std::optional<Submitter> submitter{};
};

struct FragmentTrace::State {
    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    Owned<VkDescriptorSetLayout> setLayout{};
    Owned<VkPipelineLayout> layout{};
    std::optional<ViewPass> pass{};
    std::unique_ptr<ResultsImpl> results{};
    Buffer list{};
    Buffer readBack{};
    DescriptorSet descriptors{};
    std::optional<Submitter> submitter{};
};

namespace {

/// Queries of a submission.
constexpr std::uint32_t kQueries = 4096;
/// Plan for prepareResults() and publishResults(): no queries.
constexpr PassDesc kDesc = passDesc(RasterDesc{.method = CountingMethod::Atomic, .boundary = Boundary::Range});

/// Refuses a batch that is not of one pair.
Result<void> checkOnePair(const ContextImpl& context, const Batch& batch, const char* what) {
    const Result<std::uint32_t> pairs = checkBatch(context, kDesc, batch);
    VOXTACT_TRY(pairs);
    return *pairs == 1 ? Result<void>() : refuse(lab::concat(what, " one pair, the batch has ", *pairs));
}

/// Margin of boxes in addition to the error of the device's float arithmetic, relative to coordinates.
constexpr double kVoxels = 0.5;
constexpr double kFloatError = 0x1p-18;

/// Tests whether a node of the tree may touch, with margins around its bounds in texture space.
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
        return refuse(lab::concat("LocalizeAids::tree must be the tree of the mesh, which has ", item.mesh->triangles(),
                                  " triangles; it has ",
                                  aids.tree == nullptr ? "none" : std::to_string(aids.tree->triangles.size())));
    }
    if (way == Localization::LeafBricks && !aids.mayBeOpaque) {
        return refuse("LocalizeAids::mayBeOpaque is empty, leaf-bricks asks it");
    }
    return {};
}

/// One submission: the passing fragments of at most kQueries triangles.
Result<std::vector<std::uint64_t>> count(Localizer::State& localizer, const Batch& batch,
                                         std::span<const std::uint32_t> triangles,
                                         std::optional<double>& gpuMilliseconds) {
    ContextImpl& context = localizer.context;
    const Result<VkCommandBuffer> commandBuffer = localizer.submitter->begin();
    VOXTACT_TRY(commandBuffer);
    const auto queries = static_cast<std::uint32_t>(triangles.size());
    ResultsImpl& results = localizer.results->impl();
    results.pairs = 1;
    results.detectRecorded = true;
    {
        const Label label(context, *commandBuffer, "voxtact localize");
        VOXTACT_TRY(prepareResults(context, *commandBuffer, batch, results, kDesc));
        context.vk.CmdResetQueryPool(*commandBuffer, localizer.queries.get(), 0, queries);
        std::get<ViewPass>(localizer.detector->impl().pass)
            .recordTriangles(*commandBuffer, batch, results, triangles, localizer.queries.get());
        publishResults(context, *commandBuffer, results, kDesc);
    }
    VOXTACT_TRY(localizer.submitter->submitAndWait());
    std::vector<std::uint64_t> counts(queries);
    const VkResult read = context.vk.GetQueryPoolResults(
        context.device, localizer.queries.get(), 0, queries, counts.size() * sizeof counts[0], counts.data(),
        sizeof counts[0], VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
    if (read != VK_SUCCESS) {
        return context.failure(read, "reading queries");
    }
    if (results.timestamps) {
        const Result<double> time = localizer.results->gpuMilliseconds();
        VOXTACT_TRY(time);
        gpuMilliseconds = gpuMilliseconds && *time > 0 ? std::optional(*gpuMilliseconds + *time) : std::nullopt;
    }
    return counts;
}

Result<lab::Pass> localize(Localizer::State& localizer, const Batch& batch, const BatchItem& item, Localization way,
                           const LocalizeAids& aids) {
    const lab::Stopwatch watch;
    lab::Pass out;
    out.gpuMilliseconds = localizer.results->impl().timestamps ? std::optional(0.0) : std::nullopt;
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

constexpr std::uint32_t kFirstCapacity = 1U << 16U;
/// The list is a counter, then records.
constexpr VkDeviceSize kHeader = sizeof(std::uint32_t);

Result<void> makeLayouts(FragmentTrace::State& trace) {
    ContextImpl& context = trace.context;
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_FRAGMENT_BIT,
                                               nullptr};
    VOXTACT_TRY(makeSetLayout(context, trace.setLayout, {&binding, 1}, "trace set layout"));
    const VkDescriptorSetLayout sets[] = {context.setLayouts[0], context.setLayouts[1], context.setLayouts[2],
                                          trace.setLayout.get()};
    static_assert(std::size(sets) == VOXTACT_SET_TRACE + 1);
    const VkPushConstantRange constants{VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(shader::RasterConstants)};
    return makePipelineLayout(context, trace.layout, sets, {&constants, 1}, "trace pipeline layout");
}

/// Makes room for a list of `capacity` fragments.
Result<void> reserve(FragmentTrace::State& trace, std::uint32_t capacity) {
    ContextImpl& context = trace.context;
    const VkDeviceSize bytes = kHeader + VkDeviceSize{capacity} * sizeof(shader::TracedFragment);
    if (bytes > context.limits.maxStorageBufferRange) {
        return Error{ErrorCode::OutOfMemory, 0,
                     lab::concat("a list of ", capacity, " fragments is beyond the device's maxStorageBufferRange, ",
                                 context.limits.maxStorageBufferRange)};
    }
    Result<Buffer> list = makeBuffer(context, bytes,
                                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                         VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                     MemoryUse::Device, "fragment list");
    VOXTACT_TRY(list);
    Result<Buffer> readBack =
        makeBuffer(context, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::ReadBack, "fragment list on the host");
    VOXTACT_TRY(readBack);
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    Result<DescriptorSet> set = makeDescriptorSet(context, trace.setLayout.get(), {&size, 1}, "fragment list");
    VOXTACT_TRY(set);
    trace.list = std::move(*list);
    trace.readBack = std::move(*readBack);
    trace.descriptors = std::move(*set);
    writeBuffer(context, trace.descriptors.set, 0, trace.list.get());
    return {};
}

Result<void> record(FragmentTrace::State& trace, VkCommandBuffer commandBuffer, const Batch& batch) {
    ContextImpl& context = trace.context;
    ResultsImpl& results = *trace.results;
    const Label label(context, commandBuffer, "voxtact fragment trace");
    results.pairs = 1;
    const std::uint32_t zero = 0;
    context.vk.CmdUpdateBuffer(commandBuffer, trace.list.get(), 0, sizeof zero, &zero);
    VOXTACT_TRY(prepareResults(context, commandBuffer, batch, results, kDesc));
    context.vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, trace.layout.get(),
                                     VOXTACT_SET_TRACE, 1, &trace.descriptors.set, 0, nullptr);
    trace.pass->record(commandBuffer, batch, results, [](const BatchItem&) { return Boundary::Range; });
    publishResults(context, commandBuffer, results, kDesc);
    const VkBufferCopy whole{0, 0, trace.list.size};
    context.vk.CmdCopyBuffer(commandBuffer, trace.list.get(), trace.readBack.get(), 1, &whole);
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    return {};
}

/// One attempt: returns the number of passing fragments; the list may hold fewer.
Result<std::uint32_t> run(FragmentTrace::State& trace, const Batch& batch) {
    const Result<VkCommandBuffer> commandBuffer = trace.submitter->begin();
    VOXTACT_TRY(commandBuffer);
    VOXTACT_TRY(record(trace, *commandBuffer, batch));
    VOXTACT_TRY(trace.submitter->submitAndWait());
    VOXTACT_TRY(invalidate(trace.context, trace.readBack));
    std::uint32_t count = 0;
    std::memcpy(&count, trace.readBack.mapped, sizeof count);
    return count;
}

Result<lab::Pass> listFragments(FragmentTrace& trace, const lab::Work& work, const lab::Feeding& /*feeding*/) {
    const lab::Stopwatch watch;
    const BatchItem item = work.onDevice();
    const Result<std::vector<shader::TracedFragment>> fragments =
        trace.survivors({{&item, 1}, work.view, work.volume->threshold});
    VOXTACT_TRY(fragments);
    lab::Pass pass;
    for (const shader::TracedFragment& fragment : *fragments) {
        if (pass.triangles.empty() || pass.triangles.back().triangle != fragment.triangle) {
            pass.triangles.push_back({0, fragment.triangle, 0});
        }
        ++pass.triangles.back().count;
    }
    pass.wallMilliseconds = watch.milliseconds();
    return pass;
}

lab::EngineFacts factsOfView(const char* name) {
    return {.name = name, .projection = toString(Projection::View), .threads = 0};
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
        const auto state = std::make_shared<State>(State{.context = c});
        VOXTACT_TRY(lab::put(Submitter::create(c, queue), state->submitter));
        VOXTACT_TRY(lab::put(Detector::raster(context, {.filter = filter}), state->detector));
        VOXTACT_TRY(lab::put(Results::create(*state->detector, {.maxPairs = 1,
                                                                .readBack = false,
                                                                .timestamps = c.timestampBits(queue.family) > 0,
                                                                .queueFamily = queue.family}),
                             state->results));
        VOXTACT_TRY(
            lab::put(makeQueryPool(c, VK_QUERY_TYPE_OCCLUSION, kQueries, "queries of triangles"), state->queries));
        return Localizer(state);
    });
}

Result<lab::Pass> Localizer::triangles(const Batch& batch, Localization way, const LocalizeAids& aids) {
    return guard([&]() -> Result<lab::Pass> {
        VOXTACT_TRY(checkOnePair(state_->context, batch, "triangles are found for"));
        const BatchItem& item =
            *std::ranges::find_if(batch.items, [](const BatchItem& i) { return !i.world_from_object.empty(); });
        VOXTACT_TRY(checkAids(item, way, aids));
        return localize(*state_, batch, item, way, aids);
    });
}

Result<FragmentTrace> FragmentTrace::create(const Context& context, Filter filter, const QueueAccess& queue) {
    return guard([&]() -> Result<FragmentTrace> {
        ContextImpl& c = context.impl();
        if (!c.features.geometryShader || !c.features.fragmentStoresAndAtomics) {
            return Error{ErrorCode::Unsupported, 0,
                         "a list of fragments needs geometryShader and fragmentStoresAndAtomics to be enabled"};
        }
        const auto state = std::make_shared<State>(State{.context = c});
        VOXTACT_TRY(lab::put(Submitter::create(c, queue), state->submitter));
        VOXTACT_TRY(makeLayouts(*state));
        VOXTACT_TRY(lab::put(ViewPass::createTrace(c, filter, state->layout.get()), state->pass));
        VOXTACT_TRY(lab::put(makeResults(c, kDesc, {.maxPairs = 1, .readBack = false}), state->results));
        VOXTACT_TRY(reserve(*state, kFirstCapacity));
        return FragmentTrace(state);
    });
}

Result<std::vector<shader::TracedFragment>> FragmentTrace::survivors(const Batch& batch) {
    return guard([&]() -> Result<std::vector<shader::TracedFragment>> {
        VOXTACT_TRY(checkOnePair(state_->context, batch, "a trace is of"));
        Result<std::uint32_t> count = run(*state_, batch);
        if (count.ok() && kHeader + VkDeviceSize{*count} * sizeof(shader::TracedFragment) > state_->list.size) {
            VOXTACT_TRY(reserve(*state_, *count));
            count = run(*state_, batch);
        }
        VOXTACT_TRY(count);
        std::vector<shader::TracedFragment> out(*count);
        std::ranges::copy_n(static_cast<const std::byte*>(state_->readBack.mapped) + kHeader,
                            static_cast<std::ptrdiff_t>(out.size() * sizeof out[0]),
                            std::as_writable_bytes(std::span(out)).begin());
        std::ranges::sort(out, {}, [](const shader::TracedFragment& f) { return std::tuple(f.triangle, f.y, f.x); });
        return out;
    });
}

namespace lab {

Result<Engines> makePolygonEngines(const device::Session& session, const VolumePart& volume, const MeshPart& mesh,
                                   double tolerance) {
    Result<Localizer> localizer = Localizer::create(session.context, Filter::Hardware, session.device.queueAccess());
    VOXTACT_TRY(localizer);
    struct Parts {
        Localizer localizer;
        ObbTree tree;
        cpu::BrickOccupancy bricks;
    };
    const auto parts = std::make_shared<Parts>(
        Parts{std::move(*localizer), makeObbTree(mesh.data.view()),
              cpu::BrickOccupancy(*volume.host, *volume.hostFunction, volume.threshold, tolerance)});
    Engines engines;
    for (const Localization way : {Localization::Polygon, Localization::Leaf, Localization::LeafBricks}) {
        engines.push_back(
            {factsOfView(toString(way)), [parts, way](const Work& work, const Feeding&) {
                 const BatchItem item = work.onDevice();
                 const LocalizeAids aids{&parts->tree, [&](const Box& box) { return parts->bricks.mayBeOpaque(box); }};
                 return parts->localizer.triangles({{&item, 1}, work.view, work.volume->threshold}, way, aids);
             }});
    }
    return engines;
}

MadeEngine makeFragmentEngine(const device::Session& session) {
    Result<FragmentTrace> trace =
        FragmentTrace::create(session.context, Filter::Hardware, session.device.queueAccess());
    VOXTACT_TRY(trace);
    return engineOf(factsOfView("fragments"), std::move(*trace), listFragments);
}

} // namespace lab

} // namespace voxtact
