// SPDX-License-Identifier: MIT
#include "core/base/enum_check.h"
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/facts/facts.h"
#include "core/geometry/projection.h"
#include "core/method/method_table.h"
#include "core/transfer/opaque_ranges.h"
#include "device/detector/batch.h"
#include "device/detector/detector_impl.h"
#include "device/detector/recording.h"
#include "device/outputs/outputs.h"
#include "device/scene/scene_impl.h"
#include "vulkan/debug.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

std::string labelOf(const PassDesc& desc, std::uint32_t pairs) {
    return std::string("voxtact detect ") + toString(desc.projection) + "/" + toString(desc.method) + ", " +
           std::to_string(pairs) + " pairs";
}

/// The largest term of a texel, in the image's units.
double largestTexel(const VolumeImpl& volume) {
    if (volume.storedUnit > 0) {
        return volume.valueSlope; // of a normalised texel
    }
    double largest = 0;
    for (const ValueRange& range : *volume.boundary) {
        largest = std::max({largest, std::abs(range.lo), std::abs(range.hi)});
    }
    return largest;
}

Result<void> checkMethod(const ContextImpl& context, CountingMethod method) {
    for (const MethodSupport& entry : context.methods) {
        if (entry.method == method) {
            if (entry.available) {
                return {};
            }
            return Error{ErrorCode::Unsupported, 0,
                         std::string("the counting method ") + toString(method) +
                             " cannot be used on this device: " + entry.reason};
        }
    }
    if (isKnown(method)) {
        return refuse(std::string("the counting method ") + toString(method) +
                      " is the host engine's (voxtact/cpu.h), not a device's");
    }
    return refuse("there is no counting method number " + std::to_string(static_cast<std::uint32_t>(method)));
}

Result<void> checkOverestimate(const ContextImpl& context, const PassDesc& desc) {
    if (!desc.overestimate) {
        return {};
    }
    if (!rowOf(desc.projection).voxelGrid || rowOf(desc.method).coverage != Coverage::Rasteriser) {
        return refuse(std::string("the overestimate is for the projection dominant-axis by a method that "
                                  "rasterises, not for ") +
                      toString(desc.projection) + " by " + toString(desc.method));
    }
    if (!context.conservativeRasterization) {
        return Error{
            ErrorCode::Unsupported, 0,
            "the overestimate needs the device extension VK_EXT_conservative_rasterization, which is not among those "
            "that the context was told of"};
    }
    return {};
}

Result<void> checkDesc(const ContextImpl& context, const PassDesc& desc) {
    for (const Result<void>& known :
         {checkProjection(desc.projection), checkFilter(desc.filter), checkBoundary(desc.boundary)}) {
        if (!known.ok()) {
            return known;
        }
    }
    if (const char* control = missingFloatControl(context.floatControls);
        rowOf(desc.projection).certified && control != nullptr) {
        return Error{ErrorCode::Unsupported, 0,
                     std::string("the projection certified cannot be had by compute on this device: its "
                                 "VkPhysicalDeviceFloatControlsProperties do not report ") +
                         control + "; the host engine (voxtact/cpu.h) has it"};
    }
    VOXTACT_TRY(checkFact(factOf("count", "resolution"), desc.resolution));
    VOXTACT_TRY(checkSamples(desc.samplesPerVoxel));
    return checkOverestimate(context, desc);
}

/// What the pass itself refuses of a checked batch.
Result<void> checkPass(const AnyPass& any, const Batch& batch) {
    return std::visit(
        [&](const auto& pass) -> Result<void> {
            if constexpr (requires { pass.check(batch); }) {
                return pass.check(batch);
            } else {
                return {};
            }
        },
        any);
}

/// Rounds of the projection certified.
std::uint32_t roundsOf(const AnyPass& any, const Batch& batch, const ResultsImpl& results) {
    return std::visit(
        [&](const auto& pass) -> std::uint32_t {
            if constexpr (requires { pass.rounds(batch, results); }) {
                return pass.rounds(batch, results);
            } else {
                return 0;
            }
        },
        any);
}

template <class Pass>
Result<std::unique_ptr<DetectorImpl>> withPass(ContextImpl& context, const DetectorDesc& given, const PassDesc& desc) {
    Result<Pass> pass = Pass::create(context, desc);
    VOXTACT_TRY(pass);
    return std::make_unique<DetectorImpl>(
        DetectorImpl{.context = context, .given = given, .desc = desc, .pass = std::move(*pass)});
}

} // namespace

Detector::Detector(std::unique_ptr<DetectorImpl> impl) noexcept : impl_(std::move(impl)) {}
Detector::Detector(Detector&&) noexcept = default;
Detector& Detector::operator=(Detector&&) noexcept = default;
Detector::~Detector() = default;

Result<Detector> Detector::certified(const Context& context, const CertifiedDesc& desc) {
    return create(context.impl(), desc);
}

Result<Detector> Detector::raster(const Context& context, const RasterDesc& desc) {
    return create(context.impl(), desc);
}

Result<Detector> Detector::create(const Context& context, const DetectorDesc& desc) {
    return create(context.impl(), desc);
}

Result<Detector> Detector::create(ContextImpl& c, const DetectorDesc& given) {
    return guard([&]() -> Result<Detector> {
        VOXTACT_TRY(c.alive());
        const PassDesc desc = passDesc(given);
        VOXTACT_TRY(checkMethod(c, desc.method));
        VOXTACT_TRY(checkDesc(c, desc));
        const bool certified = rowOf(desc.projection).certified;
        if (certified && std::holds_alternative<RasterDesc>(given)) {
            return refuse("RasterDesc::projection is certified; make a certified detector with Detector::certified()");
        }
        VOXTACT_TRY(checkOutputs(c, desc));
        Result<std::unique_ptr<DetectorImpl>> impl = certified ? withPass<CertifiedPass>(c, given, desc)
                                                     : rowOf(desc.method).coverage == Coverage::Computed
                                                         ? withPass<ComputePass>(c, given, desc)
                                                         : withPass<ViewPass>(c, given, desc);
        VOXTACT_TRY(impl);
        if (desc.devicePoses) {
            Result<PairSetup> setup = PairSetup::create(c, desc);
            VOXTACT_TRY(setup);
            (*impl)->setup = *setup;
        }
        return Detector(std::move(*impl));
    });
}

Result<void> Detector::cmdDetect(VkCommandBuffer commandBuffer, const Batch& batch, Results& results) const {
    return guard([&]() -> Result<void> {
        ContextImpl& context = live(impl_).context;
        ResultsImpl& slot = results.impl();
        VOXTACT_TRY(context.recordable(commandBuffer));
        if (&slot.context != &context) {
            return refuse("the Results belong to another Context");
        }
        if (slot.certified != rowOf(live(impl_).desc.projection).certified) {
            return refuse(slot.certified ? "the Results are of a certified detector, and this one is not certified"
                                         : "the detector is certified, and the Results are not of a certified one");
        }
        const Result<std::uint32_t> pairs = checkBatch(context, live(impl_).desc, batch);
        VOXTACT_TRY(pairs);
        if (*pairs > slot.maxPairs) {
            return refuse("the batch has " + std::to_string(*pairs) + " pairs, the Results have room for " +
                          std::to_string(slot.maxPairs));
        }
        if (const std::uint64_t transforms = std::uint64_t{*pairs} * transformsPerPair(live(impl_).desc.projection);
            transforms > slot.maxTransforms) {
            return Error{ErrorCode::LimitExceeded, 0,
                         "the batch has " + std::to_string(*pairs) + " pairs, the Results have room for " +
                             std::to_string(slot.maxTransforms / (transforms / *pairs)) + " by the projection " +
                             toString(live(impl_).desc.projection) + " within the device's maxStorageBufferRange"};
        }
        VOXTACT_TRY(checkOutputs(context, batch, live(impl_).desc.outputs, slot));
        VOXTACT_TRY(checkPass(live(impl_).pass, batch));
        slot.pairs = *pairs;
        slot.detectRecorded = true;
        slot.readBackRecorded = false;
        slot.counted = live(impl_).desc.counters;
        if (slot.outputs) {
            slot.outputs->recorded = live(impl_).desc.outputs;
        }
        const Label label(context, commandBuffer, labelOf(live(impl_).desc, *pairs).c_str());
        if (*pairs == 0) {
            return {};
        }
        VOXTACT_TRY(prepareResults(context, commandBuffer, batch, slot, live(impl_).desc, live(impl_).setup,
                                   roundsOf(live(impl_).pass, batch, slot)));
        std::visit(
            [&](const auto& pass) {
                pass.record(commandBuffer, batch, slot,
                            [&](const BatchItem& item) { return boundaryFor(item, batch.threshold); });
            },
            live(impl_).pass);
        publishResults(context, commandBuffer, slot, live(impl_).desc);
        return {};
    });
}

const DetectorDesc& Detector::desc() const noexcept {
    return live(impl_).given;
}

Boundary Detector::boundaryFor(const BatchItem& item, double threshold) const noexcept {
    if (live(impl_).desc.boundary != Boundary::Auto) {
        return live(impl_).desc.boundary;
    }
    const VolumeImpl& volume = item.volume->impl();
    const TransferFunctionImpl& function = item.transferFunction->impl();
    if (!volume.boundary || function.table.empty()) {
        return Boundary::Range;
    }
    try {
        const OpaqueRanges opaque(function.table, function.known.domain, threshold,
                                  largestTerm(volume.valueIntercept, largestTexel(volume), function.known.domain));
        const bool anyOpaque =
            std::ranges::any_of(*volume.boundary, [&](const ValueRange& range) { return opaque.mayBeOpaque(range); });
        return anyOpaque ? Boundary::Range : Boundary::Clamp;
    } catch (const std::bad_alloc&) {
        return Boundary::Range;
    }
}

} // namespace voxtact
