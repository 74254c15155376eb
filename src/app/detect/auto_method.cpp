// SPDX-License-Identifier: MIT
#include "app/detect/auto_method.h"

#include "app/detect/detect_run.h"
#include "app/detect/speed_cache.h"
#include "core/base/try.h"
#include "core/method/method_table.h"
#include "lab/engines/engine.h"
#include "voxtact/cpu.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <cmath>

namespace voxtact::app {

using namespace lab;

namespace {

/// What is remembered must be about the methods that the device has now.
bool describes(const std::vector<MethodSpeed>& speeds, const Context& context, bool host) {
    const auto methods = context.methods();
    if (speeds.size() != methods.size() + (host ? 1 : 0)) {
        return false;
    }
    return std::equal(methods.begin(), methods.end(), speeds.begin(),
                      [](const MethodSupport& has, const MethodSpeed& speed) {
                          return has.method == speed.verdict.method && has.available == speed.verdict.available;
                      }) &&
           (!host || rowOf(speeds.back().verdict.method).host);
}

Result<std::vector<MethodSpeed>> measureAll(const device::Session& session, std::optional<Filter> filter, bool host) {
    const Result<MeasureScene> scene = makeMeasureScene();
    VOXTACT_TRY(scene);
    MeasureDesc desc;
    desc.scene = &*scene;
    desc.filter = filter;
    Result<std::vector<MethodSpeed>> speeds = measureMethods(session.context, session.device.queueAccess(), desc);
    if (speeds.ok() && host) {
        speeds->push_back(measureHost(*scene, desc.repetitions));
    }
    return speeds;
}

bool fits(const VkExtent2D& size, const VkExtent2D& most) {
    return size.width <= most.width && size.height <= most.height;
}

bool isCandidate(const MethodSpeed& speed, const AutoLimits& limits, const VkExtent2D& maxViewport) {
    const MethodRow& row = rowOf(speed.verdict.method);
    const bool onHost = row.host;
    // The compute pass and the host share their rasteriser, and its guard band.
    const bool guarded = row.coverage == Coverage::Computed;
    return speed.verdict.trusted && (limits.host || !onHost) && (onHost || fits(limits.size, maxViewport)) &&
           (!guarded || fits(limits.size, {cpu::kMaxViewport, cpu::kMaxViewport}));
}

/// "1,900": two digits that mean something.
std::string rateText(double rate) {
    const double unit = rate < 1 ? 1 : std::pow(10, std::floor(std::log10(rate)) - 1);
    std::string text = std::to_string(std::llround(std::round(rate / unit) * unit));
    for (std::size_t at = text.size(); at > 3; at -= 3) {
        text.insert(at - 3, ",");
    }
    return text;
}

std::string choiceNote(const MeasuredMethods& measured, const AutoLimits& limits, CountingMethod chosen) {
    std::string first;
    std::string others;
    for (const MethodSpeed& speed : measured.speeds) {
        const std::string name = toString(speed.verdict.method);
        if (speed.verdict.method == chosen) {
            first = "auto chose " + name + ": " + rateText(speed.pairsPerSecond) + " pairs/s";
        } else if (!rowOf(speed.verdict.method).host || limits.host) {
            others += (others.empty() ? "; " : ", ") + name +
                      (speed.verdict.trusted     ? " " + rateText(speed.pairsPerSecond)
                       : speed.verdict.available ? " fails its self-test"
                                                 : " is not available");
        }
    }
    return first + others + " (measured on a small scene; --count fixes the method)";
}

} // namespace

Result<MeasuredMethods> measuredMethods(const device::Session& session, std::optional<Filter> filter,
                                        const DeviceChoice& choice) {
    const bool host = filter != Filter::Hardware;
    const CacheFolder folder(choice.cache);
    const SpeedCache cache(folder, session.device.physical(), filter);
    if (std::optional<std::vector<MethodSpeed>> known = cache.read();
        known && describes(*known, session.context, host)) {
        return MeasuredMethods{std::move(*known), false};
    }
    Result<std::vector<MethodSpeed>> speeds = measureAll(session, filter, host);
    VOXTACT_TRY(speeds);
    if (!choice.validate) {
        cache.write(*speeds);
    }
    return MeasuredMethods{std::move(*speeds), true};
}

std::optional<CountingMethod> fastest(std::span<const MethodSpeed> speeds, const AutoLimits& limits,
                                      const VkExtent2D& maxViewport) {
    const MethodSpeed* best = nullptr;
    const auto rank = [](const MethodSpeed& speed) {
        return std::pair(exactness(speed.verdict.method) == Exactness::Exact, speed.pairsPerSecond);
    };
    for (const MethodSpeed& speed : speeds) {
        if (isCandidate(speed, limits, maxViewport) && (best == nullptr || rank(speed) > rank(*best))) {
            best = &speed;
        }
    }
    return best == nullptr ? std::nullopt : std::optional(best->verdict.method);
}

Result<AutoChoice> autoMethod(const device::Session& session, const AutoLimits& limits, const DeviceChoice& choice) {
    const Result<MeasuredMethods> measured = measuredMethods(session, limits.filter, choice);
    VOXTACT_TRY(measured);
    const VkExtent2D most = session.context.maxViewport();
    const std::string device = "'" + session.device.physical().name + "'";
    const std::optional<CountingMethod> method = fastest(measured->speeds, limits, most);
    if (!method) {
        Result<void> viewport = checkViewport(limits.size, most, device);
        return viewport.ok() ? Error{ErrorCode::Unsupported, 0,
                                     "no counting method passes its self-test on " + device +
                                         ": see voxtact devices, and choose another device or driver"}
                             : viewport.error();
    }
    return AutoChoice{*method, measured->fresh ? choiceNote(*measured, limits, *method) : ""};
}

CountingMethod conservativeMethod(const device::Session& session, const AutoLimits& limits) {
    const VkPhysicalDeviceType type = session.device.physical().type;
    const bool gpu = type == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU || type == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU;
    const bool onDevice =
        !limits.host || (gpu && session.context.supports(CountingMethod::Compute, Projection::Conservative));
    return onDevice ? CountingMethod::Compute : CountingMethod::Cpu;
}

std::string noDeviceNote(const Error& reason) {
    return "auto chose cpu, the host: " + reason.text;
}

} // namespace voxtact::app
