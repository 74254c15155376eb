// SPDX-License-Identifier: MIT
#include "render_reference.h"
#include "core/geometry/vec3.h"

#include "gpu_fixture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace voxtact::test {

namespace {

Vec3 operator+(const Vec3& a, const Vec3& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vec3 operator-(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec3 operator*(double s, const Vec3& a) {
    return {s * a[0], s * a[1], s * a[2]};
}
class Caster {
  public:
    explicit Caster(const ReferenceScene& scene)
        : scene_(scene), texture_from_world_(take(textureFromWorld(scene.volume->grid))),
          world_from_clip_(take(inverse(scene.clip_from_world))), opacity_(take(sampleTable(scene.function.opacity))) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            std::vector<ControlPoint> points;
            for (const ColourPoint& point : scene.function.colours) {
                points.push_back({point.value, point.colour[channel]});
            }
            colour_[channel] =
                take(sampleTable({points, scene.function.opacity.domain, scene.function.opacity.tableSize}));
        }
    }

    [[nodiscard]] Colour pixel(double clipX, double clipY) const {
        const Vec3 near = transformPoint(world_from_clip_, {clipX, clipY, 0});
        const Vec3 far = transformPoint(world_from_clip_, {clipX, clipY, 1});
        const double distance = length(far - near);
        const Vec3 direction = (1 / distance) * (far - near);
        const double mesh = meshDistance(near, direction);
        const double end = std::min(distance, mesh);
        Colour sum{};
        double seen = 1;
        const double step = scene_.function.step;
        const Part part = seenPart(near, direction);
        double cut = scene_.lighting.faces ? 1 : 0;
        for (double at = part.from; at < std::min(part.to, end); at += step) {
            const double piece = std::min(step, std::min(part.to, end) - at);
            const double behind = at + piece / 2 - part.from;
            const Vec3 world = near + (at + piece / 2) * direction;
            cut = std::min(cut, cutThrough(world));
            const double face = cut * std::clamp(2 - behind / faceDepth(), 0.0, 1.0);
            add(world, direction, piece, {part.normal, face}, sum, seen);
        }
        const Colour& behind = mesh < distance ? scene_.meshColour : scene_.background;
        return sum + seen * behind;
    }

  private:
    /// From where to where a ray is in what is seen, and the normal of where it comes in.
    struct Part {
        double from;
        double to;
        Vec3 normal;
    };
    struct Face {
        Vec3 normal;
        double share;
    };

    /// Half spaces, normal . p <= offset: six of the box, which may lean, and the clipping planes.
    [[nodiscard]] std::vector<ClipPlane> halfSpaces() const {
        std::vector<ClipPlane> all = scene_.clipPlanes;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Vec3 row{texture_from_world_[axis], texture_from_world_[4 + axis], texture_from_world_[8 + axis]};
            const double bias = texture_from_world_[12 + axis];
            all.push_back({row, 1 - bias});
            all.push_back({-1.0 * row, bias});
        }
        return all;
    }

    [[nodiscard]] Part seenPart(const Vec3& near, const Vec3& direction) const {
        Part part{0, std::numeric_limits<double>::infinity(), direction};
        for (const ClipPlane& plane : halfSpaces()) {
            const double slope = dot(plane.normal, direction);
            const double at = (plane.offset - dot(plane.normal, near)) / slope;
            if (slope > 0) {
                part.to = std::min(part.to, at);
            } else if (at > part.from) {
                part.from = at;
                part.normal = (1 / length(plane.normal)) * plane.normal;
            }
        }
        return part;
    }

    [[nodiscard]] double faceDepth() const {
        const Vec3& spacing = scene_.volume->grid.spacing;
        return 2 * std::max({spacing[0], spacing[1], spacing[2]});
    }

    [[nodiscard]] bool isThere(const Vec3& world) const {
        for (const ClipPlane& plane : halfSpaces()) {
            if (dot(plane.normal, world) > plane.offset) {
                return false;
            }
        }
        return true;
    }

    /// Of one millimetre.
    [[nodiscard]] double extinction(double s) const {
        return -std::log1p(-std::min(lookUp(opacity_, s), 0.999)) / scene_.function.opacityUnit;
    }

    /// Whole where what is as deep as a face hides half of what is behind it.
    [[nodiscard]] double cutThrough(const Vec3& world) const {
        const double s = scalar(transformPoint(texture_from_world_, world));
        return std::min(2 * -std::expm1(-extinction(s) * faceDepth()), 1.0);
    }

    /// The mean light that comes from a quarter, half, three quarters and all of the reach along a way outside.
    [[nodiscard]] double openness(const Vec3& world, const Vec3& normal) const {
        constexpr int kLooks = 4;
        const double part = scene_.lighting.reach / kLooks;
        double depth = 0;
        double sum = 0;
        for (int i = 1; i <= kLooks; ++i) {
            const Vec3 place = world + (i * part) * normal;
            if (isThere(place)) {
                depth += part * extinction(scalar(transformPoint(texture_from_world_, place)));
            }
            sum += std::exp(-depth);
        }
        return sum / kLooks;
    }

    /// Between a normal and the way to the eye.
    static Vec3 halfWay(const Vec3& normal, const Vec3& direction) {
        const Vec3 sum = normal - direction;
        return (1 / length(sum)) * sum;
    }

    /// Light on a surface with a normal of unit length, either way: what it makes of a colour, and what it adds.
    struct Light {
        double share;
        double glint;
    };
    [[nodiscard]] Light lightOn(const Vec3& normal, const Vec3& direction) const {
        const Lighting& light = scene_.lighting;
        const Vec3 right = alongPicture({-1, 0, 0}, {1, 0, 0});
        const Vec3 up = alongPicture({0, 1, 0}, {0, -1, 0});
        const Vec3 forward = alongPicture({0, 0, 0}, {0, 0, 1});
        Vec3 side = light.sideFrom[0] * right + light.sideFrom[1] * up - light.sideFrom[2] * forward;
        side = (1 / length(side)) * side;
        const Vec3 half = side - direction;
        double bySide = 0;
        double glint = 0;
        const double front = (1 + outside(normal, direction)) / 2;
        for (const auto& [weight, out] : {std::pair(front, normal), std::pair(1 - front, -1.0 * normal)}) {
            bySide += weight * std::max(dot(out, side), 0.0);
            glint += weight * std::pow(std::max(dot(out, half) / length(half), 0.0), light.shininess);
        }
        const double facing = std::abs(dot(normal, direction));
        return {light.ambient + light.diffuse * facing + light.side * bySide,
                light.specular * (std::pow(facing, light.shininess) + light.side * glint)};
    }
    /// 1: the normal points outside, -1: inside; between them within a cosine of a quarter from the silhouette.
    static double outside(const Vec3& normal, const Vec3& direction) {
        return std::clamp(-4 * dot(normal, direction), -1.0, 1.0);
    }
    [[nodiscard]] Vec3 alongPicture(const Vec3& from, const Vec3& to) const {
        const Vec3 way = transformPoint(world_from_clip_, to) - transformPoint(world_from_clip_, from);
        return (1 / length(way)) * way;
    }

    [[nodiscard]] double voxel(const std::array<int, 3>& at) const {
        const Grid& grid = scene_.volume->grid;
        std::size_t index = 0;
        for (std::size_t axis = 3; axis-- > 0;) {
            const int last = static_cast<int>(grid.size[axis]) - 1;
            index = index * grid.size[axis] + static_cast<std::size_t>(std::clamp(at[axis], 0, last));
        }
        if (scene_.volume->type == ScalarType::UInt8) {
            return std::to_integer<std::uint8_t>(scene_.volume->voxels[index]);
        }
        float value = 0;
        std::memcpy(&value, scene_.volume->voxels.data() + index * sizeof value, sizeof value);
        return value;
    }

    /// The normalised scalar.
    [[nodiscard]] double scalar(const Vec3& texture) const {
        std::array<int, 3> cell{};
        Vec3 weight{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double at = texture[axis] * scene_.volume->grid.size[axis] - 0.5;
            cell[axis] = static_cast<int>(std::floor(at));
            weight[axis] = at - cell[axis];
        }
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            double share = 1;
            std::array<int, 3> at = cell;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const int high = corner >> axis & 1;
                at[axis] += high;
                share *= high != 0 ? weight[axis] : 1 - weight[axis];
            }
            sum += share * voxel(at);
        }
        const ValueRange& domain = scene_.function.opacity.domain;
        return (sum - domain.lo) / (domain.hi - domain.lo);
    }

    static double lookUp(const std::vector<float>& table, double s) {
        const double last = static_cast<double>(table.size()) - 1;
        const double at = std::clamp(s * static_cast<double>(table.size()) - 0.5, 0.0, last);
        const auto below = static_cast<std::size_t>(std::min(std::floor(at), last - 1));
        const double weight = at - static_cast<double>(below);
        return table[below] + (static_cast<double>(table[below + 1]) - table[below]) * weight;
    }

    [[nodiscard]] Vec3 gradient(const Vec3& texture) const {
        Vec3 sum{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Vec3 h{};
            h[axis] = 1.0 / scene_.volume->grid.size[axis];
            const double slope = (scalar(texture + h) - scalar(texture - h)) / (2 * h[axis]);
            for (std::size_t c = 0; c < 3; ++c) {
                sum[c] += slope * texture_from_world_[4 * c + axis];
            }
        }
        return sum;
    }

    void add(const Vec3& world, const Vec3& direction, double part, const Face& face, Colour& sum, double& seen) const {
        const Vec3 texture = transformPoint(texture_from_world_, world);
        const double s = scalar(texture);
        const double opacity = std::min(lookUp(opacity_, s), 0.999);
        const double alpha = 1 - std::pow(1 - opacity, part / scene_.function.opacityUnit);
        if (alpha <= 0) {
            return;
        }
        Light light{1, 0};
        if (scene_.lighting.volume) {
            const Vec3 slope = gradient(texture);
            const bool isFlat = length(slope) < 1e-9;
            const Vec3 normal = isFlat ? direction : (1 / length(slope)) * slope;
            light = lightOn(normal, direction);
            const double open = isFlat ? 1 : openness(world, halfWay(outside(normal, direction) * normal, direction));
            const double left = 1 - scene_.lighting.occlusion * (1 - open);
            const Lighting& lights = scene_.lighting;
            const double facing = std::abs(dot(face.normal, direction));
            const Light onFace{std::min(lights.ambient + (lights.diffuse + lights.side) * facing, 1.0), 0};
            light = {(1 - face.share) * left * light.share + face.share * onFace.share,
                     (1 - face.share) * left * light.glint + face.share * onFace.glint};
        }
        for (std::size_t channel = 0; channel < 3; ++channel) {
            sum[channel] += seen * alpha * (lookUp(colour_[channel], s) * light.share + light.glint);
        }
        seen *= 1 - alpha;
    }

    [[nodiscard]] Vec3 vertex(std::size_t corner) const {
        const std::size_t at = std::size_t{3} * scene_.mesh->indices[corner];
        const std::vector<double>& p = scene_.mesh->positions;
        return transformPoint(scene_.world_from_object, {p[at], p[at + 1], p[at + 2]});
    }

    [[nodiscard]] bool isClipped(const Vec3& world) const {
        return std::ranges::any_of(scene_.clipPlanes,
                                   [&](const ClipPlane& plane) { return dot(plane.normal, world) > plane.offset; });
    }

    /// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
    [[nodiscard]] double meshDistance(const Vec3& origin, const Vec3& direction) const {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; scene_.mesh != nullptr && i < scene_.mesh->indices.size(); i += 3) {
            const Vec3 a = vertex(i);
            const Vec3 u = vertex(i + 1) - a;
            const Vec3 v = vertex(i + 2) - a;
            const Vec3 p = cross(direction, v);
            const double determinant = dot(u, p);
            if (determinant == 0) {
                continue;
            }
            const Vec3 t = origin - a;
            const Vec3 q = cross(t, u);
            const double s = dot(t, p) / determinant;
            const double r = dot(direction, q) / determinant;
            const double distance = dot(v, q) / determinant;
            const bool away = scene_.clippedMesh && isClipped(origin + distance * direction);
            if (s >= 0 && r >= 0 && s + r <= 1 && distance >= 0 && !away) {
                nearest = std::min(nearest, distance);
            }
        }
        return nearest;
    }

    const ReferenceScene& scene_;
    Mat4 texture_from_world_;
    Mat4 world_from_clip_;
    std::vector<float> opacity_;
    std::array<std::vector<float>, 3> colour_;
};

double difference(const Colour& a, const Colour& b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

} // namespace

ReferencePicture castReference(const ReferenceScene& scene, std::uint32_t width, std::uint32_t height) {
    const Caster caster(scene);
    ReferencePicture picture;
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            picture.push_back(caster.pixel(2 * (x + 0.5) / width - 1, 2 * (y + 0.5) / height - 1));
        }
    }
    return picture;
}

PictureError compare(const Picture& picture, const ReferencePicture& reference, double edge) {
    PictureError error;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        bool smooth = true;
        for (const std::size_t reach : {std::size_t{1}, std::size_t{picture.width}}) {
            smooth = smooth && (i < reach || difference(reference[i], reference[i - reach]) <= edge) &&
                     (i + reach >= reference.size() || difference(reference[i], reference[i + reach]) <= edge);
        }
        if (!smooth) {
            continue;
        }
        ++compared;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double is = picture.rgba[4 * i + channel] / 255.0;
            const double off = std::abs(is - std::clamp(reference[i][channel], 0.0, 1.0));
            error.mean += off;
            error.most = std::max(error.most, off);
        }
    }
    EXPECT_GT(compared, reference.size() / 2) << "too few pixels are left to compare";
    error.mean /= 3 * static_cast<double>(std::max<std::size_t>(compared, 1));
    return error;
}

} // namespace voxtact::test
