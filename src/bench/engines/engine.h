// SPDX-License-Identifier: MIT
#pragma once

#include "bench/engines/scene.h"

namespace voxtact::lab {

struct EngineFacts {
    std::string name{};        ///< "cpu", "compute", "query", "fcl-float", "polygon"
    std::string projection{};  ///< "certified", "view"; "octree" for FCL
    std::string question{};    ///< "yes/no", "count", "count, labels"
    std::uint32_t threads = 1; ///< of the host; 0: the device's work
    bool certified = false;    ///< must answer as every other certified engine does
    std::size_t ratioTo = 0;   ///< number of the engine that its times are held against; not after it
    bool sameCounts = false;   ///< must count as that one does
    std::string recorded{};    ///< recording of the submission per pose: "each tick", "once"; empty: none
    std::string awaited{};     ///< of one: "polled", "waited"
    std::string posesOn{};     ///< of a batch on the device: "host", "device"

    [[nodiscard]] bool operator==(const EngineFacts&) const = default;
    /// "compute certified count"
    [[nodiscard]] std::string text() const { return name + " " + projection + " " + question; }
};

/// Pairs to answer: a mesh at poses against a volume. The parts must be ready for the engine.
struct Work {
    const VolumePart* volume = nullptr;
    const MeshPart* mesh = nullptr;
    std::span<const Mat4> poses;
    View view;

    Work() = default;
    Work(const VolumePart& of, const MeshPart& with, std::span<const Mat4> at, const View& seen)
        : volume(&of), mesh(&with), poses(at), view(seen) {}
    /// All of a scene, which must outlive it.
    explicit Work(const Scene& scene) : Work(*scene.volume, *scene.mesh, scene.poses, scene.view) {}

    /// For a detector of the device.
    [[nodiscard]] BatchItem onDevice() const;
    [[nodiscard]] Work at(std::span<const Mat4> others) const { return {*volume, *mesh, others, view}; }
};

/// Submission of the pairs of a work to an engine.
struct Feeding {
    std::uint32_t batch = 0;  ///< pairs per submission or call; 0: all
    std::uint32_t frames = 1; ///< submissions in flight; 1: each is waited for
};

/// The answers to a work.
struct Pass {
    double wallMilliseconds = 0;
    std::optional<double> gpuMilliseconds{};
    std::optional<double> recordMilliseconds{}; ///< of the wall's: recording, of an engine of ticks
    std::vector<PairAnswer> pairs{};            ///< in the order of the poses; none of an
                                                ///< engine that finds triangles
    std::vector<TouchedTriangle> triangles{};   ///< of an engine that finds them
    std::optional<std::uint64_t> queries{};     ///< that it took
    std::optional<std::uint64_t> boxes{};       ///< nodes of its tree that were tested

    [[nodiscard]] std::vector<std::uint64_t> counts() const;
};

/// An engine to compare. Copies share their implementation. Thread-safety: none; one thread at a time.
struct Engine {
    EngineFacts facts{};
    std::function<Result<Pass>(const Work& work, const Feeding& feeding)> run{};
};

using Engines = std::vector<Engine>;
using MadeEngine = Result<Engine>;

/// An engine of something that answers: `run(state, work, feeding)`.
template <class State, class Run> [[nodiscard]] Engine engineOf(EngineFacts facts, State state, Run run) {
    const auto shared = std::make_shared<State>(std::move(state)); // most cannot be copied
    return {std::move(facts),
            [shared, run](const Work& work, const Feeding& feeding) { return run(*shared, work, feeding); }};
}

/// Adds an engine, if it could be made. Its times are held against those of the engine of that number, and with
/// `sameCounts` its counts must be that one's.
[[nodiscard]] Result<void> add(Engines& engines, MadeEngine engine, std::size_t ratioTo = 0, bool sameCounts = false);

/// The question to an engine: yes or no, or the count and an additional output.
[[nodiscard]] std::string questionOf(bool yesNo, const Outputs& outputs);
/// Creates an engine of a method; threads are the host's, 0: the device.
template <class Desc>
[[nodiscard]] EngineFacts factsOf(CountingMethod method, const Desc& desc, std::uint32_t threads) {
    return {.name = toString(method),
            .projection = toString(desc.projection),
            .question = questionOf(desc.stopAtFirst, desc.outputs),
            .threads = threads,
            .certified = desc.projection == Projection::Certified};
}

/// The host.
[[nodiscard]] MadeEngine makeHostEngine(const Count& question = {}, std::uint32_t threads = 0);
/// Creates an engine of a device method; arguments must outlive it.
[[nodiscard]] MadeEngine makeDeviceEngine(const device::Session& session, const DetectorDesc& desc);
/// Like above, by BlockingDetector: all pairs in one submission, for any feeding. With devicePoses, writing the poses
/// as floats for the device is part of its time.
[[nodiscard]] MadeEngine makeBlockingEngine(const device::Session& session, const DetectorDesc& desc);
/// Wait of the host for the device.
enum class Awaiting {
    Poll, ///< it asks again and again
    Wait, ///< it sleeps until the driver wakes it
};
/// A method of the device as a loop that needs its answer now uses it: a submission a pose, of a command buffer that is
/// recorded each time, with Results of its own and no timestamps. With devicePoses it is recorded once,
/// for the first work that it gets, and the pose, as floats, is written into mapped memory. Without a method: with
/// nothing in the command buffer, which is recorded once, and without answers: what a submission costs. Whatever the
/// feeding; nothing is made while it runs.
[[nodiscard]] MadeEngine makeTickEngine(const device::Session& session, const std::optional<DetectorDesc>& desc,
                                        Awaiting awaiting);
/// FCL, for this mesh against the octree of this volume, which must be there.
[[nodiscard]] Engine makeFclEngine(const VolumePart& volume, const MeshPart& mesh, FclScalar scalar);
/// Returns the octree, or empty and a note with the reason. In both cases the note is about FCL.
[[nodiscard]] std::string makeOctree(VolumePart& volume);

/// The paper's ways to find the triangles that touch, one pose a run: an occlusion query a triangle, and two with one a
/// leaf of an OBB tree. For this volume and mesh, which are ready and must outlive them. `tolerance`: error of the
/// device's filter, in stored units.
[[nodiscard]] Result<Engines> makePolygonEngines(const device::Session& session, const VolumePart& volume,
                                                 const MeshPart& mesh, double tolerance);
/// Finds the same triangles by the fragments of one pass. Unsupported if the device cannot list them.
[[nodiscard]] MadeEngine makeFragmentEngine(const device::Session& session);

} // namespace voxtact::lab
