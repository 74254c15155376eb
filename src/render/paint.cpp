// SPDX-License-Identifier: MIT
#include "core/pair_transform.h"
#include "core/text.h"
#include "render/render_impl.h"

namespace voxtact {

namespace {

Error refuse(std::string text) {
    return {ErrorCode::InvalidArgument, 0, std::move(text)};
}

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
    return checkFraction(paint.threshold, "threshold");
}

Result<void> checkTriangles(const ContextImpl& context, const Scene& scene) {
    const PaintedTriangles* triangles = scene.paint.triangles;
    if (triangles == nullptr) {
        return refuse("Scene::paint has no triangles to paint");
    }
    if (&triangles->impl().context != &context) {
        return refuse("Scene::paint has triangles of another Context");
    }
    if (triangles->impl().room < scene.mesh->triangles()) {
        return refuse("Scene::paint has bits for " + std::to_string(triangles->impl().room) +
                      " triangles, the mesh has " + std::to_string(scene.mesh->triangles()));
    }
    return {};
}

PaintBy paintedBy(Paint what) {
    switch (what) {
    case Paint::Contacts:
    case Paint::Discarded:
        return PaintBy::Fragments;
    case Paint::Triangles:
        return PaintBy::Triangles;
    case Paint::Plain:
        break;
    }
    return PaintBy::Nobody;
}

} // namespace

Result<void> checkPaint(const ContextImpl& context, const Scene& scene) {
    const MeshPaint& paint = scene.paint;
    if (paint.what == Paint::Plain) {
        return {};
    }
    if (paint.what > Paint::Triangles) {
        return refuse("Scene::paint: there is no paint number " +
                      std::to_string(static_cast<std::uint32_t>(paint.what)));
    }
    if (scene.mesh == nullptr) {
        return refuse("Scene::paint is given without a mesh");
    }
    if (Result<void> parts =
            paint.what == Paint::Triangles ? checkTriangles(context, scene) : checkFunction(context, paint);
        !parts.ok()) {
        return parts;
    }
    for (const Result<void>& checked : {checkFraction(paint.through, "part seen through the volume"),
                                        checkColour(paint.contactColour, "the colour of contacts"),
                                        checkColour(paint.discardedColour, "the colour of discarded fragments")}) {
        if (!checked.ok()) {
            return checked;
        }
    }
    return {};
}

void setPaint(PictureSetup& setup, const Scene& scene) {
    const MeshPaint& paint = scene.paint;
    setup.paintedBy = paintedBy(paint.what);
    if (setup.paintedBy == PaintBy::Nobody) {
        return;
    }
    shader::PictureConstants& constants = setup.constants;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        constants.contactColour[channel] = static_cast<float>(paint.contactColour[channel]);
        constants.discardedColour[channel] = static_cast<float>(paint.discardedColour[channel]);
    }
    constants.contactColour[3] = static_cast<float>(paint.through);
    constants.switches |= paint.what == Paint::Discarded ? PICTURE_DISCARDED : 0U;
    if (setup.paintedBy == PaintBy::Fragments) {
        const VolumeImpl& volume = scene.volume->impl();
        constants.item = itemConstants(volume.valueSlope, volume.valueIntercept, paint.transferFunction->impl().domain,
                                       paint.threshold);
    }
}

} // namespace voxtact
