// SPDX-License-Identifier: MIT
// How pictures look, without a device.
#include "voxtact/looks.h"
#include "c/convert.h"
#include "c/handles.h"
#include "c/structs.h"
#include "voxtact/render.h"
#include "voxtact/voxtact_vulkan.h"

#include <algorithm>
#include <cmath>
#include <optional>

using namespace voxtact;
using namespace voxtact::c;

struct vxt_look {
    std::vector<vxt_control_point> opacity;
    std::vector<vxt_colour_point> colours;
};

const char* vxt_look_name(size_t index) {
    const std::span<const LookPreset> all = lookPresets();
    return index < all.size() ? all[index].name : nullptr;
}

vxt_result vxt_look_create(const char* name, const vxt_range* values, vxt_look** look) {
    return create(look, [&] {
        const Look found = take(lookNamed(&need(name, "name"), toRange(need(values, "values"))));
        vxt_look out;
        for (const ControlPoint& point : found.opacity) {
            out.opacity.push_back({point.value, point.opacity});
        }
        for (const ColourPoint& point : found.colours) {
            out.colours.push_back({point.value, {point.colour[0], point.colour[1], point.colour[2]}});
        }
        return out;
    });
}

const vxt_control_point* vxt_look_opacity(const vxt_look* look, size_t* count) {
    return handOut(look == nullptr ? std::span<const vxt_control_point>() : look->opacity, count);
}

const vxt_colour_point* vxt_look_colours(const vxt_look* look, size_t* count) {
    return handOut(look == nullptr ? std::span<const vxt_colour_point>() : look->colours, count);
}

void vxt_look_destroy(vxt_look* look) {
    delete look;
}

vxt_result vxt_direction_named(const char* name, vxt_view_direction* direction) {
    return call([&] {
        const std::optional<ViewDirection> found = directionNamed(&need(name, "name"));
        if (!found) {
            refuse(ErrorCode::InvalidArgument, std::string("there is no direction '") + name +
                                                   "'; there are front, back, left, right, top and bottom");
        }
        need(direction, "direction") = {found->azimuth, found->elevation};
    });
}

vxt_result vxt_view_from(const vxt_view_direction* direction, const vxt_grid* grid, const vxt_box* also, uint32_t width,
                         uint32_t height, vxt_view* view) {
    return call([&] {
        const vxt_view_direction& from = need(direction, "direction");
        const Grid of = checkedGrid(grid);
        vxt_view& out = need(view, "view");
        checkPixels(width, height);
        if (!std::isfinite(from.azimuth) || !std::isfinite(from.elevation)) {
            refuse(ErrorCode::InvalidArgument, "direction: azimuth or elevation is not finite");
        }
        const std::optional<Box> more = also == nullptr ? std::nullopt : std::optional<Box>(toBox(*also));
        writeMat4(out.clip_from_world, viewFrom({from.azimuth, from.elevation}, of, more, width, height), "view");
        out.width = width;
        out.height = height;
    });
}

vxt_result vxt_clip_side(const char* side, const double* at, const vxt_grid* grid, const vxt_view_direction* direction,
                         vxt_clip_plane* plane) {
    return call([&] {
        const std::string name = &need(side, "side");
        const Grid of = checkedGrid(grid);
        vxt_clip_plane& out = need(plane, "plane");
        const std::optional<double> where = at == nullptr ? std::nullopt : std::optional<double>(*at);
        if (where && !std::isfinite(*where)) {
            refuse(ErrorCode::InvalidArgument, "at is not finite");
        }
        Vec3 eye{};
        if (name == "near") {
            const vxt_view_direction& from = need(direction, "direction");
            eye = towardsEye({from.azimuth, from.elevation});
            if (!std::isfinite(from.azimuth) || !std::isfinite(from.elevation)) {
                refuse(ErrorCode::InvalidArgument, "direction: azimuth or elevation is not finite");
            }
        }
        const std::optional<ClipPlane> found = clipSide(name, where, of, eye);
        if (!found) {
            refuse(ErrorCode::InvalidArgument,
                   "there is no side '" + name + "'; there are left, right, back, front, top, bottom and near");
        }
        std::ranges::copy(found->normal, out.normal);
        out.offset = found->offset;
    });
}

vxt_result vxt_lighting_named(const char* name, const vxt_grid* grid, vxt_lighting* lighting) {
    return call([&] {
        const std::optional<Lighting> found = lightingNamed(&need(name, "name"), checkedGrid(grid));
        if (!found) {
            refuse(ErrorCode::InvalidArgument,
                   std::string("there is no light '") + name + "'; there are soft, eye and none");
        }
        vxt_lighting out = zero<vxt_lighting>();
        out.ambient = explicitNumber(found->ambient);
        out.diffuse = explicitNumber(found->diffuse);
        out.specular = explicitNumber(found->specular);
        out.shininess = explicitNumber(found->shininess);
        out.side = found->side;
        std::ranges::copy(found->sideFrom, out.side_from);
        out.occlusion = found->occlusion;
        out.reach = found->reach;
        out.plain_volume = found->volume ? 0 : 1;
        out.plain_mesh = found->mesh ? 0 : 1;
        out.gradient_faces = found->faces ? 0 : 1;
        writeStruct(lighting, out, "lighting");
    });
}

void vxt_mesh_colour(size_t number, double colour[3]) {
    if (colour != nullptr) {
        std::ranges::copy(meshColour(number), colour);
    }
}

void vxt_plain_colour(double colour[3]) {
    if (colour != nullptr) {
        std::ranges::copy(plainColours().front().colour, colour);
    }
}

double vxt_paint_through(vxt_paint paint) {
    return paint == VXT_PAINT_PLAIN ? 0 : throughFor(static_cast<Paint>(paint));
}

vxt_result vxt_split_at_creases(const vxt_mesh_view* mesh, double degrees, vxt_mesh_data** data) {
    return create(data, [&] { return take(splitAtCreases(toMeshView(mesh), degrees)); });
}
