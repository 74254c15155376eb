// SPDX-License-Identifier: MIT
#include "app/detect/detect_files.h"

#include "core/base/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>

namespace voxtact::app {

namespace {

/// A nanometre: more digits say nothing.
constexpr double kMillionths = 1e6;

std::string inMillionths(double value) {
    return number(std::round(value * kMillionths) / kMillionths + 0.0);
}

std::string inMillionths(const Vec3& vector) {
    return inMillionths(vector[0]) + ',' + inMillionths(vector[1]) + ',' + inMillionths(vector[2]);
}

/// ",mesh,volume" of a row, where that is needed; with --jobs also the job's number.
std::string sourcesOf(const DetectOptions& options, std::uint32_t job) {
    const PairJobs& jobs = options.jobs;
    const Job& which = jobs.jobs[job];
    return (options.hasSeveralJobs()
                ? "," + io::csvField(jobs.meshes[which.mesh]) + "," + io::csvField(jobs.volumes[which.volume])
                : "") +
           (jobs.fromFile ? "," + std::to_string(job) : "");
}

std::string sourceColumns(const DetectOptions& options) {
    return std::string(options.hasSeveralJobs() ? ",mesh,volume" : "") + (options.jobs.fromFile ? ",job\n" : "\n");
}

struct ContactFormat {
    const char* ending;
    void (*write)(std::ostream&, const DetectOptions&, const DetectInputs&, const ContactList&);
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

void writeTriangleHeader(std::ostream& out, const DetectOptions& options) {
    out << "pose,triangle,count" << sourceColumns(options);
}

void writeTriangle(std::ostream& out, const DetectOptions& options, const Row& row, const TouchedTriangle& touched) {
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

void writeContacts(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
                   const ContactList& list) {
    formatOf(options.extra.contacts)->write(out, options, inputs, list);
}

void writeContactsCsv(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
                      const ContactList& list) {
    const bool named = !inputs.labelNames.empty();
    out << "pose,triangle,x,y,z,nx,ny,nz,depth,value,opacity,label" << (named ? ",label_name" : "")
        << sourceColumns(options);
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
