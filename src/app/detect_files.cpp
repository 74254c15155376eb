// SPDX-License-Identifier: MIT
#include "app/detect_files.h"

#include "core/text.h"

#include <cmath>
#include <ostream>

namespace voxtact::app {

namespace {

/// A nanometre: more digits say nothing.
constexpr double kParts = 1e6;

std::string rounded(double value) {
    return number(std::round(value * kParts) / kParts + 0.0);
}

std::string rounded(const Vec3& vector) {
    return rounded(vector[0]) + ',' + rounded(vector[1]) + ',' + rounded(vector[2]);
}

bool hasSeveral(const DetectOptions& options) {
    return options.meshes.sources.size() > 1 || options.volumes.size() > 1;
}

/// ",mesh,volume" of a row.
std::string sourcesOf(const DetectOptions& options, const Row& row) {
    return "," + csvField(options.meshes.sources[row.timed.item]) + "," + csvField(options.volumes[row.volume]);
}

} // namespace

void writeTriangles(std::ostream& out, const DetectOptions& options, const DetectRun& run) {
    const bool several = hasSeveral(options);
    out << "pose,triangle,count" << (several ? ",mesh,volume\n" : "\n");
    for (const TouchedTriangle& touched : run.triangles) {
        const Row& row = run.rows[touched.pair];
        out << row.timed.pose << ',' << touched.triangle << ',' << touched.count
            << (several ? sourcesOf(options, row) : "") << '\n';
    }
}

void writeContactsCsv(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
                      const DetectRun& run) {
    const bool several = hasSeveral(options);
    const bool named = !inputs.labelNames.empty();
    out << "pose,triangle,x,y,z,nx,ny,nz,depth,value,opacity,label" << (named ? ",label_name" : "")
        << (several ? ",mesh,volume\n" : "\n");
    for (const Contact& contact : run.contacts) {
        const Row& row = run.rows[contact.pair];
        out << row.timed.pose << ',' << contact.triangle << ',' << rounded(contact.position) << ','
            << rounded(contact.normal) << ',' << rounded(contact.depth) << ',' << number(contact.value) << ','
            << rounded(contact.opacity) << ',' << contact.label
            << (named ? ',' + csvField(labelName(inputs, contact.label)) : "")
            << (several ? sourcesOf(options, row) : "") << '\n';
    }
}

} // namespace voxtact::app
