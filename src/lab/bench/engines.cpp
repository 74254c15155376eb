// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "core/method/method_table.h"
#include "lab/bench/latency.h"

#include <array>
#include <thread>

namespace voxtact::lab {

namespace {

/// Adds an engine, or says why it could not be made.
Result<void> add(MadeEngine engine, Engines& engines, std::size_t ratioTo = 0, bool sameCounts = false) {
    VOXTACT_TRY(engine);
    (*engine)->holdAgainst(ratioTo, sameCounts);
    engines.push_back(std::move(*engine));
    return {};
}

constexpr std::array kOneOutput{Outputs{.triangles = true}, Outputs{.bounds = true}, Outputs{.labels = true},
                                Outputs{.contacts = true}};

/// Projections of the host, and then outputs in two of them.
Result<void> addHostOutputs(Engines& engines) {
    constexpr std::array kOrder{Projection::View, Projection::Conservative, Projection::TwoView,
                                Projection::DominantAxis};
    for (const Projection projection : kOrder) {
        VOXTACT_TRY(add(makeHostEngine({.projection = projection}), engines));
    }
    for (const std::size_t bare : {std::size_t{0}, std::size_t{1}}) {
        for (const Outputs& outputs : kOneOutput) {
            MadeEngine engine = makeHostEngine({.projection = kOrder.at(bare), .outputs = outputs});
            VOXTACT_TRY(add(std::move(engine), engines, bare, true));
        }
    }
    return {};
}

/// Projections of a method of the device, and then the outputs in one of them.
Result<void> addDeviceOutputs(const device::Session& session, CountingMethod method, Projection withOutputs,
                              Engines& engines) {
    DetectorDesc desc{.method = method, .filter = defaultFilter(method)};
    const std::size_t view = engines.size();
    std::size_t bare = view;
    for (const Projection projection : projections()) {
        if (!session.context.supports(method, projection)) {
            continue;
        }
        bare = projection == withOutputs ? engines.size() : bare;
        desc.projection = projection;
        VOXTACT_TRY(add(makeBlockingEngine(session, desc), engines, view));
    }
    desc.projection = withOutputs;
    for (const Outputs& outputs : kOneOutput) {
        desc.outputs = outputs;
        VOXTACT_TRY(add(makeBlockingEngine(session, desc), engines, bare, true));
    }
    return {};
}

Result<void> addCertified(const VolumePart& volume, const MeshPart& mesh, const device::Session* session,
                          Engines& engines) {
    constexpr Projection kCertified = Projection::Conservative;
    for (const cpu::DetectorDesc& desc :
         {cpu::DetectorDesc{.threads = 1, .stopAtFirst = true, .projection = kCertified},
          cpu::DetectorDesc{.projection = kCertified}, cpu::DetectorDesc{.stopAtFirst = true, .projection = kCertified},
          cpu::DetectorDesc{.projection = Projection::View}}) {
        VOXTACT_TRY(add(makeHostEngine(desc), engines));
    }
    const DetectorDesc all{.method = CountingMethod::Compute, .projection = kCertified, .filter = Filter::Exact};
    DetectorDesc yesNo = all;
    yesNo.stopAtFirst = true;
    for (const DetectorDesc& desc : {yesNo, all, DetectorDesc{.method = CountingMethod::Query}}) {
        if (session == nullptr || !session->context.supports(desc.method, desc.projection)) {
            continue;
        }
        VOXTACT_TRY(add(makeBlockingEngine(*session, desc), engines));
    }
    for (const FclScalar scalar : {FclScalar::Float, FclScalar::Double}) {
        if (volume.fcl != nullptr) {
            engines.push_back(makeFclEngine(volume, mesh, scalar));
        }
    }
    return {};
}

Result<void> addOutputs(const device::Session* session, Engines& engines) {
    VOXTACT_TRY(addHostOutputs(engines));
    constexpr std::pair<CountingMethod, Projection> kOfDevice[] = {
        {CountingMethod::Query, Projection::View},
        {CountingMethod::Atomic, Projection::View},
        {CountingMethod::Compute, Projection::Conservative},
    };
    for (const auto& [method, withOutputs] : kOfDevice) {
        if (session == nullptr || !session->context.supports(method, withOutputs)) {
            continue;
        }
        VOXTACT_TRY(addDeviceOutputs(*session, method, withOutputs, engines));
    }
    return {};
}

/// A method of the device, polled and waited for.
Result<void> addTicks(const device::Session& session, const DetectorDesc& desc, Engines& engines) {
    for (const Awaiting awaiting : {Awaiting::Poll, Awaiting::Wait}) {
        VOXTACT_TRY(add(makeTickEngine(session, desc, awaiting), engines));
    }
    return {};
}

/// The certified questions that need no output, and the count in the view.
template <class Desc> std::array<Desc, 3> askedOf(const Desc& desc) {
    std::array<Desc, 3> asked{desc, desc, desc};
    asked[0].projection = Projection::Conservative;
    asked[0].stopAtFirst = true;
    asked[1].projection = Projection::Conservative;
    asked[2].projection = Projection::View;
    return asked;
}

Result<void> addDeviceTicks(const device::Session& session, Engines& engines) {
    for (const CountingMethod method : availableMethods(session, [](CountingMethod, const std::string&) {})) {
        if (rowOf(method).host) {
            continue;
        }
        for (const DetectorDesc& desc : askedOf(DetectorDesc{.method = method, .filter = defaultFilter(method)})) {
            if (!session.context.supports(method, desc.projection)) {
                continue;
            }
            VOXTACT_TRY(addTicks(session, desc, engines));
            if (rowOf(method).coverage == Coverage::Computed) {
                DetectorDesc once = desc;
                once.devicePoses = true;
                VOXTACT_TRY(addTicks(session, once, engines));
            }
        }
    }
    return {};
}

} // namespace

Result<Engines> makeLatencyEngines(const device::Session* session) {
    Engines engines;
    if (session != nullptr) {
        for (const Awaiting awaiting : {Awaiting::Poll, Awaiting::Wait}) {
            VOXTACT_TRY(add(makeEmptyEngine(*session, awaiting), engines));
        }
    }
    const std::uint32_t threads = std::max(1U, std::thread::hardware_concurrency());
    for (const cpu::DetectorDesc& desc : askedOf(cpu::DetectorDesc{.threads = 1})) {
        VOXTACT_TRY(add(makeHostEngine(desc), engines));
        if (threads > 1) {
            cpu::DetectorDesc all = desc;
            all.threads = threads;
            VOXTACT_TRY(add(makeHostEngine(all), engines));
        }
    }
    if (session != nullptr) {
        VOXTACT_TRY(addDeviceTicks(*session, engines));
    }
    return engines;
}

Result<Engines> makeBenchEngines(BenchMode mode, const VolumePart& volume, const MeshPart& mesh,
                                 const device::Session* session) {
    Engines engines;
    const Result<void> added =
        mode == BenchMode::Outputs ? addOutputs(session, engines) : addCertified(volume, mesh, session, engines);
    return added.ok() ? Result<Engines>(std::move(engines)) : added.error();
}

} // namespace voxtact::lab
