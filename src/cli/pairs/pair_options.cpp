// SPDX-License-Identifier: MIT
#include "cli/files/pair_files.h"
#include "cli/pairs/pair_run.h"
#include "core/base/try.h"
#include "core/method/method_table.h"

#include <algorithm>
#include <array>

namespace voxtact::app {

namespace {

/// Copies of outputs in flight: on the device, on the host, and unpacked.
constexpr std::uint64_t kBytesOfTriangle = sizeof(std::uint32_t) * 2 + sizeof(TouchedTriangle);
constexpr std::uint64_t kBytesOfLabel = sizeof(std::uint32_t) * 2 + sizeof(LabelCount);

/// Refuses an option without effect.
Result<void> checkUsed(bool given, const char* option, bool used, const std::string& why) {
    return given && !used ? badArgument(option + (": " + why)) : Result<void>();
}

Result<void> checkEngine(const PairOptions& options) {
    const bool host = options.engine == "host";
    const std::string leaveOut = "; leave out one of the two";
    if (host && !options.device.wanted.empty()) {
        return badArgument("--on host: --device names a Vulkan device" + leaveOut);
    }
    if (options.device.validate && isForHost(options)) {
        return badArgument("--validate: the host engine uses no Vulkan" + leaveOut);
    }
    if (!isForHost(options) && (options.touch.margin || options.touch.uncertainty)) {
        return badArgument(std::string(options.touch.margin ? "--margin" : "--uncertainty") +
                           " needs the host engine; leave out --on device and --device");
    }
    if (!isForHost(options) && options.touch.solid) {
        return badArgument("--solid needs the host engine; leave out --on device and --device");
    }
    if (isForHost(options) && options.method.filter == Filter::Hardware) {
        return badArgument("--filter hardware: the host engine has no hardware sampler; leave out --filter");
    }
    if (!options.method.count) {
        return {};
    }
    const bool cpu = rowOf(*options.method.count).host;
    if (!options.engine.empty() && cpu != host) {
        return badArgument("--on " + options.engine + ": --method " + toString(*options.method.count) +
                           (cpu ? " runs on the host" : " runs on a device") + leaveOut);
    }
    return {};
}

/// Refuses measuring options that exclude each other.
Result<void> checkMeasure(const PairOptions& options) {
    const MeasureOptions& measure = options.measure;
    VOXTACT_TRY(checkSettings(measure.settings, !options.labels.path.empty()));
    const std::string byLabel =
        options.byLabel() ? "not with " + optionOf(*labelFact(options.question.name)) + "; leave out one of the two"
                          : "";
    VOXTACT_TRY(checkUsed(!measure.witness.empty(), "--witness", !options.byLabel(), byLabel));
    VOXTACT_TRY(checkUsed(!measure.triangles.empty(), "--triangles", !options.byLabel(), byLabel));
    if (!measure.witness.empty() && !isWitnessEnding(measure.witness)) {
        return badArgument("--witness: the ending of '" + measure.witness.string() + "' must be .csv or .ply");
    }
    return {};
}

Result<void> checkCertified(const MethodOptions& method) {
    if (!rowOf(*method.projection).certified) {
        return {};
    }
    if (method.filter == Filter::Hardware) {
        return badArgument("--filter hardware: --projection certified needs --filter exact");
    }
    if (!canBeCertified(method)) {
        return badArgument(std::string("--method ") + toString(*method.count) + ": --projection certified needs " +
                           methodNames([](const MethodRow& row) { return row.certified; }, ", ") + " or auto");
    }
    if (method.boundary == Boundary::Clamp) {
        return badArgument("--boundary clamp: --projection certified tests the range; add --projection view");
    }
    return {};
}

Result<void> checkProjection(const PairOptions& options) {
    const Projection projection = *options.method.projection;
    const std::string name = toString(projection);
    const std::string camera = "the projection " + name + " has no camera; use --projection view or two-view";
    const ViewOptions& view = options.view;
    for (const Result<void>& used :
         {checkUsed(view.sizeGiven, "--size", usesView(projection), camera),
          checkUsed(!view.camera.empty(), "--camera", usesView(projection), camera),
          checkUsed(options.method.samplesPerVoxel.has_value(), "--samples-per-voxel", rowOf(projection).voxelGrid,
                    "it applies to --projection dominant-axis, not to " + name),
          checkUsed(options.method.resolution.has_value(), "--resolution", rowOf(projection).certified,
                    "it applies to --projection certified, not to " + name)}) {
        if (!used.ok()) {
            return used;
        }
    }
    return {};
}

/// --stats counts passes of the device engine.
Result<void> checkStats(const PairOptions& options) {
    if (!options.stats) {
        return {};
    }
    if (isForHost(options)) {
        return badArgument("--stats: the host engine has no device passes; leave out one of the two");
    }
    return rowOf(*options.method.projection).certified
               ? Result<void>()
               : badArgument(std::string("--stats: it counts passes of --projection certified, not of ") +
                             toString(*options.method.projection) + "; leave it out");
}

/// Returns the options whose output has labels.
std::string neededForLabels(const NamedQuestion& question) {
    if (question.name == "count") {
        return "--label-counts or --contacts";
    }
    return optionOf(*labelFact(question.name)) + (hasWitness(question) ? " or --witness" : "");
}

Result<void> checkExtra(const PairOptions& options) {
    const ExtraOptions& extra = options.extra;
    const bool contacts = !extra.contacts.empty();
    const bool labels = !options.labels.path.empty();
    const bool isLabelled =
        options.isTouch() ? !options.touch.uncertainty
                          : extra.asked.labels || contacts || options.byLabel() || !options.measure.witness.empty();
    if (labels && !isLabelled) {
        return badArgument(options.isTouch()
                               ? "--labels: --uncertainty gives no witness point; leave out one of the two"
                               : "--labels: no output has labels; add " + neededForLabels(options.question));
    }
    const std::string needsContacts = "it needs contacts; add --contacts";
    const std::string needsLabels = "it needs a label map; add --labels";
    for (const Result<void>& used :
         {checkUsed(extra.maxDepth.has_value(), "--max-depth", contacts, needsContacts),
          checkUsed(extra.maxContacts.has_value(), "--max-contacts", contacts, needsContacts),
          checkUsed(extra.asked.labels, "--label-counts", labels, needsLabels),
          checkUsed(!options.labels.names.empty(), "--label-names", labels, needsLabels)}) {
        if (!used.ok()) {
            return used;
        }
    }
    if (contacts && !isContactEnding(extra.contacts)) {
        return badArgument("--contacts: the ending of '" + extra.contacts.string() + "' must be " + contactEndings());
    }
    return {};
}

} // namespace

bool canBeCertified(const MethodOptions& method) {
    const bool byMethod = !method.count || rowOf(*method.count).certified;
    return byMethod && method.filter != Filter::Hardware;
}

bool isForHost(const PairOptions& options) {
    if (options.method.count) {
        return rowOf(*options.method.count).host;
    }
    const bool forDevice = options.engine == "device" || !options.device.wanted.empty() || options.device.validate ||
                           options.stats || options.method.filter == Filter::Hardware;
    return options.engine == "host" || !forDevice;
}

Result<void> resolveOptions(PairOptions& options) {
    if (options.output.path == "-") {
        options.output.path.clear();
    }
    options.jobs = allPairs(options.meshes.sources, options.volumes);
    if (!options.method.projection) {
        options.method.projection = canBeCertified(options.method) ? Projection::Certified : Projection::View;
    }
    VOXTACT_TRY(checkShard(options.shard, options.output,
                           {{options.timing, "--timing"}, {options.stats, "--stats"}, {options.summary, "--summary"}}));
    VOXTACT_TRY(checkEngine(options));
    VOXTACT_TRY(checkMeasure(options));
    VOXTACT_TRY(checkCertified(options.method));
    VOXTACT_TRY(checkProjection(options));
    VOXTACT_TRY(checkStats(options));
    return checkExtra(options);
}

std::uint64_t maxTriangles(const PairInputs& inputs) {
    std::uint64_t max = 0;
    for (const MeshData& mesh : inputs.meshes) {
        max = std::max<std::uint64_t>(max, mesh.indices.size() / 3);
    }
    return max;
}

std::uint32_t pairsPerBatch(const PairOptions& options, const PairInputs& inputs, std::uint32_t copies) {
    std::uint64_t bytes = sizeof(Row);
    if (options.extra.outputs().triangles) {
        bytes += maxTriangles(inputs) * kBytesOfTriangle;
    }
    if (inputs.labels) {
        bytes += inputs.labels->values.size() * kBytesOfLabel;
    }
    const std::uint64_t fit = std::max<std::uint64_t>(kMaxOutputBytes / copies / bytes, 1);
    return options.extra.outputs().any() ? static_cast<std::uint32_t>(std::min<std::uint64_t>(options.maxPairs(), fit))
                                         : options.maxPairs();
}

} // namespace voxtact::app
