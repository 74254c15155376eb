// SPDX-License-Identifier: MIT
#include "cpu/judges/oracle_other.h"

#include "cpu/scenes/oracle_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace voxtact::test {

namespace {

using oracle::OracleFragment;

struct Vertex {
    float clip[4];
    float texture[3];
};

struct Corner {
    std::int64_t x, y; ///< 1/256 pixels
    float inverseW;
    float textureByW[3];
};

class Other {
  public:
    Other(const oracle::OraclePair& pair, const oracle::Tolerance& tolerance, std::mt19937& random)
        : pair_(pair), tolerance_(tolerance), random_(random), table_(sampleTable(pair.transferFunction).value()),
          clip_from_object_(multiply(pair.view.clip_from_world, pair.world_from_object)),
          texture_from_object_(multiply(textureFromWorld(pair.volume.grid).value(), pair.world_from_object)) {}

    std::vector<OracleFragment> survivors() {
        for (std::uint32_t t = 0; t < pair_.mesh.indices.size() / 3; ++t) {
            rasterise(t);
        }
        std::sort(out_.begin(), out_.end());
        out_.erase(std::unique(out_.begin(), out_.end()), out_.end());
        return out_;
    }

  private:
    Vertex shade(std::uint32_t index) const {
        const double* at = pair_.mesh.positions.data() + std::size_t{3} * index;
        const std::array<float, 3> p{static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])};
        const auto row = [p](const Mat4& m, std::size_t r) {
            float sum = static_cast<float>(m[r]) * p[0];
            sum += static_cast<float>(m[4 + r]) * p[1];
            sum += static_cast<float>(m[8 + r]) * p[2];
            return sum + static_cast<float>(m[12 + r]);
        };
        Vertex out{};
        for (std::size_t r = 0; r < 4; ++r) {
            out.clip[r] = row(clip_from_object_, r);
        }
        for (std::size_t r = 0; r < 3; ++r) {
            out.texture[r] = row(texture_from_object_, r);
        }
        return out;
    }

    template <class Depth> static std::vector<Vertex> clip(const std::vector<Vertex>& in, const Depth& depth) {
        std::vector<Vertex> out;
        for (std::size_t i = 0; i < in.size(); ++i) {
            const Vertex& a = in[i];
            const Vertex& b = in[(i + 1) % in.size()];
            if (depth(a) >= 0) {
                out.push_back(a);
            }
            if ((depth(a) >= 0) != (depth(b) >= 0)) {
                const float t = depth(a) / (depth(a) - depth(b));
                Vertex cut{};
                for (std::size_t k = 0; k < 4; ++k) {
                    cut.clip[k] = a.clip[k] + t * (b.clip[k] - a.clip[k]);
                }
                for (std::size_t k = 0; k < 3; ++k) {
                    cut.texture[k] = a.texture[k] + t * (b.texture[k] - a.texture[k]);
                }
                out.push_back(cut);
            }
        }
        return out;
    }

    Corner project(const Vertex& vertex) {
        // What the oracle's snapping and this one may take up together is not there for the jitter.
        const double most = std::max(0.0, tolerance_.pixels - std::numbers::sqrt2 / 256);
        const double angle = uniform(random_, 0, 2 * std::numbers::pi);
        const double jitter = random_() % 2 == 0 ? most : uniform(random_, 0, most);
        const float inverseW = 1.0F / vertex.clip[3];
        const float x = (vertex.clip[0] * inverseW * 0.5F + 0.5F) * static_cast<float>(pair_.view.width);
        const float y = (vertex.clip[1] * inverseW * 0.5F + 0.5F) * static_cast<float>(pair_.view.height);
        Corner out{};
        out.x = std::llround((static_cast<double>(x) + jitter * std::cos(angle)) * 256);
        out.y = std::llround((static_cast<double>(y) + jitter * std::sin(angle)) * 256);
        out.inverseW = inverseW;
        for (std::size_t k = 0; k < 3; ++k) {
            out.textureByW[k] = vertex.texture[k] * inverseW;
        }
        return out;
    }

    void rasterise(std::uint32_t triangle) {
        std::vector<Vertex> polygon;
        for (std::size_t i = 0; i < 3; ++i) {
            polygon.push_back(shade(pair_.mesh.indices[std::size_t{3} * triangle + i]));
        }
        polygon = clip(polygon, [](const Vertex& v) { return v.clip[2]; });
        polygon = clip(polygon, [](const Vertex& v) { return v.clip[3] - v.clip[2]; });
        std::vector<Corner> corners;
        for (const Vertex& vertex : polygon) {
            corners.push_back(project(vertex));
        }
        for (std::size_t i = 2; i < corners.size(); ++i) {
            fill(triangle, corners[0], corners[i - 1], corners[i]);
        }
    }

    static std::int64_t side(const Corner& a, const Corner& b, std::int64_t x, std::int64_t y) {
        return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    }

    static bool owns(const Corner& a, const Corner& b, std::int64_t value) {
        return value > 0 || (value == 0 && (b.y < a.y || (b.y == a.y && b.x > a.x)));
    }

    void fill(std::uint32_t triangle, const Corner& a, Corner b, Corner c) {
        if ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) < 0) {
            std::swap(b, c);
        }
        const auto first = [](std::int64_t least) { return std::max<std::int64_t>(0, (least - 128) / 256); };
        const std::int64_t x1 = std::min<std::int64_t>(pair_.view.width - 1, std::max({a.x, b.x, c.x}) / 256);
        const std::int64_t y1 = std::min<std::int64_t>(pair_.view.height - 1, std::max({a.y, b.y, c.y}) / 256);
        for (std::int64_t y = first(std::min({a.y, b.y, c.y})); y <= y1; ++y) {
            for (std::int64_t x = first(std::min({a.x, b.x, c.x})); x <= x1; ++x) {
                const std::int64_t sides[3] = {side(b, c, 256 * x + 128, 256 * y + 128),
                                               side(c, a, 256 * x + 128, 256 * y + 128),
                                               side(a, b, 256 * x + 128, 256 * y + 128)};
                if (owns(b, c, sides[0]) && owns(c, a, sides[1]) && owns(a, b, sides[2]) && survives(a, b, c, sides)) {
                    out_.push_back({triangle, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)});
                }
            }
        }
    }

    bool survives(const Corner& a, const Corner& b, const Corner& c, const std::int64_t* sides) {
        const auto area = static_cast<float>(sides[0] + sides[1] + sides[2]);
        const float u = static_cast<float>(sides[0]) / area;
        const float v = static_cast<float>(sides[1]) / area;
        const float w = static_cast<float>(sides[2]) / area;
        const float inverse = u * a.inverseW + v * b.inverseW + w * c.inverseW;
        float coordinate[3];
        for (std::size_t k = 0; k < 3; ++k) {
            coordinate[k] = (u * a.textureByW[k] + v * b.textureByW[k] + w * c.textureByW[k]) / inverse;
            if (!(coordinate[k] >= 0 && coordinate[k] <= 1)) {
                return false;
            }
        }
        const float width = static_cast<float>(pair_.transferFunction.domain.hi - pair_.transferFunction.domain.lo);
        const float value = sample(coordinate) + static_cast<float>(off(tolerance_.value));
        const float scalar = (value - static_cast<float>(pair_.transferFunction.domain.lo)) / width;
        return lookUp(scalar) >= static_cast<float>(pair_.threshold);
    }

    double off(double most) {
        return random_() % 2 == 0 ? uniform(random_, -most, most) : random_() % 4 < 2 ? -most : most;
    }

    float voxel(const int* index) const {
        std::size_t at = 0;
        for (std::size_t k = 3; k-- > 0;) {
            const int last = static_cast<int>(pair_.volume.grid.size[k]) - 1;
            at = at * pair_.volume.grid.size[k] + static_cast<std::size_t>(std::clamp(index[k], 0, last));
        }
        const std::byte* bytes = pair_.volume.voxels.data() + at * bytesPerVoxel(pair_.volume.type);
        std::int16_t i16 = 0;
        std::uint16_t u16 = 0;
        float f32 = 0;
        switch (pair_.volume.type) {
        case ScalarType::UInt8:
            return static_cast<float>(std::to_integer<int>(*bytes));
        case ScalarType::Int16:
            std::memcpy(&i16, bytes, 2);
            return i16;
        case ScalarType::UInt16:
            std::memcpy(&u16, bytes, 2);
            return u16;
        case ScalarType::Float32:
            break;
        }
        std::memcpy(&f32, bytes, 4);
        return f32;
    }

    float sample(const float* coordinate) {
        int base[3];
        float fraction[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const float index = coordinate[k] * static_cast<float>(pair_.volume.grid.size[k]) - 0.5F;
            base[k] = static_cast<int>(std::floor(index));
            const float weight = index - static_cast<float>(base[k]) + static_cast<float>(off(tolerance_.weight));
            fraction[k] = std::clamp(weight, 0.0F, 1.0F);
        }
        return along(2, base, fraction);
    }

    float along(std::size_t axis, const int* base, const float* fraction) const {
        int index[3] = {base[0], base[1], base[2]};
        float ends[2];
        for (float& end : ends) {
            end = axis == 0 ? voxel(index) : along(axis - 1, index, fraction);
            ++index[axis];
        }
        return ends[0] + fraction[axis] * (ends[1] - ends[0]);
    }

    float lookUp(float scalar) {
        const auto last = static_cast<float>(table_.size() - 1);
        const float at = std::clamp(scalar * static_cast<float>(table_.size()) - 0.5F, 0.0F, last);
        const float below = std::min(std::floor(at), last - 1);
        const float weight = std::clamp(at - below + static_cast<float>(off(tolerance_.weight)), 0.0F, 1.0F);
        const float a = table_[static_cast<std::size_t>(below)];
        return a + weight * (table_[static_cast<std::size_t>(below) + 1] - a);
    }

    const oracle::OraclePair& pair_;
    oracle::Tolerance tolerance_;
    std::mt19937& random_;
    std::vector<float> table_;
    Mat4 clip_from_object_;
    Mat4 texture_from_object_;
    std::vector<OracleFragment> out_;
};

} // namespace

std::vector<oracle::OracleFragment> otherSurvivors(const oracle::OraclePair& pair, const oracle::Tolerance& tolerance,
                                                   std::mt19937& random) {
    return Other(pair, tolerance, random).survivors();
}

} // namespace voxtact::test
