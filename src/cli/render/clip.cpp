// SPDX-License-Identifier: MIT
#include "cli/render/clip.h"
#include "core/base/infinity.h"
#include "core/geometry/vec3.h"

#include "cli/options/shared_options.h"
#include "cli/output/outcome.h"
#include "cli/output/standard_streams.h"
#include "cli/render/orientation.h"
#include "core/base/text.h"

#include <algorithm>
#include <cmath>

namespace voxtact::app {

namespace {

constexpr const char* kNear = "near";

bool isSide(const std::string& name) {
    return clipSide(name, std::nullopt, {}, {0, 0, 1}).has_value();
}

/// Parses four comma-separated numbers.
std::optional<ClipPlane> parsePlane(std::string_view text) {
    std::vector<double> numbers;
    while (true) {
        const std::size_t comma = text.find(',');
        const auto number = parseFinite(text.substr(0, comma));
        if (!number) {
            return std::nullopt;
        }
        numbers.push_back(*number);
        if (comma == std::string_view::npos) {
            break;
        }
        text.remove_prefix(comma + 1);
    }
    constexpr std::size_t kNumbers = 4;
    return numbers.size() == kNumbers ? std::optional<ClipPlane>({{numbers[0], numbers[1], numbers[2]}, numbers[3]})
                                      : std::nullopt;
}

ClipPlane planeOf(const ClipOption& clip, const Grid& grid, const Vec3& towardsEye) {
    if (clip.side.empty()) {
        return clip.plane;
    }
    return clipSide(clip.side, clip.at, grid, towardsEye).value_or(ClipPlane{});
}

/// Returns the range of the volume's corners along a normal.
ValueRange reachAlong(const Vec3& normal, const Grid& grid) {
    const Mat4 world_from_texture = worldFromTexture(grid);
    ValueRange reach{kInfinity, -kInfinity};
    for (unsigned corner = 0; corner < 8; ++corner) {
        const double along = dot(
            normal, transformPoint(world_from_texture, {(corner & 1U) != 0 ? 1.0 : 0.0, (corner & 2U) != 0 ? 1.0 : 0.0,
                                                        (corner & 4U) != 0 ? 1.0 : 0.0}));
        reach = {std::min(reach.lo, along), std::max(reach.hi, along)};
    }
    return reach;
}

/// Returns the planes that bound the remaining volume, in texture coordinates, each moved inwards slightly: the faces
/// of the volume, then the clipping planes.
std::vector<ClipPlane> boundsInTexture(const std::vector<ClipPlane>& planes, const Grid& grid) {
    constexpr double kInwards = 1e-9; // relative to the extent of the volume along the normal
    const Mat4 world_from_texture = worldFromTexture(grid);
    const Vec3 origin = transformPoint(world_from_texture, {0, 0, 0});
    std::vector<ClipPlane> bounds{{{1, 0, 0}, 1},  {{0, 1, 0}, 1},  {{0, 0, 1}, 1},
                                  {{-1, 0, 0}, 0}, {{0, -1, 0}, 0}, {{0, 0, -1}, 0}};
    for (const ClipPlane& plane : planes) {
        Vec3 normal{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t column = 4 * axis;
            normal[axis] = dot(plane.normal, {world_from_texture[column], world_from_texture[column + 1],
                                              world_from_texture[column + 2]});
        }
        const ValueRange reach = reachAlong(plane.normal, grid);
        bounds.push_back({normal, plane.offset - dot(plane.normal, origin) - kInwards * (reach.hi - reach.lo)});
    }
    return bounds;
}

/// Returns true if a part of the volume is within all planes: a bounded part has a corner where three of them meet.
bool leaveSomething(const std::vector<ClipPlane>& planes, const Grid& grid) {
    const std::vector<ClipPlane> bounds = boundsInTexture(planes, grid);
    constexpr double kRounding = 1e-12;
    const auto isWithin = [&](const Vec3& point) {
        return std::ranges::all_of(bounds, [&](const ClipPlane& plane) {
            const double size = std::abs(plane.normal[0]) + std::abs(plane.normal[1]) + std::abs(plane.normal[2]);
            return dot(plane.normal, point) <= plane.offset + kRounding * size;
        });
    };
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        for (std::size_t j = i + 1; j < bounds.size(); ++j) {
            for (std::size_t k = j + 1; k < bounds.size(); ++k) {
                const Vec3 along = cross(bounds[j].normal, bounds[k].normal);
                const Vec3 ki = cross(bounds[k].normal, bounds[i].normal);
                const Vec3 ij = cross(bounds[i].normal, bounds[j].normal);
                const double volume = dot(bounds[i].normal, along);
                if (volume == 0) {
                    continue; // no single common point
                }
                Vec3 point{};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    point[axis] =
                        (bounds[i].offset * along[axis] + bounds[j].offset * ki[axis] + bounds[k].offset * ij[axis]) /
                        volume;
                }
                if (isWithin(point)) {
                    return true;
                }
            }
        }
    }
    return false;
}

/// Returns the range of the volume along a clipping plane's coordinate, as text.
std::string whereItIs(const ClipOption& clip, const Grid& grid, const Vec3& normal, const ValueRange& reach) {
    const auto from = [](double lo, double hi) {
        return "from " + number(std::round(10 * lo) / 10) + " to " + number(std::round(10 * hi) / 10) + " mm";
    };
    if (clip.side.empty()) {
        return "the volume's offsets along that normal are " + from(reach.lo, reach.hi);
    }
    if (clip.side == kNear) {
        const double middle = dot(normal, transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5}));
        return "the volume reaches " + from(reach.lo - middle, reach.hi - middle) + " towards the eye";
    }
    const bool negative = std::ranges::any_of(normal, [](double component) { return component < 0; });
    return "there, the volume reaches " + (negative ? from(-reach.hi, -reach.lo) : from(reach.lo, reach.hi));
}

} // namespace

std::optional<std::string> parseClip(const std::string& text, ClipOption& clip) {
    clip = {};
    clip.text = text;
    if (const auto plane = parsePlane(text)) {
        if (plane->normal == Vec3{0, 0, 0}) {
            return "has a normal of length 0";
        }
        clip.plane = *plane;
        return std::nullopt;
    }
    const std::size_t colon = text.find(':');
    clip.side = text.substr(0, colon);
    if (!isSide(clip.side)) {
        return "is neither SIDE[:MM], with left, right, front, back, top, bottom or near, nor NX,NY,NZ,D";
    }
    if (colon != std::string::npos) {
        clip.at = parseFinite(std::string_view(text).substr(colon + 1));
        if (!clip.at) {
            return "has no number (mm) after its colon";
        }
    }
    return std::nullopt;
}

Result<std::vector<ClipPlane>> clipPlanes(const std::vector<ClipOption>& clips, const Grid& grid,
                                          const Mat4& clip_from_world) {
    const std::optional<ScreenAxes> axes = screenAxes(clip_from_world);
    const Vec3 towardsEye = axes ? axes->towardsEye : Vec3{0, 0, 1};
    std::vector<ClipPlane> planes;
    for (const ClipOption& clip : clips) {
        const ClipPlane plane = planeOf(clip, grid, towardsEye);
        const ValueRange reach = reachAlong(plane.normal, grid);
        if (plane.offset <= reach.lo) {
            return badArgument("--clip " + clip.text +
                               " removes the whole volume: " + whereItIs(clip, grid, plane.normal, reach));
        }
        if (plane.offset >= reach.hi) {
            printNote("--clip " + clip.text +
                      " removes nothing of the volume: " + whereItIs(clip, grid, plane.normal, reach));
        }
        planes.push_back(plane);
    }
    if (planes.size() > 1 && !leaveSomething(planes, grid)) {
        std::string all;
        for (const ClipOption& clip : clips) {
            all += (all.empty() ? "--clip " : ", --clip ") + clip.text;
        }
        return badArgument(all + ": together they remove the whole volume");
    }
    return planes;
}

} // namespace voxtact::app
