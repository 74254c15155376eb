// SPDX-License-Identifier: MIT
#include "app/detect/detect_files.h"
#include "app/detect/detect_run.h"
#include "core/base/try.h"
#include "core/method/certified_constants.h"
#include "core/method/method_table.h"

#include <algorithm>

namespace voxtact::app {

namespace {

/// On the device, on the host, and unpacked.
constexpr std::uint64_t kBytesOfTriangle = sizeof(std::uint32_t) * 2 + sizeof(TouchedTriangle);
constexpr std::uint64_t kBytesOfLabel = sizeof(std::uint32_t) * 2 + sizeof(LabelCount);

/// What is put to what: a file says, or the other options do.
Result<void> resolveJobs(DetectOptions& options) {
    const bool byFile = !options.jobsPath.empty();
    for (const auto& [option, given] :
         {std::pair("--volume", !options.volumes.empty()), std::pair("--mesh", !options.meshes.sources.empty())}) {
        if (given == byFile) {
            return badArgument(option +
                               std::string(byFile ? ": --jobs names meshes, volumes and poses; leave out one of the two"
                                                  : " is required, or --jobs; see voxtact detect --help"));
        }
    }
    if (!byFile) {
        options.jobs = allPairs(options.meshes.sources, options.volumes, options.view.poses);
        return {};
    }
    if (!options.view.poses.empty()) {
        return badArgument("--poses: --jobs names meshes, volumes and poses; leave out one of the two");
    }
    Result<PairJobs> jobs = readJobs(options.jobsPath);
    VOXTACT_TRY(jobs);
    options.jobs = std::move(*jobs);
    return {};
}

/// Refuses an option that would change nothing.
Result<void> checkUsed(bool given, const char* option, bool used, const std::string& why) {
    return given && !used ? badArgument(option + (": " + why)) : Result<void>();
}

Result<void> checkHost(const DetectOptions& options) {
    if (!options.method.count || !rowOf(*options.method.count).host) {
        return {};
    }
    if (options.method.filter == Filter::Hardware) {
        return badArgument("--filter hardware: the counting method cpu has no device's sampler; it filters exact only");
    }
    if (options.device.validate) {
        return badArgument("--validate: the counting method cpu uses no Vulkan, there is nothing to validate; leave "
                           "out one of the two");
    }
    return {};
}

/// Whether what is near is asked of a device.
bool isDistanceOnDevice(const DetectOptions& options) {
    return options.method.count == CountingMethod::Compute && options.distance.isOne();
}

/// A device says how near and where, and to which label; and what touches, but not how.
Result<void> checkDeviceDistance(const DetectOptions& options) {
    const DistanceOptions& distance = options.distance;
    if (distance.margin) {
        const Result<void> margin = checkMargin(*distance.margin);
        return margin.ok() ? margin : badArgument("--margin: " + margin.error().text);
    }
    if (distance.poseTolerance) {
        const Result<void> tolerance = checkDeviceTolerance(*distance.poseTolerance);
        return tolerance.ok() ? tolerance : badArgument("--pose-tolerance: " + tolerance.error().text);
    }
    if (options.extra.outputs().any()) {
        return badArgument(
            std::string(options.extra.asking()) +
            ": with --clearance --count compute there are counts only; leave out one of the two, or give "
            "--count cpu");
    }
    return {};
}

/// What is certified only, and by the host where a device is not asked for by name.
Result<void> checkDistance(DetectOptions& options) {
    const DistanceOptions& distance = options.distance;
    const std::string clearance = "it is about clearances, and --clearance is not given";
    const std::string area = "it is about areas, and --area is not given";
    for (const Result<void>& used :
         {checkUsed(distance.tolerance.has_value(), "--tolerance", distance.clearance, clearance),
          checkUsed(distance.maximum.has_value(), "--max-clearance", distance.clearance, clearance),
          checkUsed(!distance.closest.empty(), "--closest", distance.clearance, clearance),
          checkUsed(!distance.labels.empty(), "--label-clearance", distance.clearance, clearance),
          checkUsed(!distance.labels.empty(), "--label-clearance", !options.extra.labels.empty(),
                    "it is about labels, and --labels is not given"),
          checkUsed(distance.areaTolerance.has_value(), "--area-tolerance", distance.area, area),
          checkUsed(!distance.labelAreas.empty(), "--label-area", distance.area, area),
          checkUsed(!distance.labelAreas.empty(), "--label-area", !options.extra.labels.empty(),
                    "it is about labels, and --labels is not given"),
          checkUsed(!distance.triangleAreas.empty(), "--triangle-area", distance.area, area),
          checkUsed(!distance.to.empty(), "--to", distance.byLabel(),
                    "it says which labels --label-clearance and --label-area are about, and neither is given"),
          checkUsed(distance.toAnyOpacity, "--to-any-opacity", !distance.labels.empty(),
                    "it says what --label-clearance is about, and that is not given")}) {
        if (!used.ok()) {
            return used;
        }
    }
    if (!distance.closest.empty() && !isClosestEnding(distance.closest)) {
        return badArgument("--closest: the ending of '" + distance.closest.string() +
                           "' says no format; it must be .csv or .ply");
    }
    if (!distance.any()) {
        return {};
    }
    if (distance.margin && distance.poseTolerance) {
        return badArgument(
            "--margin: with --pose-tolerance the distance is its first number; leave out one of the two");
    }
    const std::string option = distance.area        ? "--area"
                               : distance.clearance ? "--clearance"
                               : distance.margin    ? "--margin"
                                                    : "--pose-tolerance";
    options.extra.labelsOnlyMeasured =
        distance.byLabel() && (options.answer == "yes-no" || isDistanceOnDevice(options));
    MethodOptions& method = options.method;
    if (method.count && !rowOf(*method.count).host && !isDistanceOnDevice(options)) {
        return badArgument(option + " is answered by the host; leave out --count " + toString(*method.count) +
                           ", or give --count cpu" + (distance.isOne() ? " or compute" : ""));
    }
    if (method.projection && !rowOf(*method.projection).certified) {
        return badArgument(option + " is certified; leave out --projection " + toString(*method.projection) +
                           ", or give --projection conservative");
    }
    if (isDistanceOnDevice(options)) {
        method.projection = Projection::Conservative;
        return checkDeviceDistance(options);
    }
    method.count = CountingMethod::Cpu;
    return {};
}

Result<void> checkConservative(const MethodOptions& method) {
    if (!rowOf(*method.projection).certified) {
        return {};
    }
    if (method.filter == Filter::Hardware) {
        return badArgument("--filter hardware: the projection conservative filters exact only");
    }
    if (!canBeConservative(method)) {
        return badArgument(std::string("--count ") + toString(*method.count) +
                           ": the projection conservative is answered by " +
                           methodNames([](const MethodRow& row) { return row.certified; }, ", ") + " and auto only");
    }
    if (method.boundary == Boundary::Clamp) {
        return badArgument("--boundary clamp: the projection conservative always tests the range; leave it out, or add "
                           "--projection view");
    }
    return {};
}

Result<void> checkProjection(const DetectOptions& options) {
    const Projection projection = *options.method.projection;
    const std::string name = toString(projection);
    const std::string camera =
        "the projection " + name + " has no camera; leave it out, or add --projection view or two-view";
    const ViewOptions& view = options.view;
    for (const Result<void>& used :
         {checkUsed(view.sizeGiven, "--size", usesView(projection), camera),
          checkUsed(!view.camera.empty(), "--camera", usesView(projection), camera),
          checkUsed(options.method.samplesPerVoxel.has_value(), "--samples-per-voxel", rowOf(projection).voxelGrid,
                    "it is for --projection dominant-axis, not for " + name),
          checkUsed(options.method.resolution.has_value(), "--resolution", rowOf(projection).certified,
                    "it is for --projection conservative, not for " + name)}) {
        if (!used.ok()) {
            return used;
        }
    }
    return {};
}

/// What is counted are the passes of one engine.
Result<void> checkStats(const DetectOptions& options) {
    if (!options.stats) {
        return {};
    }
    if (options.distance.any() && !isDistanceOnDevice(options)) {
        return badArgument(options.distance.area
                               ? "--stats counts what a device does, and areas are the host's; leave out one of the two"
                               : "--stats counts what a device does, and distances are the host's; leave it out, or "
                                 "give --count compute");
    }
    if (options.method.count && rowOf(*options.method.count).host) {
        return badArgument("--stats: the counting method cpu counts nothing of what it does; leave it out, or give "
                           "--count compute");
    }
    if (!rowOf(*options.method.projection).certified) {
        return badArgument(std::string("--stats is about the passes of the projection conservative, not of ") +
                           toString(*options.method.projection) + "; leave it out");
    }
    return {};
}

Result<void> checkExtra(const DetectOptions& options) {
    const ExtraOptions& extra = options.extra;
    const std::string contacts = "it is about contacts, and --contacts is not given";
    for (const Result<void>& used :
         {checkUsed(extra.maxDepth.has_value(), "--max-depth", !extra.contacts.empty(), contacts),
          checkUsed(extra.mostContacts.has_value(), "--most-contacts", !extra.contacts.empty(), contacts),
          checkUsed(!extra.labelNames.empty(), "--label-names", !extra.labels.empty(),
                    "it names the labels of a label map, and --labels is not given")}) {
        if (!used.ok()) {
            return used;
        }
    }
    if (!extra.contacts.empty() && !isContactEnding(extra.contacts)) {
        return badArgument("--contacts: the ending of '" + extra.contacts.string() + "' says no format; it must be " +
                           contactEndings());
    }
    if (options.answer == "count" && options.distance.isMargin()) {
        return badArgument(std::string(options.distance.margin ? "--margin" : "--pose-tolerance") +
                           " is answered by yes or no, and --answer count asks for a count; leave out one of the two");
    }
    if (const bool yesNo = options.answer == "yes-no"; options.yesNo() && extra.outputs().any()) {
        return badArgument(std::string(yesNo ? "--answer yes-no stops at the first contact, and "
                                       : options.distance.margin
                                           ? "--margin is answered by yes or no, without contacts, and "
                                           : "--pose-tolerance is answered by yes or no, without contacts, and ") +
                           extra.asking() + " is about all of them; leave out one of the two");
    }
    return {};
}

} // namespace

bool canBeConservative(const MethodOptions& method) {
    const bool byMethod = !method.count || rowOf(*method.count).certified;
    return byMethod && method.filter != Filter::Hardware;
}

Result<void> resolveOptions(DetectOptions& options) {
    if (options.output.path == "-") {
        options.output.path.clear();
    }
    if (options.chunks.asked() && options.output.formatName.empty()) {
        options.output.formatName = "csv"; // whoever looks on: the chunks are the same
    }
    VOXTACT_TRY(resolveJobs(options));
    VOXTACT_TRY(checkDistance(options));
    VOXTACT_TRY(checkHost(options));
    if (!options.method.projection) {
        options.method.projection = canBeConservative(options.method) ? Projection::Conservative : Projection::View;
    }
    VOXTACT_TRY(checkConservative(options.method));
    VOXTACT_TRY(checkProjection(options));
    VOXTACT_TRY(checkStats(options));
    return checkExtra(options);
}

std::uint64_t mostTriangles(const DetectInputs& inputs) {
    std::uint64_t most = 0;
    for (const MeshData& mesh : inputs.meshes) {
        most = std::max<std::uint64_t>(most, mesh.indices.size() / 3);
    }
    return most;
}

std::uint32_t pairsPerBatch(const DetectOptions& options, const DetectInputs& inputs, std::uint32_t copies) {
    std::uint64_t bytes = sizeof(Row);
    if (options.extra.outputs().triangles) {
        bytes += mostTriangles(inputs) * kBytesOfTriangle;
    }
    if (inputs.labels) {
        bytes += inputs.labels->values.size() * kBytesOfLabel;
    }
    const std::uint64_t fit = std::max<std::uint64_t>(kMostOutputBytes / copies / bytes, 1);
    return options.extra.outputs().any() ? static_cast<std::uint32_t>(std::min<std::uint64_t>(options.mostPairs(), fit))
                                         : options.mostPairs();
}

} // namespace voxtact::app
