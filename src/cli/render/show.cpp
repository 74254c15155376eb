// SPDX-License-Identifier: MIT
#include "cli/render/show.h"
#include "cli/output/interrupt.h"
#include "cli/output/progress.h"
#include "cli/output/standard_streams.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "voxtact/cpu.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace voxtact::app {

namespace {

Result<void> uploadTriangles(const ShownPairs& pairs, bool progress, const device::Session& session,
                             const Renderer& renderer, ShowObjects& objects) {
    const Result<std::vector<std::vector<std::uint32_t>>> touching = touchingTriangles(pairs, progress);
    VOXTACT_TRY(touching);
    for (std::size_t i = 0; i < touching->size(); ++i) {
        const MeshData& mesh = pairs.meshes[i / pairs.poses.size()];
        Result<PaintedTriangles> triangles =
            PaintedTriangles::upload(renderer, session.device.queueAccess(),
                                     static_cast<std::uint32_t>(mesh.indices.size() / 3), (*touching)[i]);
        VOXTACT_TRY(triangles);
        objects.triangles.push_back(std::move(*triangles));
    }
    return {};
}

} // namespace

Result<std::vector<std::vector<std::uint32_t>>> touchingTriangles(const ShownPairs& pairs, bool progress) {
    const Result<cpu::Volume> volume = cpu::Volume::create(pairs.volume.view());
    VOXTACT_TRY(volume);
    const Result<cpu::TransferFunction> function = cpu::TransferFunction::create(pairs.transferFunction);
    VOXTACT_TRY(function);
    Result<cpu::HostEngine> engine = cpu::HostEngine::create();
    VOXTACT_TRY(engine);
    const Count question{.projection = Projection::Certified, .outputs = {.triangles = true}};
    Progress shown(progress, "triangles that touch", pairs.meshes.size() * pairs.poses.size());
    std::vector<std::vector<std::uint32_t>> touching;
    for (const MeshData& data : pairs.meshes) {
        const Result<cpu::Mesh> mesh = cpu::Mesh::create(data.view());
        VOXTACT_TRY(mesh);
        for (const Mat4& pose : pairs.poses) {
            const cpu::BatchItem item{&*mesh, &*volume, &*function, {&pose, 1}};
            cpu::Batch batch{{&item, 1}, {}, pairs.threshold};
            batch.cancel = &interruptFlag();
            const Result<BatchAnswer> answer = engine->ask(question, batch);
            VOXTACT_TRY(answer);
            std::vector<std::uint32_t>& triangles = touching.emplace_back();
            for (const TouchedTriangle& touched : answer->triangles) {
                triangles.push_back(touched.triangle);
            }
            shown.update(touching.size());
        }
    }
    return touching;
}

void addShowOptions(CLI::App& parser, ShowOptions& options) {
    addName(
        parser, "--show", options.what, {"contacts", "discarded", "triangles", "distance"},
        "paint on the mesh: contacts (passing pixels, red), discarded (others, blue), triangles (certified touches, "
        "red), distance (to the opaque region)");
    addNumber(
        parser, "--through", [&options](double part) { options.through = part; },
        "visibility of the paint through the tissue in front; default: " + number(throughFor(Paint::Contacts)) +
            ", for discarded " + number(throughFor(Paint::Discarded)),
        [](double part) { return part >= 0 && part <= 1; }, "from 0 to 1", "");
    addNumber(
        parser, "--max-distance", [&options](double mm) { options.maximum = mm; },
        "--show distance: distance of the last colour, mm", [](double mm) { return mm > 0; }, "above 0", "20");
    parser.get_option("--max-distance")->needs("--show");
    static_assert(kDefaultShownDistance == 20, "as the help says");
    parser.get_option("--show")->needs("--mesh");
    parser.get_option("--through")->needs("--show");
    parser.get_option("--opacity-threshold")->needs("--show");
}

Result<void> checkShowOptions(const ShowOptions& options) {
    if (options.maximum && !options.isDistance()) {
        return badArgument("--max-distance needs --show distance");
    }
    return {};
}

Result<ShowObjects> makeShowObjects(const ShowOptions& options, const ShownPairs& pairs,
                                    const std::optional<MeshDistances>& distances, bool progress,
                                    const device::Session& session, const Renderer& renderer) {
    ShowObjects objects;
    if (options.what.empty()) {
        return objects;
    }
    if (distances) {
        for (const std::vector<Colour>& colours : distances->colours) {
            Result<PaintedVertices> vertices = PaintedVertices::upload(renderer, session.device.queueAccess(), colours);
            VOXTACT_TRY(vertices);
            objects.vertices.push_back(std::move(*vertices));
        }
        return objects;
    }
    if (options.what == "triangles") {
        VOXTACT_TRY(uploadTriangles(pairs, progress, session, renderer, objects));
        return objects;
    }
    Result<TransferFunction> function =
        TransferFunction::upload(session.context, session.device.queueAccess(), pairs.transferFunction);
    VOXTACT_TRY(function);
    objects.transferFunction = std::move(*function);
    return objects;
}

MeshPaint paintOf(const ShowOptions& options, const ShowObjects& objects, double threshold, std::size_t number) {
    MeshPaint paint;
    paint.threshold = threshold;
    if (!objects.triangles.empty()) {
        paint.what = Paint::Triangles;
        paint.triangles = &objects.triangles[number];
    } else if (!objects.vertices.empty()) {
        paint.what = Paint::Vertices;
        paint.vertices = &objects.vertices[number];
    } else if (objects.transferFunction) {
        paint.what = options.what == "discarded" ? Paint::Discarded : Paint::Contacts;
        paint.transferFunction = &*objects.transferFunction;
    }
    paint.through = options.through.value_or(throughFor(paint.what));
    return paint;
}

} // namespace voxtact::app
