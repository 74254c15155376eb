// SPDX-License-Identifier: MIT
// Files, of a library with voxtact::io.
#include "c/convert.h"
#include "c/handles.h"
#include "voxtact/io.h"

#include <algorithm>

using namespace voxtact;
using namespace voxtact::c;

struct vxt_pose_reader {
    io::PoseReader object;
};
struct vxt_colour_points {
    std::vector<vxt_colour_point> object;
};
struct vxt_label_names {
    std::vector<io::LabelName> object;
};
struct vxt_points {
    std::vector<io::NamedPoint> object;
};

namespace {

std::filesystem::path toPath(const char* path) {
    return &need(path, "path");
}

io::VolumeReadOptions toOptions(const vxt_volume_read_options* given) {
    const vxt_volume_read_options options = readOptions(given, zero<vxt_volume_read_options>(), "options");
    io::VolumeReadOptions out;
    if (options.choose_frame != 0) {
        out.frame = options.frame;
    }
    if (options.series != nullptr) {
        out.series = options.series;
    }
    out.resample = options.resample != 0;
    return out;
}

io::MeshReadOptions toOptions(const vxt_mesh_read_options* given) {
    const vxt_mesh_read_options options = readOptions(given, zero<vxt_mesh_read_options>(), "options");
    io::MeshReadOptions reading{.space = {},
                                .scale = orDefault(options.scale, 1.0),
                                .deflection = orDefault(options.deflection, kDefaultDeflection)};
    if (options.ras != 0) {
        reading.space = io::MeshSpace::RAS;
    }
    return reading;
}

io::PoseFormat toPoseFormat(const char* name) {
    const std::optional<io::PoseFormat> format = io::poseFormatFromName(name == nullptr ? "matrix" : name);
    if (!format) {
        std::string known;
        for (const io::PoseFormat one : io::poseFormats()) {
            known += (known.empty() ? "" : ", ") + std::string(toString(one));
        }
        refuse(ErrorCode::InvalidArgument, "format '" + std::string(name) + "' is unknown; choose from: " + known);
    }
    return *format;
}

std::vector<vxt_control_point> fromPoints(const std::vector<ControlPoint>& points) {
    std::vector<vxt_control_point> out;
    for (const ControlPoint& point : points) {
        out.push_back({point.value, point.opacity});
    }
    return out;
}

/// A note that lives until the thread asks for another; "" where it fails.
template <class Make> const char* keptNote(const Make& make) noexcept {
    thread_local std::string kept;
    const vxt_result made = call([&] { kept = make(); });
    return made == VXT_OK ? kept.c_str() : "";
}

} // namespace

vxt_result vxt_read_volume(const char* path, const vxt_volume_read_options* options, vxt_volume_data** data) {
    return create(data, [&] { return take(io::readVolume(toPath(path), toOptions(options))); });
}

vxt_result vxt_read_volume_bytes(const char* name, const void* content, size_t bytes,
                                 const vxt_volume_read_options* options, vxt_volume_data** data) {
    return create(data, [&] {
        return take(io::readVolume(&need(name, "name"), toBytes(content, bytes, "content"), toOptions(options)));
    });
}

vxt_result vxt_write_volume(const char* path, const vxt_volume_view* volume) {
    return call([&] { take(io::writeVolume(toPath(path), toVolumeView(volume))); });
}

vxt_result vxt_read_mesh(const char* path, const vxt_mesh_read_options* options, vxt_mesh_data** data) {
    return create(data, [&] { return take(io::readMesh(toPath(path), toOptions(options))); });
}

vxt_result vxt_read_mesh_bytes(const char* name, const void* content, size_t bytes,
                               const vxt_mesh_read_options* options, vxt_mesh_data** data) {
    return create(data, [&] {
        return take(io::readMesh(toBytes(content, bytes, "content"), &need(name, "name"), toOptions(options)));
    });
}

vxt_result vxt_write_mesh(const char* path, const vxt_mesh_view* mesh) {
    return call([&] { take(io::writeMesh(toPath(path), toMeshView(mesh))); });
}

vxt_result vxt_grid_shear(const vxt_grid* grid, double* degrees, double* max_degrees) {
    return call([&] {
        need(degrees, "degrees") = io::shearDegrees(toGrid(need(grid, "grid")));
        if (max_degrees != nullptr) {
            *max_degrees = io::kMaxShear;
        }
    });
}

const char* vxt_grid_note(const vxt_grid* grid) {
    return keptNote([&] { return io::shearNote(toGrid(need(grid, "grid"))); });
}

const char* vxt_mesh_note(const vxt_mesh_facts* facts) {
    return keptNote([&] {
        MeshFacts of;
        of.rounding = need(facts, "facts").rounding;
        return io::roundingNote(of);
    });
}

vxt_result vxt_read_camera(const char* path, double clip_from_world[16]) {
    return call([&] { writeMat4(clip_from_world, take(io::readCamera(toPath(path))), "clip_from_world"); });
}

vxt_result vxt_read_poses(const char* path, const char* format, vxt_poses** poses) {
    return create(poses, [&] { return take(io::readPoses(toPath(path), toPoseFormat(format))); });
}

vxt_result vxt_pose_reader_open(const char* path, const char* format, vxt_pose_reader** reader) {
    return create(reader, [&] { return take(io::PoseReader::open(toPath(path), toPoseFormat(format))); });
}

vxt_result vxt_pose_reader_read(vxt_pose_reader* reader, double* poses, size_t most, size_t* count) {
    return call([&] {
        std::size_t& found = need(count, "count");
        found = 0;
        double& to = need(poses, "poses");
        std::vector<Mat4> matrices;
        static_cast<void>(take(need(reader, "reader").object.read(most, matrices)));
        found = matrices.size();
        std::memcpy(&to, matrices.data(), matrices.size() * sizeof(Mat4));
    });
}

void vxt_pose_reader_destroy(vxt_pose_reader* reader) {
    delete reader;
}

vxt_result vxt_read_colours(const char* path, vxt_colour_points** points) {
    return create(points, [&] {
        std::vector<vxt_colour_point> out;
        for (const ColourPoint& point : take(io::readColours(toPath(path)))) {
            out.push_back({point.value, {point.colour[0], point.colour[1], point.colour[2]}});
        }
        return out;
    });
}

const vxt_colour_point* vxt_colour_points_get(const vxt_colour_points* points, size_t* count) {
    return handOut(points == nullptr ? std::span<const vxt_colour_point>() : points->object, count);
}

void vxt_colour_points_destroy(vxt_colour_points* points) {
    delete points;
}

vxt_result vxt_write_png(const char* path, uint32_t width, uint32_t height, const void* rgba, size_t bytes) {
    return call([&] {
        const std::span<const std::byte> pixels = toBytes(rgba, bytes, "rgba");
        take(io::writePng(toPath(path), width, height,
                          {reinterpret_cast<const std::uint8_t*>(pixels.data()), pixels.size()}));
    });
}

vxt_result vxt_read_transfer_function(const char* path, vxt_control_points** points) {
    return create(points, [&] { return fromPoints(take(io::readTransferFunction(toPath(path)))); });
}

vxt_result vxt_parse_opacity(const char* text, vxt_control_points** points) {
    return create(points, [&] { return fromPoints(take(io::parseOpacity(&need(text, "text")))); });
}

vxt_result vxt_read_label_names(const char* path, vxt_label_names** names) {
    return create(names, [&] { return take(io::readLabelNames(toPath(path))); });
}

const char* vxt_label_names_get(const vxt_label_names* names, size_t index, int32_t* label) {
    if (names == nullptr || index >= names->object.size()) {
        return nullptr;
    }
    if (label != nullptr) {
        *label = names->object[index].label;
    }
    return names->object[index].name.c_str();
}

void vxt_label_names_destroy(vxt_label_names* names) {
    delete names;
}

vxt_result vxt_read_points(const char* path, vxt_points** points) {
    return create(points, [&] { return take(io::readPoints(toPath(path))); });
}

const char* vxt_points_get(const vxt_points* points, size_t index, double position[3], uint64_t* line) {
    if (points == nullptr || index >= points->object.size()) {
        return nullptr;
    }
    const io::NamedPoint& point = points->object[index];
    if (position != nullptr) {
        std::ranges::copy(point.position, position);
    }
    if (line != nullptr) {
        *line = point.line;
    }
    return point.name.c_str();
}

void vxt_points_destroy(vxt_points* points) {
    delete points;
}
