// SPDX-License-Identifier: MIT
#include "cli/draw/viridis.h"
#include "cli/files/pair_files.h"
#include "cli/output/standard_streams.h"
#include "core/base/text.h"

#include <bit>
#include <cstring>
#include <ostream>

namespace voxtact::app {

namespace {

static_assert(std::endian::native == std::endian::little, "PLY is written as the bytes lie in memory");

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

std::string headerOf(const PairOptions& options, std::size_t contacts) {
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

void writeContactsPly(std::ostream& out, const PairOptions& options, const PairInputs& /*inputs*/,
                      const ContactList& list) {
    out << headerOf(options, list.contacts.size());
    std::string bytes;
    for (const KeptContact& kept : list.contacts) {
        const Contact& contact = kept.contact;
        const Job& job = options.jobs.jobs[kept.job];
        bytes.clear();
        append(bytes, contact.position);
        append(bytes, contact.normal);
        for (const std::uint8_t component : viridis(contact.depth / options.extra.outputs().maxDepth)) {
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
