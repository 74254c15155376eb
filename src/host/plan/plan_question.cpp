// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "host/host_engine.h"
#include "host/plan/entry_surface.h"
#include "host/plan/patch_certificate.h"
#include "host/plan/path_measure.h"
#include "host/plan/plan_check.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

/// mm: a smaller margin is taken for as much.
constexpr double kLeastMargin = 1e-6;
/// Relative to the largest coordinate, mm: the rounding of a path's few dozen operations.
constexpr double kSlackOfMagnitude = 0x1p-44;
/// Directions of a piece of work.
constexpr std::uint32_t kBlock = 16;

std::vector<Obstacle> obstaclesOf(const Plan& task, Workers& workers) {
    std::vector<Obstacle> out;
    for (const PlanObstacle& given : task.obstacles) {
        Obstacle one;
        one.given = &given;
        const VolumeImpl& volume = given.volume->impl();
        one.part = given.transferFunction != nullptr
                       ? workers.part(volume, given.transferFunction->impl(), given.threshold)
                       : workers.whole(volume);
        if (given.labels != nullptr) {
            std::vector<std::uint32_t> indices;
            const auto& values = given.labels->values;
            for (const std::int32_t label : given.avoid) {
                const auto found = std::lower_bound(values.begin(), values.end(), label);
                if (found != values.end() && *found == label) {
                    indices.push_back(static_cast<std::uint32_t>(found - values.begin()));
                }
            }
            one.labels = allLabels(*one.part, volume, *given.labels, indices);
        }
        out.push_back(std::move(one));
    }
    return out;
}

Result<Mesh> axisMesh() {
    const std::vector<double> positions{0, 0, 0, 0, 0, 1, 0, 0, 0.5};
    const std::vector<std::uint32_t> indices{0, 1, 2};
    return Mesh::create({positions, indices});
}

double largestLength(const PlanScene& scene) {
    double longest = 0;
    for (const EntryPoint& entry : scene.entries) {
        longest = std::max(longest, entry.length);
    }
    return longest;
}

/// Upper bound of the moving object's coordinates and their terms, mm.
double magnitudeOf(const PlanScene& scene) {
    const Plan& task = scene.task;
    double sum = std::abs(task.target[0]) + std::abs(task.target[1]) + std::abs(task.target[2]);
    sum += 2 * largestLength(scene) + task.needle.length;
    if (task.mesh) {
        const Box& box = task.mesh->mesh->facts().bounds;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sum += 2 * (std::abs(box.lo[axis]) + std::abs(box.hi[axis]) + std::abs(task.mesh->tip[axis]));
        }
    }
    return sum;
}

/// The paths of some directions, in their order.
struct Row {
    std::vector<PlannedPath*> paths;
};

/// Rows of neighbours: the nearest obstacle of one path is a good start for the next.
std::vector<Row> rowsOf(const PlanScene& scene, std::vector<PlannedPath>& paths) {
    std::vector<Row> rows(1);
    std::uint32_t last = 0;
    for (PlannedPath& path : paths) {
        const std::uint32_t row = path.entry < 2 ? 0 : 1 + (path.entry - 2) / scene.grid.side();
        if (row != last) {
            rows.emplace_back();
            last = row;
        }
        rows.back().paths.push_back(&path);
    }
    return rows;
}

Result<void> measurePaths(const PlanScene& scene, Workers& workers, PlanAnswer& answer) {
    for (const EntryPoint& entry : scene.entries) {
        if (entry.isThere) {
            answer.paths.emplace_back();
            answer.paths.back().entry = entry.number;
        }
    }
    std::vector<Row> rows = rowsOf(scene, answer.paths);
    return workers.forEach(rows, scene.cancel, [&](Row& row, ThreadMemory& memory) {
        PathMeasure measure(scene, memory);
        for (PlannedPath* path : row.paths) {
            if (scene.givenUp()) {
                return;
            }
            measure.run(scene.entries[path->entry], *path);
        }
    });
}

double areaOf(const PlanScene& scene, const std::array<std::uint32_t, 3>& corners) {
    const dvec3 a = scene.entries[corners[0]].position;
    return 0.5 *
           glm::length(glm::cross(scene.entries[corners[1]].position - a, scene.entries[corners[2]].position - a));
}

Result<void> certifyTriangles(const PlanScene& scene, Workers& workers, PlanAnswer& answer) {
    std::vector<const PlannedPath*> byNumber(scene.grid.count());
    std::vector<std::uint32_t> placeOf(scene.grid.count());
    for (std::size_t i = 0; i < answer.paths.size(); ++i) {
        byNumber[answer.paths[i].entry] = &answer.paths[i];
        placeOf[answer.paths[i].entry] = static_cast<std::uint32_t>(i);
    }
    TrianglePlaces places(scene.grid);
    std::vector<double> areas;
    forEntryTriangles(scene, [&](std::uint32_t rhombus, std::uint32_t i, std::uint32_t j, std::uint32_t which,
                                 const std::array<std::uint32_t, 3>& corners) {
        places.at(rhombus, i, j, which) = static_cast<std::uint32_t>(answer.triangles.size());
        answer.triangles.push_back({{placeOf[corners[0]], placeOf[corners[1]], placeOf[corners[2]]}, false});
        areas.push_back(areaOf(scene, corners));
    });
    std::vector<DirectionPatch> blocks;
    const std::uint32_t side = scene.grid.side();
    for (std::uint32_t rhombus = 0; rhombus < DirectionGrid::kRhombi && !scene.task.mesh; ++rhombus) {
        for (std::uint32_t i = 0; i < side; i += kBlock) {
            for (std::uint32_t j = 0; j < side; j += kBlock) {
                blocks.push_back({rhombus, {i, j}, {std::min(i + kBlock, side), std::min(j + kBlock, side)}});
            }
        }
    }
    VOXTACT_TRY(workers.forEach(blocks, scene.cancel, [&](DirectionPatch& block, ThreadMemory& memory) {
        PatchCertificate(scene, byNumber, places, memory).run(block, answer.triangles);
    }));
    for (std::size_t i = 0; i < areas.size(); ++i) {
        answer.area += areas[i];
        answer.safeArea += answer.triangles[i].safe ? areas[i] : 0;
    }
    return {};
}

Error noEntries(const PlanAnswer& answer) {
    const std::string all = std::to_string(answer.directions);
    if (answer.noSurface == answer.directions) {
        return refuse("none of " + all +
                      " directions from the target meets the surface of entries: there is none around it");
    }
    return refuse("no entry is left of " + all + " directions: " + std::to_string(answer.noSurface) +
                  " meet no surface, " + std::to_string(answer.onBorder) + " enter where the image ends, " +
                  std::to_string(answer.tooLong) + " are too long, " + std::to_string(answer.tooOblique) +
                  " too oblique; allow more" + (answer.onBorder > 0 ? ", border entries among them" : ""));
}

} // namespace

Result<PlanAnswer> HostEngine::ask(const Plan& question) {
    return guard([&]() -> Result<PlanAnswer> {
        const StopWatch watch;
        VOXTACT_TRY(checkPlan(question));
        const Cancellation cancel(question.cancel);
        VOXTACT_TRY(checkNotCancelled(cancel));
        Result<Mesh> axis = axisMesh();
        VOXTACT_TRY(axis);
        Workers& workers = impl_->workers;
        PlanScene scene{
            question, cancel,          DirectionGrid(question.surface.entries), obstaclesOf(question, workers),
            {},       std::move(*axis)};
        scene.radius = question.mesh ? 0 : 0.5 * question.needle.diameter;
        scene.margin = std::max(question.margin, kLeastMargin);
        PlanAnswer answer;
        VOXTACT_TRY(findEntries(scene, workers, answer));
        if (answer.noSurface + answer.onBorder + answer.tooLong + answer.tooOblique == answer.directions) {
            return noEntries(answer);
        }
        scene.slack = kSlackOfMagnitude * magnitudeOf(scene);
        VOXTACT_TRY(measurePaths(scene, workers, answer));
        VOXTACT_TRY(certifyTriangles(scene, workers, answer));
        answer.wallMilliseconds = watch.milliseconds();
        return answer;
    });
}

} // namespace voxtact::cpu
