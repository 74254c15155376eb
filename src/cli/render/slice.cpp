// SPDX-License-Identifier: MIT
#include "cli/render/slice.h"
#include "core/geometry/vec3.h"

#include "cli/draw/canvas.h"
#include "cli/options/shared_options.h"
#include "cli/output/outcome.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/volume/voxel_visit.h"

#include <algorithm>
#include <cmath>

namespace voxtact::app {

namespace {

constexpr std::size_t kChannels = 4;

struct Named {
    const char* name;
    ViewDirection direction; ///< radiological: from the feet, the face, the left ear
    std::size_t axis;
};
constexpr Named kNamed[] = {{"axial", {0, -90}, 2}, {"coronal", {0, 0}, 1}, {"sagittal", {90, 0}, 0}};
constexpr const char* kView = "view";

const Named* named(const std::string& name) {
    const auto* found = std::ranges::find_if(kNamed, [&](const Named& one) { return name == one.name; });
    return found != std::end(kNamed) ? found : nullptr;
}

/// Trilinear values of a volume; the border voxels extend outwards.
template <class Voxel> class Sampler {
  public:
    Sampler(const Grid& grid, const Voxel* voxels) : grid_(grid), voxels_(voxels) {}

    [[nodiscard]] double operator()(const Vec3& texture) const {
        std::array<std::size_t, 3> low{};
        std::array<std::size_t, 3> high{};
        Vec3 weight{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double last = grid_.size[axis] - 1.0;
            const double at = std::clamp(texture[axis] * grid_.size[axis] - 0.5, 0.0, last);
            low[axis] = static_cast<std::size_t>(at);
            high[axis] = std::min(low[axis] + 1, static_cast<std::size_t>(last));
            weight[axis] = at - static_cast<double>(low[axis]);
        }
        double sum = 0;
        for (unsigned corner = 0; corner < 8; ++corner) {
            double share = 1;
            std::size_t index = 0;
            for (std::size_t axis = 3; axis-- > 0;) {
                const bool up = (corner >> axis & 1U) != 0;
                share *= up ? weight[axis] : 1 - weight[axis];
                index = index * grid_.size[axis] + (up ? high[axis] : low[axis]);
            }
            sum += share * static_cast<double>(voxels_[index]);
        }
        return sum;
    }

  private:
    const Grid& grid_;
    const Voxel* voxels_;
};

/// Opacities of values, looked up like a detector does.
class Opacities {
  public:
    Opacities(std::vector<float> table, const ValueRange& domain) : table_(std::move(table)), domain_(domain) {}

    [[nodiscard]] double operator()(double value) const {
        const double last = static_cast<double>(table_.size()) - 1;
        const double scalar = (value - domain_.lo) / (domain_.hi - domain_.lo);
        const double at = std::clamp(scalar * static_cast<double>(table_.size()) - 0.5, 0.0, last);
        const auto low = static_cast<std::size_t>(at);
        const std::size_t high = std::min(low + 1, table_.size() - 1);
        const double weight = at - static_cast<double>(low);
        return (1 - weight) * static_cast<double>(table_[low]) + weight * static_cast<double>(table_[high]);
    }

  private:
    std::vector<float> table_;
    ValueRange domain_;
};

bool isInside(const Vec3& texture) {
    return std::ranges::all_of(texture, [](double x) { return x >= 0 && x <= 1; });
}

/// Draws a slice of voxels of one type.
template <class Voxel> class SliceMaker {
  public:
    SliceMaker(const SliceScene& scene, VkExtent2D size, const Voxel* voxels, const Mat4& texture_from_world,
               const Mat4& world_from_clip, std::optional<Opacities> opacities)
        : scene_(scene), size_(size), sampler_(scene.volume->grid, voxels), texture_from_world_(texture_from_world),
          world_from_clip_(world_from_clip), opacities_(std::move(opacities)) {}

    Picture make() {
        Picture picture{size_.width, size_.height, {}};
        picture.rgba.resize(kChannels * size_.width * size_.height, 255);
        for (std::uint32_t y = 0; y < size_.height; ++y) {
            for (std::uint32_t x = 0; x < size_.width; ++x) {
                const Colour colour = colourAt(x + 0.5, y + 0.5);
                for (std::size_t channel = 0; channel < colour.size(); ++channel) {
                    picture.rgba[kChannels * (std::size_t{size_.width} * y + x) + channel] =
                        static_cast<std::uint8_t>(std::lround(255 * colour[channel]));
                }
            }
        }
        Canvas canvas(picture.rgba, size_.width, size_.height);
        for (const SliceMesh& mesh : scene_.meshes) {
            drawMesh(canvas, mesh);
        }
        return picture;
    }

  private:
    [[nodiscard]] Vec3 worldAt(double x, double y) const {
        const Vec3 point = transformPoint(world_from_clip_, {2 * x / size_.width - 1, 2 * y / size_.height - 1, 0.5});
        const Vec3& normal = scene_.plane.towardsEye;
        const double off = scene_.plane.offset - dot(normal, point);
        return {point[0] + off * normal[0], point[1] + off * normal[1], point[2] + off * normal[2]};
    }
    [[nodiscard]] bool isOpaque(const Vec3& texture) const {
        return opacities_ && isInside(texture) && (*opacities_)(sampler_(texture)) >= scene_.threshold;
    }
    [[nodiscard]] Colour colourAt(double x, double y) const {
        const Vec3 texture = transformPoint(texture_from_world_, worldAt(x, y));
        if (!isInside(texture)) {
            return scene_.background;
        }
        const double value = sampler_(texture);
        const ValueRange& window = scene_.window;
        const double gray = std::clamp((value - window.lo) / (window.hi - window.lo), 0.0, 1.0);
        if (!opacities_ || (*opacities_)(value) < scene_.threshold) {
            return {gray, gray, gray};
        }
        constexpr Colour kTint{0.95, 0.72, 0.35};
        constexpr double kShare = 0.22;
        return {gray + kShare * (kTint[0] - gray), gray + kShare * (kTint[1] - gray),
                gray + kShare * (kTint[2] - gray)};
    }

    [[nodiscard]] Point pixelOf(const Vec3& world) const {
        const Vec3 clip = transformPoint(scene_.clip_from_world, world);
        return {(clip[0] + 1) / 2 * size_.width, (clip[1] + 1) / 2 * size_.height};
    }

    void drawMesh(Canvas& canvas, const SliceMesh& mesh) const {
        const std::vector<double>& positions = mesh.mesh->positions;
        std::vector<bool> touching(mesh.mesh->indices.size() / 3);
        for (const std::uint32_t triangle : mesh.touching) {
            touching[triangle] = true;
        }
        for (std::size_t triangle = 0; triangle < touching.size(); ++triangle) {
            std::array<Vec3, 3> corners{};
            Vec3 side{};
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t at = std::size_t{3} * mesh.mesh->indices[3 * triangle + i];
                corners[i] =
                    transformPoint(mesh.world_from_object, {positions[at], positions[at + 1], positions[at + 2]});
                side[i] = dot(scene_.plane.towardsEye, corners[i]) - scene_.plane.offset;
            }
            std::vector<Vec3> ends;
            Colour colour{};
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t next = (i + 1) % 3;
                if ((side[i] < 0) == (side[next] < 0)) {
                    continue;
                }
                const double t = side[i] / (side[i] - side[next]);
                Vec3 end{};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    end[axis] = corners[i][axis] + t * (corners[next][axis] - corners[i][axis]);
                }
                ends.push_back(end);
                for (std::size_t channel = 0; channel < colour.size() && !mesh.vertices.empty(); ++channel) {
                    const double here = mesh.vertices[mesh.mesh->indices[3 * triangle + i]][channel];
                    const double there = mesh.vertices[mesh.mesh->indices[3 * triangle + next]][channel];
                    colour[channel] += (here + t * (there - here)) / 2;
                }
            }
            if (ends.size() == 2) {
                drawCut(canvas, ends[0], ends[1], mesh.vertices.empty() ? mesh.colour : colour, touching[triangle]);
            }
        }
    }

    /// Draws the cut of a triangle; where colours vary, in pieces of a pixel.
    void drawCut(Canvas& canvas, const Vec3& from, const Vec3& to, const Colour& plain, bool touching) const {
        const Point a = pixelOf(from);
        const Point b = pixelOf(to);
        const double pixels = std::hypot(b.x - a.x, b.y - a.y);
        const double reach = std::max({std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y)});
        constexpr double kFarAway = 1e5; // pictures: farther geometry is not drawn
        if (!(reach < kFarAway)) {
            return;
        }
        const int pieces = opacities_ ? std::max(1, static_cast<int>(std::ceil(pixels))) : 1;
        for (int i = 0; i < pieces; ++i) {
            const double begin = static_cast<double>(i) / pieces;
            const double end = (i + 1.0) / pieces;
            const double middle = (begin + end) / 2;
            Vec3 at{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                at[axis] = from[axis] + middle * (to[axis] - from[axis]);
            }
            const bool contact = touching || isOpaque(transformPoint(texture_from_world_, at));
            const Colour& colour = contact ? scene_.contactColour : scene_.elsewhere.value_or(plain);
            const auto along = [&](double t) { return Point{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; };
            // Round ends: pieces of one outline leave no gaps.
            canvas.line(along(begin), along(end), scene_.thickness, colour);
            canvas.dot(along(end), scene_.thickness, colour);
        }
    }

    const SliceScene& scene_;
    VkExtent2D size_;
    Sampler<Voxel> sampler_;
    Mat4 texture_from_world_;
    Mat4 world_from_clip_;
    std::optional<Opacities> opacities_;
};

} // namespace

std::optional<std::string> parseSlice(const std::string& text, SliceOption& slice) {
    slice = {};
    slice.text = text;
    const std::size_t colon = text.find(':');
    slice.name = text.substr(0, colon);
    if (slice.name != kView && named(slice.name) == nullptr) {
        return "is not NAME[:MM] with axial, coronal, sagittal or view";
    }
    if (colon != std::string::npos) {
        slice.at = parseFinite(std::string_view(text).substr(colon + 1));
        if (!slice.at) {
            return "has no number (mm) after its colon";
        }
    }
    return std::nullopt;
}

Result<SlicePlane> slicePlane(const SliceOption& slice, const ViewDirection& view, const Grid& grid,
                              const std::optional<Box>& mesh) {
    const Named* one = named(slice.name);
    SlicePlane plane;
    plane.direction = one != nullptr ? one->direction : view;
    plane.towardsEye = towardsEye(plane.direction);
    // Coordinate of --slice: world, or from the volume's middle towards the eye.
    const Vec3 middle = transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5});
    const double sign = one != nullptr && plane.towardsEye[one->axis] < 0 ? -1 : 1;
    const double zero = one != nullptr ? 0 : dot(plane.towardsEye, middle);
    ValueRange reach{0, 0};
    for (unsigned corner = 0; corner < 8; ++corner) {
        const double along =
            dot(plane.towardsEye,
                transformPoint(worldFromTexture(grid), {(corner & 1U) != 0 ? 1.0 : 0.0, (corner & 2U) != 0 ? 1.0 : 0.0,
                                                        (corner & 4U) != 0 ? 1.0 : 0.0}));
        const double shown = sign * (along - zero);
        reach =
            corner == 0 ? ValueRange{shown, shown} : ValueRange{std::min(reach.lo, shown), std::max(reach.hi, shown)};
    }
    const auto shownAt = [&](const Vec3& point) { return sign * (dot(plane.towardsEye, point) - zero); };
    plane.shown = shownAt(middle);
    if (mesh) {
        const double at = shownAt(
            {(mesh->lo[0] + mesh->hi[0]) / 2, (mesh->lo[1] + mesh->hi[1]) / 2, (mesh->lo[2] + mesh->hi[2]) / 2});
        plane.shown = at >= reach.lo && at <= reach.hi ? at : plane.shown;
    }
    plane.shown = slice.at.value_or(plane.shown);
    if (!(plane.shown >= reach.lo && plane.shown <= reach.hi)) {
        const auto tenth = [](double x) { return number(std::round(10 * x) / 10); };
        return badArgument("--slice " + slice.text + " is outside the volume, which reaches from " + tenth(reach.lo) +
                           " to " + tenth(reach.hi) + " mm");
    }
    plane.offset = zero + sign * plane.shown;
    return plane;
}

Result<Picture> makeSlice(const SliceScene& scene, VkExtent2D size) {
    const Result<Mat4> texture_from_world = textureFromWorld(scene.volume->grid);
    VOXTACT_TRY(texture_from_world);
    const Result<Mat4> world_from_clip = inverse(scene.clip_from_world);
    VOXTACT_TRY(world_from_clip);
    std::optional<Opacities> opacities;
    if (scene.transferFunction) {
        Result<std::vector<float>> table = sampleTable(*scene.transferFunction);
        VOXTACT_TRY(table);
        opacities.emplace(std::move(*table), scene.transferFunction->domain);
    }
    return visitVoxels(scene.volume->view(), [&](const auto* voxels) {
        return SliceMaker(scene, size, voxels, *texture_from_world, *world_from_clip, opacities).make();
    });
}

ValueRange usualWindow(const VolumeView& volume, const ValueRange& values) {
    constexpr std::size_t kMaxVoxels = 1 << 20; // to sample
    constexpr double kDark = 0.005;
    constexpr double kBright = 0.997;
    std::vector<double> seen;
    visitVoxels(volume, [&](const auto* voxels) {
        const auto count = static_cast<std::size_t>(voxelCount(volume.grid));
        const std::size_t step = count / kMaxVoxels + 1;
        for (std::size_t i = 0; i < count; i += step) {
            seen.push_back(static_cast<double>(voxels[i]));
        }
    });
    const auto part = [&](double share) {
        const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(seen.size() - 1));
        std::ranges::nth_element(seen, seen.begin() + at);
        return seen[static_cast<std::size_t>(at)];
    };
    ValueRange window{part(kDark), part(kBright)};
    window = window.lo < window.hi ? window : values;
    return window.lo < window.hi ? window : ValueRange{window.lo - 1, window.lo + 1};
}

} // namespace voxtact::app
