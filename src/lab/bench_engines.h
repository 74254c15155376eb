// SPDX-License-Identifier: MIT
#pragma once

#include "lab/compare_scene.h"
#include "lab/fcl_peer.h"

#include <memory>
#include <optional>

namespace voxtact::app {

/// What an engine says of a pair.
struct EngineAnswer {
    bool hit = false;
    bool possible = false;
    std::uint64_t count = 0; ///< 0 or 1 where only yes or no was asked
};

struct EngineFacts {
    std::string name{};        ///< "cpu", "compute", "query", "fcl-float", "fcl-double"
    std::string projection{};  ///< "conservative", "view"; "octree" for FCL
    std::string question{};    ///< "yes/no", "count"
    std::uint32_t threads = 1; ///< of the host; 0: the device's work
    bool certified = false;    ///< must answer as every other certified engine does
    std::size_t ratioTo = 0;   ///< number of the engine that its times are held against; not after it
    bool sameCounts = false;   ///< must count as that one does
};

/// One way to answer for a mesh against a volume.
/// Thread-safety: none; one thread at a time.
class Engine {
  public:
    explicit Engine(EngineFacts facts) : facts_(std::move(facts)) {}
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;
    virtual ~Engine() = default;

    [[nodiscard]] const EngineFacts& facts() const noexcept { return facts_; }
    /// In the order of the poses.
    [[nodiscard]] virtual Result<std::vector<EngineAnswer>> run(std::span<const Mat4> poses) = 0;

  private:
    EngineFacts facts_;
};

/// The volume of a bench on both sides, and in FCL.
struct BenchVolume {
    VolumeData data;
    std::vector<ControlPoint> points;
    ValueRange domain;
    std::uint32_t tableSize = kDefaultTableSize;
    double threshold = kDefaultThreshold;
    View view; ///< for the projection `view`
    cpu::Volume host;
    cpu::TransferFunction hostFunction;
    std::optional<Volume> device;
    std::optional<TransferFunction> deviceFunction;
    std::shared_ptr<const FclVolume> fcl;
    LabelData labels{}; ///< for the mode --outputs: a label for each octant
    std::optional<LabelMap> deviceLabels{};
};

struct BenchMesh {
    std::string name;
    MeshData data;
    cpu::Mesh host;
    std::optional<Mesh> device;
};

/// Uploads what the engines of a device need.
[[nodiscard]] Result<void> uploadVolume(const Session& session, BenchVolume& volume);
[[nodiscard]] Result<void> uploadMesh(const Session& session, BenchMesh& mesh);

/// The engines that there are for this volume and mesh, which must outlive them. The first is the host's yes or no on
/// one thread, the second the host's count. `session` may be null: no engines of a device.
[[nodiscard]] Result<std::vector<std::unique_ptr<Engine>>> makeEngines(const BenchVolume& volume, const BenchMesh& mesh,
                                                                       const Session* session);

/// The projections, and the outputs beside the counts. The first is the host's count in the view, the second the host's
/// in the projection conservative. Otherwise as makeEngines().
[[nodiscard]] Result<std::vector<std::unique_ptr<Engine>>>
makeOutputEngines(const BenchVolume& volume, const BenchMesh& mesh, const Session* session);

} // namespace voxtact::app
