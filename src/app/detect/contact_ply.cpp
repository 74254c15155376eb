// SPDX-License-Identifier: MIT
#include "app/detect/detect_files.h"
#include "app/output/standard_streams.h"
#include "core/base/text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <ostream>

namespace voxtact::app {

namespace {

static_assert(std::endian::native == std::endian::little, "PLY is written as the bytes lie in memory");

using Colour = std::array<std::uint8_t, 3>;

/// viridis (van der Walt, Smith, Firing, matplotlib 1.5, CC0) at every eighth: lightness rises evenly.
constexpr std::array<Colour, 9> kViridis{{{68, 1, 84},
                                          {71, 44, 122},
                                          {59, 81, 139},
                                          {44, 113, 142},
                                          {33, 144, 141},
                                          {39, 173, 129},
                                          {92, 200, 99},
                                          {170, 220, 50},
                                          {253, 231, 37}}};

/// `share`: 0 to 1 along the map.
Colour colourAt(double share) {
    const double place = std::clamp(share, 0.0, 1.0) * (kViridis.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), kViridis.size() - 2);
    const double part = place - static_cast<double>(below);
    Colour colour{};
    for (std::size_t i = 0; i < colour.size(); ++i) {
        colour[i] =
            static_cast<std::uint8_t>(std::lround(kViridis[below][i] * (1 - part) + kViridis[below + 1][i] * part));
    }
    return colour;
}

template <class Number> void append(std::string& bytes, Number number) {
    char raw[sizeof number];
    std::memcpy(raw, &number, sizeof raw);
    bytes.append(raw, sizeof raw);
}

void append(std::string& bytes, const Vec3& vector) {
    for (const double component : vector) {
        append(bytes, static_cast<float>(component));
    }
}

std::string headerOf(const DetectOptions& options, std::size_t contacts) {
    std::string text = "ply\nformat binary_little_endian 1.0\n"
                       "comment contacts by voxtact; world, mm, LPS (+x left, +y posterior, +z superior)\n"
                       "comment colour: depth from 0 (dark violet) to " +
                       number(options.extra.outputs().maxDepth) + " mm and more (yellow), viridis\n";
    for (std::size_t i = 0; i < options.jobs.meshes.size(); ++i) {
        text += "comment mesh " + std::to_string(i) + " " + oneLine(options.jobs.meshes[i]) + "\n";
    }
    for (std::size_t i = 0; i < options.jobs.volumes.size(); ++i) {
        text += "comment volume " + std::to_string(i) + " " + oneLine(options.jobs.volumes[i]) + "\n";
    }
    text += "element vertex " + std::to_string(contacts) + "\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
        text += std::string("property float ") + name + "\n";
    }
    for (const char* name : {"red", "green", "blue"}) {
        text += std::string("property uchar ") + name + "\n";
    }
    for (const char* name : {"depth", "value", "opacity"}) {
        text += std::string("property float ") + name + "\n";
    }
    text += "property int label\n";
    for (const char* name : {"pose", "triangle", "mesh", "volume"}) {
        text += std::string("property uint ") + name + "\n";
    }
    return text + "end_header\n";
}

} // namespace

void writeContactsPly(std::ostream& out, const DetectOptions& options, const DetectInputs& /*inputs*/,
                      const ContactList& list) {
    out << headerOf(options, list.contacts.size());
    std::string bytes;
    for (const KeptContact& kept : list.contacts) {
        const Contact& contact = kept.contact;
        const Job& job = options.jobs.jobs[kept.job];
        bytes.clear();
        append(bytes, contact.position);
        append(bytes, contact.normal);
        for (const std::uint8_t component : colourAt(contact.depth / options.extra.outputs().maxDepth)) {
            append(bytes, component);
        }
        append(bytes, static_cast<float>(contact.depth));
        append(bytes, static_cast<float>(contact.value));
        append(bytes, static_cast<float>(contact.opacity));
        append(bytes, contact.label);
        for (const std::uint32_t number :
             {static_cast<std::uint32_t>(kept.pose), contact.triangle, job.mesh, job.volume}) {
            append(bytes, number);
        }
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
}

} // namespace voxtact::app
