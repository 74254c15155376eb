// SPDX-License-Identifier: MIT
#include "core/method/method_table.h"
#include "detect/outputs/output_parts.h"
#include "lab/bench/parts.h"

#include <algorithm>
#include <array>
#include <thread>

namespace voxtact::lab {

namespace {

/// Each output by itself.
std::vector<Outputs> oneOutput() {
    std::vector<Outputs> all;
    for (const OutputPartRow& part : outputParts()) {
        if (part.name != nullptr) {
            all.emplace_back().*part.output = true;
        }
    }
    return all;
}

/// The certified yes or no, the certified count, and the count in the view.
template <class Desc> std::array<Desc, 3> askedOf(const Desc& desc) {
    std::array<Desc, 3> asked{desc, desc, desc};
    asked[0].projection = asked[1].projection = Projection::Conservative;
    asked[0].stopAtFirst = true;
    asked[2].projection = Projection::View;
    return asked;
}

bool can(const device::Session* session, CountingMethod method, Projection projection) {
    return session != nullptr && session->context.supports(method, projection);
}

DetectorDesc methodOf(CountingMethod method) {
    return {.method = method, .filter = defaultFilter(method)};
}

/// Projections of the host, and then outputs in two of them.
void addHostOutputs(EngineList& engines) {
    constexpr std::array kOrder{Projection::View, Projection::Conservative, Projection::TwoView,
                                Projection::DominantAxis};
    for (const Projection projection : kOrder) {
        engines.add(makeHostEngine({.projection = projection}));
    }
    for (const std::size_t bare : {std::size_t{0}, std::size_t{1}}) {
        for (const Outputs& outputs : oneOutput()) {
            engines.add(makeHostEngine({.projection = kOrder.at(bare), .outputs = outputs}), bare, true);
        }
    }
}

/// Projections of a method of the device, and then the outputs in one of them.
void addDeviceOutputs(const device::Session& session, CountingMethod method, Projection withOutputs,
                      EngineList& engines) {
    DetectorDesc desc = methodOf(method);
    const std::size_t view = engines.size();
    std::size_t bare = view;
    for (const Projection projection : projections()) {
        if (can(&session, method, projection)) {
            bare = projection == withOutputs ? engines.size() : bare;
            desc.projection = projection;
            engines.add(makeBlockingEngine(session, desc), view);
        }
    }
    desc.projection = withOutputs;
    for (const Outputs& outputs : oneOutput()) {
        desc.outputs = outputs;
        engines.add(makeBlockingEngine(session, desc), bare, true);
    }
}

/// A method of the device, polled and waited for; nothing: an empty submission.
void addTicks(const device::Session& session, const std::optional<DetectorDesc>& desc, EngineList& engines) {
    for (const Awaiting awaiting : {Awaiting::Poll, Awaiting::Wait}) {
        engines.add(makeTickEngine(session, desc, awaiting));
    }
}

void addDeviceTicks(const device::Session& session, EngineList& engines) {
    for (const CountingMethod method : countingMethods()) {
        for (DetectorDesc desc : askedOf(methodOf(method))) {
            if (rowOf(method).host || !can(&session, method, desc.projection)) {
                continue;
            }
            addTicks(session, desc, engines);
            if (rowOf(method).coverage == Coverage::Computed) {
                desc.devicePoses = true;
                addTicks(session, desc, engines);
            }
        }
    }
}

} // namespace

void addCertified(const BenchParts& parts, EngineList& engines) {
    auto host = askedOf(cpu::DetectorDesc{});
    cpu::DetectorDesc alone = host[0];
    alone.threads = 1;
    for (const cpu::DetectorDesc& desc : {alone, host[1], host[0], host[2]}) {
        engines.add(makeHostEngine(desc));
    }
    const auto computed = askedOf(methodOf(CountingMethod::Compute));
    for (const DetectorDesc& desc : {computed[0], computed[1], methodOf(CountingMethod::Query)}) {
        if (can(parts.session, desc.method, desc.projection)) {
            engines.add(makeBlockingEngine(*parts.session, desc));
        }
    }
    for (const FclScalar scalar : {FclScalar::Float, FclScalar::Double}) {
        if (parts.volume.fcl != nullptr) {
            engines.add(makeFclEngine(parts.volume, parts.mesh, scalar));
        }
    }
}

void addOutputs(const BenchParts& parts, EngineList& engines) {
    addHostOutputs(engines);
    constexpr std::pair<CountingMethod, Projection> kOfDevice[] = {
        {CountingMethod::Query, Projection::View},
        {CountingMethod::Atomic, Projection::View},
        {CountingMethod::Compute, Projection::Conservative},
    };
    for (const auto& [method, withOutputs] : kOfDevice) {
        if (can(parts.session, method, withOutputs)) {
            addDeviceOutputs(*parts.session, method, withOutputs, engines);
        }
    }
}

void addLatency(const BenchParts& parts, EngineList& engines) {
    if (parts.session != nullptr) {
        addTicks(*parts.session, std::nullopt, engines);
    }
    const std::uint32_t threads = std::max(1U, std::thread::hardware_concurrency());
    for (cpu::DetectorDesc desc : askedOf(cpu::DetectorDesc{.threads = 1})) {
        engines.add(makeHostEngine(desc));
        if (threads > 1) {
            desc.threads = threads;
            engines.add(makeHostEngine(desc));
        }
    }
    if (parts.session != nullptr) {
        addDeviceTicks(*parts.session, engines);
    }
}

void addBatches(const BenchParts& parts, EngineList& engines) {
    const auto host = askedOf(cpu::DetectorDesc{});
    engines.add(makeHostEngine(host[0]));
    engines.add(makeHostEngine(host[2]));
    const auto computed = askedOf(methodOf(CountingMethod::Compute));
    for (const DetectorDesc& desc :
         {computed[0], computed[2], methodOf(CountingMethod::Query), methodOf(CountingMethod::Atomic)}) {
        if (can(parts.session, desc.method, desc.projection)) {
            engines.add(makeDeviceEngine(*parts.session, desc));
        }
    }
    for (DetectorDesc desc : {computed[0], computed[2]}) {
        desc.devicePoses = true;
        if (can(parts.session, desc.method, desc.projection)) {
            engines.add(makeBlockingEngine(*parts.session, desc));
        }
    }
}

} // namespace voxtact::lab
