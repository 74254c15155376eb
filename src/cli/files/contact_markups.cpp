// SPDX-License-Identifier: MIT
#include "cli/files/pair_files.h"
#include "core/base/text.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <ostream>

namespace voxtact::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/"
                                "Resources/Schema/markups-schema-v1.0.3.json#";

/// Replaces bytes that are not UTF-8, which file names may have.
std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string pairText(const PairOptions& options, std::uint32_t job, std::uint64_t pose) {
    const PairJobs& jobs = options.jobs;
    const Job& which = jobs.jobs[job];
    return "pose " + std::to_string(pose) +
           (options.hasSeveralJobs() ? " of " + jobs.meshes[which.mesh] + " in " + jobs.volumes[which.volume] : "");
}

Json pointOf(const PairOptions& options, const PairInputs& inputs, const KeptContact& kept, std::size_t number) {
    const Contact& contact = kept.contact;
    const std::string label = options.labels.path.empty() ? "" : ", " + labelName(inputs, contact.label);
    return {{"id", std::to_string(number + 1)},
            {"label", std::to_string(kept.pose) + "-" + std::to_string(contact.triangle)},
            {"description", pairText(options, kept.job, kept.pose) + ", triangle " + std::to_string(contact.triangle) +
                                ", depth " + voxtact::number(std::round(contact.depth * 1000) / 1000) + " mm, value " +
                                voxtact::number(contact.value) + label},
            {"position", contact.position},
            {"selected", true},
            {"locked", true},
            {"visibility", true},
            {"positionStatus", "defined"}};
}

Json boxOf(const PairOptions& options, const KeptBounds& kept) {
    Vec3 centre{};
    Vec3 size{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        centre[axis] = (kept.box.lo[axis] + kept.box.hi[axis]) / 2;
        size[axis] = kept.box.hi[axis] - kept.box.lo[axis];
    }
    return {{"type", "ROI"},
            {"coordinateSystem", "LPS"},
            {"coordinateUnits", "mm"},
            {"locked", true},
            {"labelFormat", "%N-%d"},
            {"name", "bounds, " + pairText(options, kept.job, kept.pose)},
            {"roiType", "Box"},
            {"center", centre},
            {"orientation", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
            {"size", size},
            {"insideOut", false},
            {"controlPoints", {{{"id", "1"}, {"position", centre}, {"positionStatus", "defined"}}}}};
}

} // namespace

void writeContactsMarkups(std::ostream& out, const PairOptions& options, const PairInputs& inputs,
                          const ContactList& list) {
    // Writes point by point: one JSON value of a million points would take gigabytes.
    out << "{\n\"@schema\": " << dump(kSchema) << ",\n\"markups\": [\n"
        << "{\"type\": \"Fiducial\", \"coordinateSystem\": \"LPS\", \"coordinateUnits\": \"mm\", \"locked\": true,\n"
        << "\"labelFormat\": \"%N-%d\", \"name\": \"contacts\", \"controlPoints\": [";
    for (std::size_t i = 0; i < list.contacts.size(); ++i) {
        out << (i == 0 ? "\n" : ",\n") << dump(pointOf(options, inputs, list.contacts[i], i));
    }
    out << "\n]}";
    for (const KeptBounds& kept : list.bounds) {
        out << ",\n" << dump(boxOf(options, kept));
    }
    out << "\n]\n}\n";
}

} // namespace voxtact::app
