// SPDX-License-Identifier: MIT
// Pictures of a scene on a device.
#include "device_side.h"
#include "failure.h"
#include "turn.h"
#include "voxtact/looks.h"

#include <algorithm>
#include <cmath>
#include <exception>

namespace voxtact::python {

namespace {

/// That of `voxtact render`: soft, with places that are shut in darker.
Lighting softLight(const Grid& grid) {
    Lighting lighting;
    lighting.ambient = 0.3;
    lighting.diffuse = 0.45;
    lighting.side = 0.5;
    lighting.specular = 0.16;
    lighting.occlusion = 0.55;
    constexpr double kReach = 0.025; // of the diagonal
    double diagonal = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        diagonal += std::pow(grid.spacing[axis] * grid.size[axis], 2);
    }
    lighting.reach = kReach * std::sqrt(diagonal);
    return lighting;
}

/// Leaves render(), which nothing may be thrown through, and is thrown on.
class Interruption {
  public:
    void look() noexcept {
        try {
            if (thrown_ == nullptr) {
                handleSignals();
            }
        } catch (...) {
            thrown_ = std::current_exception();
        }
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

Picture DeviceSide::picture(const PictureWish& wish, const OpacityDesc& opacity) {
    if (!renderer_) {
        renderer_.emplace(take(BlockingRenderer::create(device_->context(), device_->queue())));
        bricks_.emplace(take(RenderBricks::create(renderer_->renderer(), volume_)));
    }
    const RenderTransferFunction function = upload(wish, opacity);
    std::vector<SceneMesh> meshes;
    for (const Mat4& pose : wish.world_from_object) {
        const Drawn& drawing = drawn(wish.mesh);
        SceneMesh one;
        one.mesh = &drawing.mesh;
        one.normals = &drawing.normals;
        one.world_from_object = pose;
        one.paint.what = wish.paint;
        one.paint.transferFunction = &function_;
        one.paint.threshold = wish.threshold;
        one.paint.through = wish.through;
        meshes.push_back(one);
    }
    voxtact::Scene scene;
    scene.volume = &volume_;
    scene.transferFunction = &function;
    scene.bricks = &*bricks_;
    scene.others = meshes;
    scene.clip_from_world = wish.clip_from_world;
    scene.background = wish.background;
    scene.lighting = softLight(volume_.grid());
    Interruption interruption;
    Picture made = take(renderer_->render(scene, {wish.width, wish.height},
                                          [&](std::uint32_t, std::uint32_t) { interruption.look(); }));
    interruption.rethrow();
    return made;
}

} // namespace voxtact::python
