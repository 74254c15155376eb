// SPDX-License-Identifier: MIT
// Pictures of a scene on a device.
#include "device_side.h"
#include "failure.h"
#include "turn.h"

#include <algorithm>
#include <exception>

namespace voxtact::python {

namespace {

/// Leaves render(), which nothing may be thrown through, and is thrown on.
class Interruption {
  public:
    /// Whether the picture goes on.
    bool look() noexcept {
        try {
            handleSignals();
        } catch (...) {
            thrown_ = std::current_exception();
        }
        return thrown_ == nullptr;
    }
    void rethrow() const {
        if (thrown_ != nullptr) {
            std::rethrow_exception(thrown_);
        }
    }

  private:
    std::exception_ptr thrown_;
};

} // namespace

const DeviceSide::Drawn& DeviceSide::drawn(const std::shared_ptr<const Shape>& shape) {
    Uploaded& one = uploaded(shape);
    if (!one.drawn) {
        const MeshData creased = take(splitAtCreases(shape->data().view()));
        Mesh mesh = take(Mesh::upload(device_->context(), device_->queue(), creased.view()));
        MeshNormals normals = take(MeshNormals::upload(renderer_->renderer(), device_->queue(), creased.view()));
        one.drawn.emplace(Drawn{std::move(mesh), std::move(normals)});
    }
    return *one.drawn;
}

RenderTransferFunction DeviceSide::upload(const PictureWish& wish, const OpacityDesc& opacity) {
    RenderTransferFunctionDesc desc;
    desc.opacity = opacity.desc();
    desc.colours = wish.colours;
    desc.step = std::ranges::min(volume_.grid().spacing) / 2;
    return take(RenderTransferFunction::upload(renderer_->renderer(), device_->queue(), desc));
}

std::vector<PaintedTriangles> DeviceSide::paint(const PictureWish& wish) {
    std::vector<PaintedTriangles> painted;
    for (const Request::Item& item : wish.shown.items) {
        for (std::size_t pose = 0; wish.paint == Paint::Triangles && pose < item.world_from_object.size(); ++pose) {
            painted.push_back(
                take(PaintedTriangles::upload(renderer_->renderer(), device_->queue(), item.mesh->facts().triangles,
                                              wish.triangles[item.firstPair + pose])));
        }
    }
    return painted;
}

Picture DeviceSide::picture(const PictureWish& wish, const OpacityDesc& opacity) {
    if (!renderer_) {
        renderer_.emplace(take(BlockingRenderer::create(device_->context(), device_->queue())));
        bricks_.emplace(take(RenderBricks::create(renderer_->renderer(), volume_)));
    }
    const RenderTransferFunction function = upload(wish, opacity);
    const std::vector<PaintedTriangles> painted = paint(wish);
    std::vector<SceneMesh> meshes;
    for (std::size_t item = 0; item < wish.shown.items.size(); ++item) {
        const Drawn& drawing = drawn(wish.shown.items[item].mesh);
        for (const Mat4& pose : wish.shown.items[item].world_from_object) {
            SceneMesh one;
            one.mesh = &drawing.mesh;
            one.normals = &drawing.normals;
            one.world_from_object = pose;
            one.meshColour = wish.meshColours[item];
            one.clipped = wish.clipMeshes;
            one.paint.what = wish.paint;
            one.paint.transferFunction = &function_;
            one.paint.threshold = wish.threshold;
            one.paint.triangles = painted.empty() ? nullptr : &painted[meshes.size()];
            one.paint.through = wish.through;
            meshes.push_back(one);
        }
    }
    voxtact::Scene scene;
    scene.volume = &volume_;
    scene.transferFunction = &function;
    scene.bricks = &*bricks_;
    scene.others = meshes;
    scene.clip_from_world = wish.clip_from_world;
    scene.background = wish.background;
    scene.clipPlanes = wish.clips;
    scene.lighting = wish.lighting;
    Interruption interruption;
    Result<Picture> made = renderer_->render(scene, {wish.width, wish.height},
                                             [&](std::uint32_t, std::uint32_t) { return interruption.look(); });
    interruption.rethrow();
    return take(std::move(made));
}

} // namespace voxtact::python
