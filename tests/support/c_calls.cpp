// SPDX-License-Identifier: MIT
#include "support/c_calls.h"

#include "support/contact_scenes.h"

#include <algorithm>
#include <span>

namespace voxtact::test {

vxt_grid cGrid(const Grid& grid) {
    vxt_grid out = vxt_grid{};
    std::ranges::copy(grid.size, out.size);
    std::ranges::copy(grid.spacing, out.spacing);
    std::ranges::copy(grid.origin, out.origin);
    std::ranges::copy(grid.direction, out.direction);
    return out;
}

vxt_volume_view cVolume(const VolumeData& volume) {
    vxt_volume_view out = sized<vxt_volume_view>();
    out.grid = cGrid(volume.grid);
    out.type = static_cast<vxt_scalar_type>(volume.type);
    out.voxels = volume.voxels.data();
    out.bytes = volume.voxels.size();
    return out;
}

vxt_mesh_view cMesh(const MeshData& mesh) {
    vxt_mesh_view out = sized<vxt_mesh_view>();
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
    vxt_transfer_function_desc out = sized<vxt_transfer_function_desc>();
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
    return made(vxt_answer_destroy, vxt_answer_create);
}

BatchAnswer answerOf(const vxt_answer& answer) {
    std::size_t read = 0;
    const auto column = [&]<class T>(const char* table, const char* name, T) {
        ++read;
        return readColumn<T>(answer, table, name);
    };
    constexpr std::uint32_t kNumber = 0;
    BatchAnswer out;
    const auto items = column("pairs", "item", kNumber);
    const auto poses = column("pairs", "pose", kNumber);
    const auto touches = column("pairs", "touch", kNumber);
    const auto exactnesses = column("pairs", "exactness", kNumber);
    const auto methods = column("pairs", "method", kNumber);
    const auto projections = column("pairs", "projection", kNumber);
    const auto counts = column("pairs", "count", std::uint64_t{});
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const auto touch = static_cast<Verdict>(touches[i]);
        out.pairs.push_back({static_cast<std::uint32_t>(i), items[i], poses[i], touch == Verdict::Yes,
                             touch == Verdict::Undecided, counts[i], static_cast<Exactness>(exactnesses[i]),
                             static_cast<CountingMethod>(methods[i]), static_cast<Projection>(projections[i])});
    }
    const auto trianglePairs = column("triangles", "pair", kNumber);
    const auto triangles = column("triangles", "triangle", kNumber);
    const auto triangleCounts = column("triangles", "count", kNumber);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        out.triangles.push_back({trianglePairs[i], triangles[i], triangleCounts[i]});
    }
    const auto contactPairs = column("contacts", "pair", kNumber);
    const auto contactTriangles = column("contacts", "triangle", kNumber);
    const auto positions = column("contacts", "position", Vec3{});
    const auto normals = column("contacts", "normal", Vec3{});
    const auto depths = column("contacts", "depth", 0.0);
    const auto values = column("contacts", "value", 0.0);
    const auto opacities = column("contacts", "opacity", 0.0);
    const auto contactLabels = column("contacts", "label", std::int32_t{});
    for (std::size_t i = 0; i < positions.size(); ++i) {
        out.contacts.push_back({contactPairs[i], contactTriangles[i], positions[i], normals[i], depths[i], values[i],
                                opacities[i], contactLabels[i]});
    }
    const auto lower = column("bounds", "lower", Vec3{});
    const auto upper = column("bounds", "upper", Vec3{});
    for (std::size_t i = 0; i < lower.size(); ++i) {
        out.bounds.push_back(lower[i][0] > upper[i][0] ? std::optional<Box>() : Box{lower[i], upper[i]});
    }
    const auto labelPairs = column("labels", "pair", kNumber);
    const auto labels = column("labels", "label", std::int32_t{});
    const auto labelCounts = column("labels", "count", std::uint64_t{});
    for (std::size_t i = 0; i < labels.size(); ++i) {
        out.labels.push_back({labelPairs[i], labels[i], labelCounts[i]});
    }
    const auto single = [&](const char* name, auto kind) {
        const auto all = column("totals", name, kind);
        EXPECT_EQ(all.size(), 1U) << name;
        return all.empty() ? kind : all[0];
    };
    out.contactsFound = single("contacts_found", std::uint64_t{});
    out.gpuMilliseconds = single("gpu_milliseconds", 0.0);
    out.wallMilliseconds = single("wall_milliseconds", 0.0);
    EXPECT_EQ(read, vxt_answer_columns(&answer)) << "columns that are not read here";
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
