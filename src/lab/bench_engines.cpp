// SPDX-License-Identifier: MIT
#include "lab/bench_engines.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace voxtact::app {

namespace {

constexpr const char* kYesNo = "yes/no";
constexpr const char* kCount = "count";

std::vector<EngineAnswer> answersOf(const BatchAnswer& batch) {
    std::vector<EngineAnswer> answers;
    answers.reserve(batch.pairs.size());
    std::ranges::transform(batch.pairs, std::back_inserter(answers), [](const PairAnswer& pair) {
        return EngineAnswer{pair.hit, pair.possible, pair.count};
    });
    return answers;
}

class HostEngine final : public Engine {
  public:
    HostEngine(EngineFacts facts, const BenchVolume& volume, const BenchMesh& mesh, cpu::Detector detector)
        : Engine(std::move(facts)), volume_(volume), mesh_(mesh), detector_(std::move(detector)) {}

    Result<std::vector<EngineAnswer>> run(std::span<const Mat4> poses) override {
        const cpu::BatchItem item{&mesh_.host, &volume_.host, &volume_.hostFunction, poses,
                                  volume_.labels.values.empty() ? nullptr : &volume_.labels};
        const Result<BatchAnswer> answer = detector_.detect({{&item, 1}, volume_.view, volume_.threshold});
        if (!answer.ok()) {
            return answer.error();
        }
        return answersOf(*answer);
    }

  private:
    const BenchVolume& volume_;
    const BenchMesh& mesh_;
    cpu::Detector detector_;
};

/// All poses in one submission that is waited for.
class DeviceEngine final : public Engine {
  public:
    DeviceEngine(EngineFacts facts, const BenchVolume& volume, const BenchMesh& mesh, BlockingDetector detector)
        : Engine(std::move(facts)), volume_(volume), mesh_(mesh), detector_(std::move(detector)) {}

    Result<std::vector<EngineAnswer>> run(std::span<const Mat4> poses) override {
        const BatchItem item{&*mesh_.device, &*volume_.device, &*volume_.deviceFunction, poses,
                             volume_.deviceLabels ? &*volume_.deviceLabels : nullptr};
        const Result<BatchAnswer> answer = detector_.detect({{&item, 1}, volume_.view, volume_.threshold});
        if (!answer.ok()) {
            return answer.error();
        }
        return answersOf(*answer);
    }

  private:
    const BenchVolume& volume_;
    const BenchMesh& mesh_;
    BlockingDetector detector_;
};

class FclEngine final : public Engine {
  public:
    FclEngine(EngineFacts facts, std::unique_ptr<FclPeer> peer) : Engine(std::move(facts)), peer_(std::move(peer)) {}

    Result<std::vector<EngineAnswer>> run(std::span<const Mat4> poses) override {
        std::vector<EngineAnswer> answers;
        answers.reserve(poses.size());
        for (const Mat4& pose : poses) {
            const bool hit = peer_->touches(pose);
            answers.push_back({hit, false, hit ? 1U : 0U});
        }
        return answers;
    }

  private:
    std::unique_ptr<FclPeer> peer_;
};

using Engines = std::vector<std::unique_ptr<Engine>>;

/// What an engine answers: the count, and the output beside it.
std::string questionOf(bool yesNo, const Outputs& outputs) {
    return yesNo               ? kYesNo
           : outputs.triangles ? "count, triangles"
           : outputs.bounds    ? "count, bounds"
           : outputs.labels    ? "count, labels"
           : outputs.contacts  ? "count, contacts"
                               : kCount;
}

Result<void> addHost(const BenchVolume& volume, const BenchMesh& mesh, const cpu::DetectorDesc& desc, Engines& engines,
                     std::size_t ratioTo = 0, bool sameCounts = false) {
    Result<cpu::Detector> detector = cpu::Detector::create(desc);
    if (!detector.ok()) {
        return detector.error();
    }
    EngineFacts facts{toString(CountingMethod::Cpu),
                      toString(desc.projection),
                      questionOf(desc.stopAtFirst, desc.outputs),
                      detector->threads(),
                      desc.projection == Projection::Conservative,
                      ratioTo,
                      sameCounts};
    engines.push_back(std::make_unique<HostEngine>(std::move(facts), volume, mesh, std::move(*detector)));
    return {};
}

Result<void> addDevice(const Session& session, const BenchVolume& volume, const BenchMesh& mesh,
                       const DetectorDesc& desc, Engines& engines, std::size_t ratioTo = 0, bool sameCounts = false) {
    Result<BlockingDetector> detector = BlockingDetector::create(session.context, desc, session.device.queueAccess());
    if (!detector.ok()) {
        return detector.error();
    }
    EngineFacts facts{toString(desc.method),
                      toString(desc.projection),
                      questionOf(desc.stopAtFirst, desc.outputs),
                      0,
                      desc.projection == Projection::Conservative,
                      ratioTo,
                      sameCounts};
    engines.push_back(std::make_unique<DeviceEngine>(std::move(facts), volume, mesh, std::move(*detector)));
    return {};
}

/// Those whose method the device can do.
Result<void> addDevices(const Session& session, const BenchVolume& volume, const BenchMesh& mesh, Engines& engines) {
    const DetectorDesc all{
        .method = CountingMethod::Compute, .projection = Projection::Conservative, .filter = Filter::Exact};
    DetectorDesc yesNo = all;
    yesNo.stopAtFirst = true;
    for (const DetectorDesc& desc : {yesNo, all, DetectorDesc{.method = CountingMethod::Query}}) {
        if (!session.context.supports(desc.method, desc.projection)) {
            continue;
        }
        if (Result<void> added = addDevice(session, volume, mesh, desc, engines); !added.ok()) {
            return added;
        }
    }
    return {};
}

void addFcl(const BenchVolume& volume, const BenchMesh& mesh, Engines& engines) {
    for (const FclScalar scalar : {FclScalar::Float, FclScalar::Double}) {
        const char* name = scalar == FclScalar::Float ? "fcl-float" : "fcl-double";
        engines.push_back(
            std::make_unique<FclEngine>(EngineFacts{name, "octree", kYesNo, 1, false},
                                        makeFclPeer(*volume.fcl, mesh.data.positions, mesh.data.indices, scalar)));
    }
}

constexpr std::array kOneOutput{Outputs{.triangles = true}, Outputs{.bounds = true}, Outputs{.labels = true},
                                Outputs{.contacts = true}};

/// Projections of the host, and then outputs in two of them.
Result<void> addHostOutputs(const BenchVolume& volume, const BenchMesh& mesh, Engines& engines) {
    constexpr std::array kOrder{Projection::View, Projection::Conservative, Projection::TwoView,
                                Projection::DominantAxis};
    for (const Projection projection : kOrder) {
        if (Result<void> added = addHost(volume, mesh, {.projection = projection}, engines); !added.ok()) {
            return added;
        }
    }
    for (std::size_t bare : {std::size_t{0}, std::size_t{1}}) {
        for (const Outputs& outputs : kOneOutput) {
            if (Result<void> added =
                    addHost(volume, mesh, {.projection = kOrder[bare], .outputs = outputs}, engines, bare, true);
                !added.ok()) {
                return added;
            }
        }
    }
    return {};
}

/// Projections of a method of the device, and then the outputs in one of them.
Result<void> addDeviceOutputs(const Session& session, const BenchVolume& volume, const BenchMesh& mesh,
                              CountingMethod method, Projection withOutputs, Engines& engines) {
    const std::size_t view = engines.size();
    std::size_t bare = view;
    for (const Projection projection : projections()) {
        if (!session.context.supports(method, projection)) {
            continue;
        }
        bare = projection == withOutputs ? engines.size() : bare;
        const DetectorDesc desc{.method = method, .projection = projection, .filter = defaultFilter(method)};
        if (Result<void> added = addDevice(session, volume, mesh, desc, engines, view); !added.ok()) {
            return added;
        }
    }
    for (const Outputs& outputs : kOneOutput) {
        const DetectorDesc desc{
            .method = method, .projection = withOutputs, .filter = defaultFilter(method), .outputs = outputs};
        if (Result<void> added = addDevice(session, volume, mesh, desc, engines, bare, true); !added.ok()) {
            return added;
        }
    }
    return {};
}

} // namespace

Result<void> uploadVolume(const Session& session, BenchVolume& volume) {
    const QueueAccess queue = session.device.queueAccess();
    Result<Volume> image = Volume::upload(session.context, queue, volume.data.view(), {.bricks = true});
    if (!image.ok()) {
        return image.error();
    }
    Result<TransferFunction> table =
        TransferFunction::upload(session.context, queue, {volume.points, volume.domain, volume.tableSize});
    if (!table.ok()) {
        return table.error();
    }
    if (!volume.labels.values.empty()) {
        Result<LabelMap> labels = LabelMap::upload(session.context, queue, volume.labels);
        if (!labels.ok()) {
            return labels.error();
        }
        volume.deviceLabels.emplace(std::move(*labels));
    }
    volume.device.emplace(std::move(*image));
    volume.deviceFunction.emplace(std::move(*table));
    return {};
}

Result<void> uploadMesh(const Session& session, BenchMesh& mesh) {
    Result<Mesh> device = Mesh::upload(session.context, session.device.queueAccess(), mesh.data.view(),
                                       {.name = mesh.data.name.c_str(), .clusters = true});
    if (!device.ok()) {
        return device.error();
    }
    mesh.device.emplace(std::move(*device));
    return {};
}

Result<Engines> makeEngines(const BenchVolume& volume, const BenchMesh& mesh, const Session* session) {
    constexpr Projection kCertified = Projection::Conservative;
    Engines engines;
    for (const cpu::DetectorDesc& desc :
         {cpu::DetectorDesc{.threads = 1, .stopAtFirst = true, .projection = kCertified},
          cpu::DetectorDesc{.projection = kCertified}, cpu::DetectorDesc{.stopAtFirst = true, .projection = kCertified},
          cpu::DetectorDesc{.projection = Projection::View}}) {
        if (Result<void> added = addHost(volume, mesh, desc, engines); !added.ok()) {
            return added.error();
        }
    }
    if (session != nullptr) {
        if (Result<void> added = addDevices(*session, volume, mesh, engines); !added.ok()) {
            return added.error();
        }
    }
    if (volume.fcl != nullptr) {
        addFcl(volume, mesh, engines);
    }
    return engines;
}

Result<Engines> makeOutputEngines(const BenchVolume& volume, const BenchMesh& mesh, const Session* session) {
    Engines engines;
    if (Result<void> added = addHostOutputs(volume, mesh, engines); !added.ok()) {
        return added.error();
    }
    constexpr std::pair<CountingMethod, Projection> kOfDevice[] = {
        {CountingMethod::Query, Projection::View},
        {CountingMethod::Atomic, Projection::View},
        {CountingMethod::Compute, Projection::Conservative},
    };
    for (const auto& [method, withOutputs] : kOfDevice) {
        if (session == nullptr || !session->context.supports(method, withOutputs)) {
            continue;
        }
        if (Result<void> added = addDeviceOutputs(*session, volume, mesh, method, withOutputs, engines); !added.ok()) {
            return added.error();
        }
    }
    return engines;
}

} // namespace voxtact::app
