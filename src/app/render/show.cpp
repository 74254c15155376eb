// SPDX-License-Identifier: MIT
#include "app/render/show.h"
#include "app/output/standard_streams.h"
#include "core/text.h"
#include "voxtact/cpu.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace voxtact::app {

namespace {

/// How much is seen through the tissue, where it is not said: of contacts, and of a mesh that is all painted.
constexpr double kContactsThrough = 0.8;
constexpr double kDiscardedThrough = 1;

Result<void> noteWhereNothingIsOpaque(const ShownPair& pair) {
    const Result<std::vector<float>> table = sampleTable(pair.transferFunction);
    if (!table.ok()) {
        return table.error();
    }
    if (*std::ranges::max_element(*table) < static_cast<float>(pair.threshold)) {
        printNote("no opacity of the transfer function reaches the threshold " + number(pair.threshold) +
                  ": nothing touches");
    }
    return {};
}

/// Those that touch for certain.
Result<std::vector<std::uint32_t>> certifiedTriangles(const ShownPair& pair) {
    const Result<cpu::Volume> volume = cpu::Volume::create(pair.volume.view());
    if (!volume.ok()) {
        return volume.error();
    }
    const Result<cpu::TransferFunction> function = cpu::TransferFunction::create(pair.transferFunction);
    if (!function.ok()) {
        return function.error();
    }
    const Result<cpu::Mesh> mesh = cpu::Mesh::create(pair.mesh.view());
    if (!mesh.ok()) {
        return mesh.error();
    }
    Result<cpu::Detector> detector =
        cpu::Detector::create({.projection = Projection::Conservative, .outputs = {.triangles = true}});
    if (!detector.ok()) {
        return detector.error();
    }
    const cpu::BatchItem item{&*mesh, &*volume, &*function, {&pair.world_from_object, 1}};
    const Result<BatchAnswer> answer = detector->detect({{&item, 1}, {}, pair.threshold});
    if (!answer.ok()) {
        return answer.error();
    }
    std::vector<std::uint32_t> triangles;
    for (const TouchedTriangle& touched : answer->triangles) {
        triangles.push_back(touched.triangle);
    }
    return triangles;
}

Result<void> uploadTriangles(const ShownPair& pair, const Session& session, const Renderer& renderer,
                             ShowObjects& objects) {
    const Result<std::vector<std::uint32_t>> touched = certifiedTriangles(pair);
    if (!touched.ok()) {
        return touched.error();
    }
    Result<PaintedTriangles> triangles = PaintedTriangles::upload(
        renderer, session.device.queueAccess(), static_cast<std::uint32_t>(pair.mesh.indices.size() / 3), *touched);
    if (!triangles.ok()) {
        return triangles.error();
    }
    objects.triangles = std::move(*triangles);
    return {};
}

} // namespace

void addShowOptions(CLI::App& parser, ShowOptions& options) {
    addName(
        parser, "--show", options.what, {"contacts", "discarded", "triangles"},
        "painted on the mesh: contacts (what survives in this view, red), discarded (what does not survive, blue, and "
        "survivors by their opacity, from dark gray to white), triangles (those that touch for certain, red)");
    addNumber(
        parser, "--through", [&options](double part) { options.through = part; },
        "how much of what is painted is seen through the tissue before it; default: " + number(kContactsThrough) +
            ", for discarded " + number(kDiscardedThrough),
        [](double part) { return part >= 0 && part <= 1; }, "from 0 to 1", "");
    parser.get_option("--show")->needs("--mesh");
    parser.get_option("--through")->needs("--show");
    parser.get_option("--threshold")->needs("--show");
}

Result<ShowObjects> makeShowObjects(const ShowOptions& options, const ShownPair& pair, const Session& session,
                                    const Renderer& renderer) {
    ShowObjects objects;
    if (options.what.empty()) {
        return objects;
    }
    if (Result<void> noted = noteWhereNothingIsOpaque(pair); !noted.ok()) {
        return noted.error();
    }
    if (options.what == "triangles") {
        if (Result<void> done = uploadTriangles(pair, session, renderer, objects); !done.ok()) {
            return done.error();
        }
        return objects;
    }
    Result<TransferFunction> function =
        TransferFunction::upload(session.context, session.device.queueAccess(), pair.transferFunction);
    if (!function.ok()) {
        return function.error();
    }
    objects.transferFunction = std::move(*function);
    return objects;
}

MeshPaint paintOf(const ShowOptions& options, const ShowObjects& objects, double threshold) {
    MeshPaint paint;
    paint.threshold = threshold;
    if (objects.triangles) {
        paint.what = Paint::Triangles;
        paint.triangles = &*objects.triangles;
    } else if (objects.transferFunction) {
        paint.what = options.what == "discarded" ? Paint::Discarded : Paint::Contacts;
        paint.transferFunction = &*objects.transferFunction;
    }
    paint.through = options.through.value_or(paint.what == Paint::Discarded ? kDiscardedThrough : kContactsThrough);
    return paint;
}

} // namespace voxtact::app
