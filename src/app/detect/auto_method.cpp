// SPDX-License-Identifier: MIT
#include "app/detect/auto_method.h"

#include "app/detect/certified_speed.h"
#include "app/detect/detect_run.h"
#include "app/detect/speed_cache.h"
#include "core/base/try.h"
#include "core/method/method_table.h"
#include "lab/engines/engine.h"
#include "voxtact/cpu.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <cmath>
#include <thread>

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

/// The two that measureCertified() measures.
bool describeCertified(const std::vector<MethodSpeed>& speeds) {
    return speeds.size() == 2 && speeds.front().verdict.method == CountingMethod::Compute &&
           speeds.front().verdict.available && speeds.back().verdict.method == CountingMethod::Cpu;
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

/// What is remembered of `measured`, if it `describes` what is here; else `measure`, remembered unless Vulkan is
/// validated, which is slow.
template <class Describes, class Measure>
Result<MeasuredMethods> remembered(const device::Session& session, const DeviceChoice& choice,
                                   const std::string& measured, const Describes& describes, const Measure& measure) {
    const CacheFolder folder(choice.cache);
    const SpeedCache cache(folder, session.device.physical(), measured);
    if (std::optional<std::vector<MethodSpeed>> known = cache.read(); known && describes(*known)) {
        return MeasuredMethods{std::move(*known), false};
    }
    Result<std::vector<MethodSpeed>> speeds = measure();
    VOXTACT_TRY(speeds);
    if (!choice.validate) {
        cache.write(*speeds);
    }
    return MeasuredMethods{std::move(*speeds), true};
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
            const double rate = speed.pairsPerSecond; // none where the others could not be measured
            first = "auto chose " + name + (rate > 0 ? ": " + rateText(rate) + " pairs/s" : "");
        } else if (!rowOf(speed.verdict.method).host || limits.host) {
            others += (others.empty() ? "; " : ", ") + name +
                      (speed.verdict.trusted     ? " " + rateText(speed.pairsPerSecond)
                       : speed.verdict.available ? " is not trusted (" + speed.verdict.text + ")"
                                                 : " is not available");
        }
    }
    return first + others + " (measured on a small scene; --count fixes the method)";
}

/// How much of the host's processors so many threads have; 0: all.
double hostShare(std::uint32_t threads) {
    const std::uint32_t processors = std::max(std::thread::hardware_concurrency(), 1U);
    return threads == 0 ? 1 : std::min(1.0, static_cast<double>(threads) / processors);
}

} // namespace

Result<MeasuredMethods> measuredMethods(const device::Session& session, std::optional<Filter> filter,
                                        const DeviceChoice& choice) {
    const bool host = filter != Filter::Hardware;
    return remembered(
        session, choice, filter ? toString(*filter) : "default",
        [&](const std::vector<MethodSpeed>& known) { return describes(known, session.context, host); },
        [&] { return measureAll(session, filter, host); });
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

bool isCertifyingGpu(const device::Session& session) {
    return session.device.physical().type != VK_PHYSICAL_DEVICE_TYPE_CPU &&
           session.context.supports(CountingMethod::Compute, Projection::Conservative);
}

Result<AutoChoice> certifiedMethod(const device::Session& session, const AutoLimits& limits, const CertifiedAsk& ask,
                                   const DeviceChoice& choice) {
    if (!limits.host) {
        return AutoChoice{CountingMethod::Compute, {}};
    }
    if (!isCertifyingGpu(session)) {
        return AutoChoice{CountingMethod::Cpu, {}};
    }
    if (!ask.measure) {
        return AutoChoice{CountingMethod::Compute, {}};
    }
    Result<MeasuredMethods> measured =
        remembered(session, choice, ask.yesNo ? "conservative-yes-no" : "conservative", describeCertified,
                   [&] { return measureCertified(session, ask.yesNo); });
    if (!measured.ok()) {
        return AutoChoice{CountingMethod::Cpu, noDeviceNote(measured.error())};
    }
    double& host = measured->speeds.back().pairsPerSecond;
    host *= hostShare(ask.threads);
    const CountingMethod method = fastest(measured->speeds, {}, {1, 1}).value_or(CountingMethod::Cpu);
    return AutoChoice{method, measured->fresh ? choiceNote(*measured, limits, method) : ""};
}

std::string noDeviceNote(const Error& reason) {
    return "auto chose cpu, the host: " + reason.text;
}

} // namespace voxtact::app
