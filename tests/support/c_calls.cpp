// SPDX-License-Identifier: MIT
#include "support/c_calls.h"

#include "support/contact_scenes.h"

#include <algorithm>
#include <span>

namespace voxtact::test {

vxt_grid cGrid(const Grid& grid) {
    vxt_grid out = vxt_grid_init();
    std::ranges::copy(grid.size, out.size);
    std::ranges::copy(grid.spacing, out.spacing);
    std::ranges::copy(grid.origin, out.origin);
    std::ranges::copy(grid.direction, out.direction);
    return out;
}

vxt_volume_view cVolume(const VolumeData& volume) {
    vxt_volume_view out = vxt_volume_view_init();
    out.grid = cGrid(volume.grid);
    out.type = static_cast<vxt_scalar_type>(volume.type);
    out.voxels = volume.voxels.data();
    out.bytes = volume.voxels.size();
    return out;
}

vxt_mesh_view cMesh(const MeshData& mesh) {
    vxt_mesh_view out = vxt_mesh_view_init();
    out.positions = mesh.positions.data();
    out.vertex_count = mesh.positions.size() / 3;
    out.indices = mesh.indices.data();
    out.triangle_count = mesh.indices.size() / 3;
    return out;
}

vxt_view cView(const View& view) {
    vxt_view out{};
    std::ranges::copy(view.clip_from_world, out.clip_from_world);
    out.width = view.width;
    out.height = view.height;
    return out;
}

std::vector<vxt_control_point> cPoints(const std::vector<ControlPoint>& points) {
    std::vector<vxt_control_point> out;
    for (const ControlPoint& point : points) {
        out.push_back({point.value, point.opacity});
    }
    return out;
}

vxt_transfer_function_desc cFunction(const std::vector<vxt_control_point>& points, const ValueRange& domain,
                                     std::uint32_t tableSize) {
    vxt_transfer_function_desc out = vxt_transfer_function_desc_init();
    out.points = points.data();
    out.point_count = points.size();
    out.domain = {domain.lo, domain.hi};
    out.table_size = tableSize;
    return out;
}

std::uint32_t cOutputs(const Outputs& outputs) {
    std::uint32_t out = 0;
    out |= outputs.triangles ? std::uint32_t{VXT_OUTPUT_TRIANGLES} : 0;
    out |= outputs.contacts ? std::uint32_t{VXT_OUTPUT_CONTACTS} : 0;
    out |= outputs.bounds ? std::uint32_t{VXT_OUTPUT_BOUNDS} : 0;
    out |= outputs.labels ? std::uint32_t{VXT_OUTPUT_LABELS} : 0;
    return out;
}

Owned<vxt_answer> newAnswer() {
    return made<vxt_answer>(vxt_answer_destroy, [](vxt_answer** out) { return vxt_answer_create(out); });
}

BatchAnswer answerOf(const vxt_answer& answer) {
    vxt_answer_view view = vxt_answer_view_init();
    need(vxt_answer_get(&answer, &view));
    BatchAnswer out;
    for (const vxt_pair& pair : std::span(view.pairs, view.pair_count)) {
        out.pairs.push_back({pair.pair, pair.item, pair.pose, pair.hit != 0, pair.possible != 0, pair.count,
                             static_cast<Exactness>(pair.exactness), static_cast<CountingMethod>(pair.method),
                             static_cast<Projection>(pair.projection)});
    }
    for (const vxt_touched_triangle& triangle : std::span(view.triangles, view.triangle_count)) {
        out.triangles.push_back({triangle.pair, triangle.triangle, triangle.count});
    }
    for (const vxt_contact& c : std::span(view.contacts, view.contact_count)) {
        EXPECT_EQ(c.reserved, 0U);
        out.contacts.push_back({c.pair,
                                c.triangle,
                                {c.position[0], c.position[1], c.position[2]},
                                {c.normal[0], c.normal[1], c.normal[2]},
                                c.depth,
                                c.value,
                                c.opacity,
                                c.label});
    }
    for (const vxt_box& box : std::span(view.bounds, view.bounds_count)) {
        const bool empty = box.lo[0] > box.hi[0];
        out.bounds.push_back(empty ? std::optional<Box>()
                                   : Box{{box.lo[0], box.lo[1], box.lo[2]}, {box.hi[0], box.hi[1], box.hi[2]}});
    }
    for (const vxt_label_count& label : std::span(view.labels, view.label_count)) {
        out.labels.push_back({label.pair, label.label, label.count});
    }
    out.contactsFound = view.contacts_found;
    out.gpuMilliseconds = view.gpu_milliseconds;
    out.wallMilliseconds = view.wall_milliseconds;
    return out;
}

std::string wholeDifferenceOf(const BatchAnswer& a, const BatchAnswer& b) {
    std::string text = differenceOf(a, b);
    for (std::size_t i = 0; text.empty() && i < a.pairs.size(); ++i) {
        const PairAnswer& x = a.pairs[i];
        const PairAnswer& y = b.pairs[i];
        if (x.pair != y.pair || x.item != y.item || x.pose != y.pose || x.hit != y.hit || x.possible != y.possible ||
            x.exactness != y.exactness || x.method != y.method || x.projection != y.projection) {
            text = "pair " + std::to_string(i);
        }
    }
    return text;
}

} // namespace voxtact::test
