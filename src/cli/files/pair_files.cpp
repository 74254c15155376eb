// SPDX-License-Identifier: MIT
#include "cli/files/pair_files.h"

#include "core/base/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>

namespace voxtact::app {

namespace {

/// Steps per mm: more digits than a nanometre have no meaning.
constexpr double kMillionths = 1e6;

std::string inMillionths(double value) {
    return number(std::round(value * kMillionths) / kMillionths + 0.0);
}

std::string inMillionths(const Vec3& vector) {
    return inMillionths(vector[0]) + ',' + inMillionths(vector[1]) + ',' + inMillionths(vector[2]);
}

/// Returns ",MESH,VOLUME" of a row if the pose alone does not identify it.
std::string sourcesOf(const PairOptions& options, std::uint32_t job) {
    const PairJobs& jobs = options.jobs;
    const Job& which = jobs.jobs[job];
    return options.hasSeveralJobs()
               ? "," + io::csvField(jobs.meshes[which.mesh]) + "," + io::csvField(jobs.volumes[which.volume])
               : "";
}

const char* sourceColumns(const PairOptions& options) {
    return options.hasSeveralJobs() ? ",mesh,volume\n" : "\n";
}

void writeTriangleHeader(std::ostream& out, const PairOptions& options, const PairInputs& /*inputs*/) {
    out << "pose,triangle,count" << sourceColumns(options);
}

void writeTriangleAreaHeader(std::ostream& out, const PairOptions& /*options*/, const PairInputs& /*inputs*/) {
    out << "pose,mesh,volume,triangle,triangle_area,lower,upper\n";
}

struct ContactFormat {
    const char* ending;
    void (*write)(std::ostream&, const PairOptions&, const PairInputs&, const ContactList&);
};

constexpr std::array<ContactFormat, 4> kContactFormats{{{".csv", writeContactsCsv},
                                                        {".ply", writeContactsPly},
                                                        {".vtp", writeContactsVtp},
                                                        {".mrk.json", writeContactsMarkups}}};

const ContactFormat* formatOf(const std::filesystem::path& path) {
    const std::string name = path.filename().string();
    const auto* const found =
        std::find_if(kContactFormats.begin(), kContactFormats.end(), [&](const ContactFormat& format) {
            return name.ends_with(format.ending) && name != format.ending;
        });
    return found == kContactFormats.end() ? nullptr : found;
}

} // namespace

SideFile sideFile(const PairOptions& options) {
    if (options.isCount()) {
        return {"--triangles", options.extra.triangles, writeTriangleHeader};
    }
    if (hasWitness(options.question)) {
        return {"--witness", options.measure.witness, nullptr, true};
    }
    return {"--triangles", options.measure.triangles, writeTriangleAreaHeader};
}

void writeTriangle(std::ostream& out, const PairOptions& options, const Row& row, const TouchedTriangle& touched) {
    out << row.pose << ',' << touched.triangle << ',' << touched.count << sourcesOf(options, row.job) << '\n';
}

std::string contactEndings() {
    std::string all;
    for (std::size_t i = 0; i < kContactFormats.size(); ++i) {
        all += (i == 0 ? "" : i + 1 < kContactFormats.size() ? ", " : " or ") + std::string(kContactFormats[i].ending);
    }
    return all;
}

bool isContactEnding(const std::filesystem::path& path) {
    return formatOf(path) != nullptr;
}

void writeContacts(std::ostream& out, const PairOptions& options, const PairInputs& inputs, const ContactList& list) {
    formatOf(options.extra.contacts)->write(out, options, inputs, list);
}

void writeContactsCsv(std::ostream& out, const PairOptions& options, const PairInputs& inputs,
                      const ContactList& list) {
    const bool named = !inputs.labelNames.empty();
    if (options.shard.hasHead()) {
        out << "pose,triangle,x,y,z,nx,ny,nz,depth,value,opacity,label" << (named ? ",label_name" : "")
            << sourceColumns(options);
    }
    for (const KeptContact& kept : list.contacts) {
        const Contact& contact = kept.contact;
        out << kept.pose << ',' << contact.triangle << ',' << inMillionths(contact.position) << ','
            << inMillionths(contact.normal) << ',' << inMillionths(contact.depth) << ',' << number(contact.value) << ','
            << inMillionths(contact.opacity) << ',' << contact.label
            << (named ? ',' + io::csvField(labelName(inputs, contact.label)) : "") << sourcesOf(options, kept.job)
            << '\n';
    }
}

} // namespace voxtact::app
