// SPDX-License-Identifier: MIT
#pragma once

#include "c/handles_vulkan.h"
#include "voxtact/render.h"

// Definitions of the opaque types of pictures, as in handles.h.

namespace voxtact::c {

/// A renderer of the caller's, or that of a blocking one.
struct OwnOrLent {
    std::optional<Renderer> own;
    const Renderer* lent = nullptr;

    [[nodiscard]] const Renderer& get() const noexcept { return own ? *own : *lent; }
};

} // namespace voxtact::c

struct vxt_renderer {
    voxtact::c::OwnOrLent object;
    voxtact::c::SharedErrors errors;
};
struct vxt_render_function {
    voxtact::RenderTransferFunction object;
    voxtact::c::SharedErrors errors;
};
struct vxt_mesh_normals {
    voxtact::MeshNormals object;
    voxtact::c::SharedErrors errors;
};
struct vxt_render_bricks {
    voxtact::RenderBricks object;
    voxtact::c::SharedErrors errors;
};
struct vxt_painted_triangles {
    voxtact::PaintedTriangles object;
    voxtact::c::SharedErrors errors;
};
struct vxt_painted_vertices {
    voxtact::PaintedVertices object;
    voxtact::c::SharedErrors errors;
};
struct vxt_render_targets {
    voxtact::RenderTargets object;
    voxtact::c::SharedErrors errors;
};

namespace voxtact::c {

struct BlockingAndRenderer {
    BlockingRenderer blocking;
    vxt_renderer renderer;
};

} // namespace voxtact::c

struct vxt_blocking_renderer {
    voxtact::c::BlockingAndRenderer object;
    voxtact::c::SharedErrors errors;
};
