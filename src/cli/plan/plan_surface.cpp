// SPDX-License-Identifier: MIT
#include "cli/plan/plan_colours.h"
#include "cli/plan/plan_run.h"
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

} // namespace

void writePlanSurface(std::ostream& out, const PlanAnswer& answer, bool certified, double maximum) {
    out << "ply\nformat binary_little_endian 1.0\n"
           "comment entries by voxtact; world, mm, LPS (+x left, +y posterior, +z superior)\n"
           "comment colour of safe paths: distance from 0 (dark violet) to "
        << number(maximum) << " mm (yellow), viridis; unsafe: red; undecided: grey\n"
        << (certified ? "comment a face is safe where every path from it is\n"
                      : "comment faces are not certified: paths of a mesh are decided one by one\n")
        << "element vertex " << answer.paths.size()
        << "\nproperty float x\nproperty float y\nproperty float z\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\n"
           "property float clearance\nproperty uint entry\nproperty uchar safe\nelement face "
        << answer.triangles.size() << "\nproperty list uchar uint vertex_indices\nproperty uchar safe\nend_header\n";
    std::string bytes;
    for (const PlannedPath& path : answer.paths) {
        bytes.clear();
        for (const double component : path.position) {
            append(bytes, static_cast<float>(component));
        }
        for (const std::uint8_t component : planColour(path, maximum)) {
            append(bytes, component);
        }
        append(bytes, roundedDown(path.clearance.lower));
        append(bytes, path.entry);
        append(bytes, static_cast<std::uint8_t>(path.safety));
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
    for (const EntryTriangle& triangle : answer.triangles) {
        bytes.clear();
        append(bytes, static_cast<std::uint8_t>(triangle.paths.size()));
        for (const std::uint32_t corner : triangle.paths) {
            append(bytes, corner);
        }
        append(bytes, static_cast<std::uint8_t>(triangle.safe ? 1 : 0));
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
}

} // namespace voxtact::app
