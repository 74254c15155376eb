// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "cpu/certified/brick_occupancy.h"
#include "lab/engines/engine.h"
#include "lab/engines/localize.h"
#include "lab/engines/trace.h"
#include "lab/measure/stopwatch.h"

#include <array>

namespace voxtact::lab {

namespace {

/// What the ways share.
struct PolygonParts {
    Localizer localizer;
    ObbTree tree;
    cpu::BrickOccupancy bricks;
    bool timed = false;
};

class PolygonEngine final : public Engine {
  public:
    PolygonEngine(Localization way, std::shared_ptr<PolygonParts> parts)
        : Engine({.name = toString(way), .projection = toString(Projection::View), .threads = 0}), way_(way),
          parts_(std::move(parts)) {}

    Result<Pass> run(const Work& work, const Feeding& /*feeding*/) override {
        const BatchItem item = work.onDevice();
        const LocalizeAids aids{&parts_->tree, [this](const Box& box) { return parts_->bricks.mayBeOpaque(box); }};
        Result<LocalizedTriangles> answer =
            parts_->localizer.triangles({{&item, 1}, work.view, work.volume->threshold}, way_, aids);
        VOXTACT_TRY(answer);
        Pass pass{.wallMilliseconds = answer->wallMilliseconds, .triangles = std::move(answer->triangles)};
        pass.queries = answer->queries;
        if (way_ != Localization::Polygon) {
            pass.boxes = answer->boxes;
        }
        if (parts_->timed) {
            pass.gpuMilliseconds = answer->gpuMilliseconds;
        }
        return pass;
    }

  private:
    Localization way_;
    std::shared_ptr<PolygonParts> parts_;
};

class FragmentEngine final : public Engine {
  public:
    explicit FragmentEngine(FragmentTrace trace)
        : Engine({.name = "fragments", .projection = toString(Projection::View), .threads = 0}),
          trace_(std::move(trace)) {}

    Result<Pass> run(const Work& work, const Feeding& /*feeding*/) override {
        const Stopwatch watch;
        const BatchItem item = work.onDevice();
        const Result<std::vector<shader::TracedFragment>> fragments =
            trace_.survivors({{&item, 1}, work.view, work.volume->threshold});
        VOXTACT_TRY(fragments);
        Pass pass;
        for (const shader::TracedFragment& fragment : *fragments) {
            if (pass.triangles.empty() || pass.triangles.back().triangle != fragment.triangle) {
                pass.triangles.push_back({0, fragment.triangle, 0});
            }
            ++pass.triangles.back().count;
        }
        pass.wallMilliseconds = watch.milliseconds();
        return pass;
    }

  private:
    FragmentTrace trace_;
};

} // namespace

Result<Engines> makePolygonEngines(const device::Session& session, const VolumePart& volume, const MeshPart& mesh,
                                   double tolerance) {
    Result<Localizer> localizer = Localizer::create(session.context, Filter::Hardware, session.device.queueAccess());
    VOXTACT_TRY(localizer);
    const auto parts = std::make_shared<PolygonParts>(
        PolygonParts{std::move(*localizer), makeObbTree(mesh.data.view()),
                     cpu::BrickOccupancy(*volume.host, *volume.hostFunction, volume.threshold, tolerance),
                     session.device.hasTimestamps()});
    Engines engines;
    for (const Localization way : {Localization::Polygon, Localization::Leaf, Localization::LeafBricks}) {
        engines.push_back(std::make_unique<PolygonEngine>(way, parts));
    }
    return engines;
}

MadeEngine makeFragmentEngine(const device::Session& session) {
    Result<FragmentTrace> trace =
        FragmentTrace::create(session.context, Filter::Hardware, session.device.queueAccess());
    VOXTACT_TRY(trace);
    return MadeEngine(std::make_unique<FragmentEngine>(std::move(*trace)));
}

} // namespace voxtact::lab
