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
};

Result<Pass> findPolygons(PolygonParts& parts, Localization way, const Work& work) {
    const BatchItem item = work.onDevice();
    const LocalizeAids aids{&parts.tree, [&parts](const Box& box) { return parts.bricks.mayBeOpaque(box); }};
    return parts.localizer.triangles({{&item, 1}, work.view, work.volume->threshold}, way, aids);
}

Result<Pass> listFragments(FragmentTrace& trace, const Work& work, const Feeding& /*feeding*/) {
    const Stopwatch watch;
    const BatchItem item = work.onDevice();
    const Result<std::vector<shader::TracedFragment>> fragments =
        trace.survivors({{&item, 1}, work.view, work.volume->threshold});
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

EngineFacts factsOfView(const char* name) {
    return {.name = name, .projection = toString(Projection::View), .threads = 0};
}

} // namespace

Result<Engines> makePolygonEngines(const device::Session& session, const VolumePart& volume, const MeshPart& mesh,
                                   double tolerance) {
    Result<Localizer> localizer = Localizer::create(session.context, Filter::Hardware, session.device.queueAccess());
    VOXTACT_TRY(localizer);
    const auto parts = std::make_shared<PolygonParts>(
        PolygonParts{std::move(*localizer), makeObbTree(mesh.data.view()),
                     cpu::BrickOccupancy(*volume.host, *volume.hostFunction, volume.threshold, tolerance)});
    Engines engines;
    for (const Localization way : {Localization::Polygon, Localization::Leaf, Localization::LeafBricks}) {
        engines.push_back({factsOfView(toString(way)),
                           [parts, way](const Work& work, const Feeding&) { return findPolygons(*parts, way, work); }});
    }
    return engines;
}

MadeEngine makeFragmentEngine(const device::Session& session) {
    Result<FragmentTrace> trace =
        FragmentTrace::create(session.context, Filter::Hardware, session.device.queueAccess());
    VOXTACT_TRY(trace);
    return engineOf(factsOfView("fragments"), std::move(*trace), listFragments);
}

} // namespace voxtact::lab
