// SPDX-License-Identifier: MIT
#include "lab/paper_sweeps.h"

#include "lab/compare_timing.h"
#include "lab/paper_integration.h"
#include "lab/paper_scenes.h"

#include <algorithm>
#include <array>

namespace voxtact::app {

namespace {

constexpr const char* kMesh = "builtin:scalpel";
/// Of the sweep of voxels, and its voxels a side: half to twice as many are 128 to 512.
constexpr const char* kVolume = "builtin:head";
constexpr std::uint32_t kVoxels = 256;
constexpr std::array<ControlPoint, 2> kOpacity{{{40, 0}, {80, 1}}};
constexpr ValueRange kDomain{0, 255};
/// Of those of the scene: a query a polygon takes its time.
constexpr std::uint32_t kPolygonPoses = 4;
/// For the samples of a sweep.
constexpr double kSeconds = 15;

CompareSettings settingsFor(const PaperSettings& settings) {
    CompareSettings out;
    out.repeats = settings.repetitions;
    out.timeLimit = kSeconds;
    out.load = settings.load;
    return out;
}

/// The builtin head with the mesh and the viewport of the scene.
Result<CompareData> headOf(const PaperSettings& settings, const CompareData& v1s1) {
    CompareData data;
    data.volumeName = std::string(kVolume) + ":" + std::to_string(kVoxels / settings.scale);
    data.meshName = kMesh;
    Result<VolumeData> volume = settings.load.volume(data.volumeName);
    if (!volume.ok()) {
        return volume.error();
    }
    Result<MeshData> mesh = settings.load.mesh(data.meshName);
    if (!mesh.ok()) {
        return mesh.error();
    }
    data.volume = std::move(*volume);
    data.mesh = std::move(*mesh);
    data.points = {kOpacity.begin(), kOpacity.end()};
    data.domain = kDomain;
    data.view = {framingCamera(data.volume.grid, v1s1.view.width, v1s1.view.height), v1s1.view.width, v1s1.view.height};
    const auto poses = static_cast<std::uint32_t>(v1s1.poses.size());
    if (Result<void> chosen = chooseTouching(poses, settings.seed, kVolume, data); !chosen.ok()) {
        return chosen.error();
    }
    return data;
}

/// What is timed, and on what.
struct Swept {
    const Session& session;
    const PaperSettings& paper;
    const CompareSettings& settings;
    const CompareData& data;
    const Subject& subject;
    const Runners& runners;
    const std::function<void()>& step;
};

/// Counts every pose, and where the methods agree times them.
Result<void> timeScene(const Swept& swept, CompareResult& result) {
    const Work work{&swept.subject, swept.data.poses, swept.data.view};
    Result<std::vector<NamedCounts>> counts = countAll(swept.runners, work);
    if (!counts.ok()) {
        return counts.error();
    }
    result.verdicts = judgeCounts(*counts, swept.data.poseNumbers);
    swept.step();
    if (result.firstFailure() != nullptr) {
        return {};
    }
    if (Result<void> done = timeBatches(swept.settings, swept.runners, work, result, swept.step); !done.ok()) {
        return done;
    }
    if (Result<void> done = timeTriangles(swept.session, swept.settings, swept.data, swept.runners, result, swept.step);
        !done.ok() || result.firstFailure() != nullptr) {
        return done;
    }
    return timeFragments(swept.session, swept.settings, swept.data, swept.subject, swept.runners, result, swept.step);
}

Result<void> timeAll(const Swept& swept, CompareResult& result) {
    if (Result<void> done = timeScene(swept, result); !done.ok() || result.firstFailure() != nullptr) {
        return done;
    }
    const Result<CompareData> head = headOf(swept.paper, swept.data);
    if (!head.ok()) {
        return head.error();
    }
    return timeVoxels(swept.session, swept.settings, *head, swept.subject, swept.runners, result, swept.step);
}

/// The sweeps, as `voxtact compare` makes them.
Result<void> sweep(const Session& session, const PaperSettings& paper, const CompareSettings& settings,
                   const CompareData& v1s1, PaperResult& result, const std::function<void()>& step) {
    const Result<Surroundings> surroundings = makeSurroundings(session, v1s1.volume.view(), v1s1.transferFunction());
    if (!surroundings.ok()) {
        return surroundings.error();
    }
    const Result<Subject> subject = makeSubject(session, v1s1.mesh);
    if (!subject.ok()) {
        return subject.error();
    }
    CompareResult compared;
    const Result<Runners> runners = makeRunners(session, settings, *surroundings, v1s1.threshold, compared);
    if (!runners.ok()) {
        return runners.error();
    }
    if (Result<void> done = timeAll({session, paper, settings, v1s1, *subject, *runners, step}, compared); !done.ok()) {
        return done;
    }
    if (const Verdict* failure = compared.firstFailure(); failure != nullptr && result.disagreement.empty()) {
        result.disagreement = failure->rule + ": disagreement on pose " + std::to_string(failure->first->pose) + ": " +
                              failure->first->text;
    }
    result.series = std::move(compared.series);
    result.notes.insert(result.notes.end(), compared.notes.begin(), compared.notes.end());
    return {};
}

/// Which triangles touch, on a few poses.
Result<void> findPolygons(const Session& session, const CompareSettings& settings, const CompareData& v1s1,
                          PaperResult& result, const std::function<void()>& step) {
    CompareData few = v1s1;
    few.poses.clear();
    few.poseNumbers.clear();
    for (const std::uint32_t index : spreadEvenly(kPolygonPoses, static_cast<std::uint32_t>(v1s1.poses.size()))) {
        few.poses.push_back(v1s1.poses[index]);
        few.poseNumbers.push_back(v1s1.poseNumbers[index]);
    }
    LocalizeResult found;
    found.machine = result.machine;
    if (Result<void> done = localize(session, settings, few, found, step); !done.ok()) {
        return done;
    }
    if (result.disagreement.empty()) {
        result.disagreement = disagreementOf(found);
    }
    result.polygons = std::move(found.ways);
    result.polygonTriangles = found.triangles;
    result.polygonPoses = static_cast<std::uint32_t>(found.poseNumbers.size());
    result.notes.insert(result.notes.end(), found.notes.begin(), found.notes.end());
    return {};
}

} // namespace

std::uint64_t paperSweepSteps(const PaperSettings& settings) {
    std::uint64_t steps = 1;
    for (const Sweep sweep : kSweeps) {
        steps += stepsOf(sweep, settings.repetitions);
    }
    const std::uint64_t poses = std::min(kPolygonPoses, settings.poses);
    return steps + poses * settings.repetitions + settings.repetitions + 1;
}

Result<void> runPaperSweeps(const Session& session, const PaperSettings& settings, const CompareData& v1s1,
                            PaperResult& result, const std::function<void()>& step) {
    const CompareSettings how = settingsFor(settings);
    if (Result<void> done = sweep(session, settings, how, v1s1, result, step);
        !done.ok() || !result.disagreement.empty()) {
        return done;
    }
    if (Result<void> done = findPolygons(session, how, v1s1, result, step);
        !done.ok() || !result.disagreement.empty()) {
        return done;
    }
    Result<std::vector<IntegrationPoint>> integration = timeIntegration(session, settings.repetitions, step);
    if (!integration.ok()) {
        return integration.error();
    }
    result.integration = std::move(*integration);
    return {};
}

} // namespace voxtact::app
