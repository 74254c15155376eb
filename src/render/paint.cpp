// SPDX-License-Identifier: MIT
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/geometry/pair_transform.h"
#include "render/render_impl.h"

namespace voxtact {

namespace {

/// [0, 1]; NaN is refused.
Result<void> checkFraction(double value, const char* what) {
    return value >= 0 && value <= 1
               ? Result<void>()
               : refuse(std::string("Scene::paint has the ") + what + " " + number(value) + ", outside [0, 1]");
}

Result<void> checkFunction(const ContextImpl& context, const MeshPaint& paint) {
    if (paint.transferFunction == nullptr) {
        return refuse("Scene::paint has no transfer function to decide by");
    }
    if (&paint.transferFunction->impl().context != &context) {
        return refuse("Scene::paint has a transfer function of another Context");
    }
    if (!paint.transferFunction->impl().filtered) {
        return Error{ErrorCode::Unsupported, 0,
                     "Scene::paint: the device cannot filter its transfer function's table linearly"};
    }
    return checkFraction(paint.threshold, "threshold");
}

Result<void> checkTriangles(const ContextImpl& context, const SceneMesh& mesh) {
    const PaintedTriangles* triangles = mesh.paint.triangles;
    if (triangles == nullptr) {
        return refuse("Scene::paint has no triangles to paint");
    }
    if (&triangles->impl().context != &context) {
        return refuse("Scene::paint has triangles of another Context");
    }
    if (triangles->impl().room < mesh.mesh->triangles()) {
        return refuse("Scene::paint has bits for " + std::to_string(triangles->impl().room) +
                      " triangles, the mesh has " + std::to_string(mesh.mesh->triangles()));
    }
    return {};
}

Result<void> checkVertices(const ContextImpl& context, const SceneMesh& mesh) {
    const PaintedVertices* vertices = mesh.paint.vertices;
    if (vertices == nullptr) {
        return refuse("Scene::paint has no colours of vertices");
    }
    if (&vertices->impl().context != &context) {
        return refuse("Scene::paint has colours of vertices of another Context");
    }
    const std::uint64_t needed = mesh.mesh->impl().drawnVertices();
    if (vertices->impl().room < needed) {
        return refuse("Scene::paint has colours for " + std::to_string(vertices->impl().room) +
                      " vertices, the mesh has " + std::to_string(needed));
    }
    return {};
}

Result<void> checkParts(const ContextImpl& context, const SceneMesh& mesh) {
    switch (paintedBy(mesh.paint.what)) {
    case PaintBy::Fragments:
        return checkFunction(context, mesh.paint);
    case PaintBy::Triangles:
        return checkTriangles(context, mesh);
    case PaintBy::Vertices:
        return checkVertices(context, mesh);
    case PaintBy::Nobody:
        break;
    }
    return {};
}

} // namespace

PaintBy paintedBy(Paint what) noexcept {
    switch (what) {
    case Paint::Contacts:
    case Paint::Discarded:
        return PaintBy::Fragments;
    case Paint::Triangles:
        return PaintBy::Triangles;
    case Paint::Vertices:
        return PaintBy::Vertices;
    case Paint::Plain:
        break;
    }
    return PaintBy::Nobody;
}

Result<void> checkPaint(const ContextImpl& context, const SceneMesh& mesh) {
    const MeshPaint& paint = mesh.paint;
    if (paint.what == Paint::Plain) {
        return {};
    }
    if (paint.what > Paint::Vertices) {
        return refuse("Scene::paint: there is no paint number " +
                      std::to_string(static_cast<std::uint32_t>(paint.what)));
    }
    if (mesh.mesh == nullptr) {
        return refuse("Scene::paint is given without a mesh");
    }
    VOXTACT_TRY(checkParts(context, mesh));
    for (const Result<void>& checked : {checkFraction(paint.through, "part seen through the volume"),
                                        checkColour(paint.contactColour, "the colour of contacts"),
                                        checkColour(paint.discardedColour, "the colour of discarded fragments")}) {
        if (!checked.ok()) {
            return checked;
        }
    }
    return {};
}

void setPaint(shader::PictureMesh& constants, const Volume& volume, const MeshPaint& paint) {
    const PaintBy by = paintedBy(paint.what);
    if (by == PaintBy::Nobody) {
        return;
    }
    for (std::size_t channel = 0; channel < 3; ++channel) {
        constants.contactColour[channel] = static_cast<float>(paint.contactColour[channel]);
        constants.discardedColour[channel] = static_cast<float>(paint.discardedColour[channel]);
    }
    constants.contactColour[3] = static_cast<float>(paint.through);
    constants.switches |= paint.what == Paint::Discarded ? PICTURE_MESH_DISCARDED : 0U;
    if (by == PaintBy::Fragments) {
        const VolumeImpl& impl = volume.impl();
        constants.item = itemConstants(impl.valueSlope, impl.valueIntercept,
                                       paint.transferFunction->impl().known.domain, paint.threshold);
    }
}

} // namespace voxtact
