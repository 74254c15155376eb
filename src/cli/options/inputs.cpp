// SPDX-License-Identifier: MIT
#include "cli/options/inputs.h"

#include "cli/options/file_status.h"
#include "cli/options/output_paths.h"
#include "cli/output/standard_streams.h"
#include "cli/output/text_for_messages.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "voxtact/io.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <limits>
#include <string_view>

namespace voxtact::app {

namespace {

constexpr std::string_view kBuiltin = "builtin:";

/// Errors in the contents of a file are run-time failures, not invalid arguments.
Error fileFault(Error error) {
    if (error.code == ErrorCode::InvalidArgument) {
        error.code = ErrorCode::Format;
    }
    return error;
}

/// Returns the error of a builtin, whose name is an argument, or of a file.
Error sourceFault(const char* option, const std::string& source, const Error& error) {
    const bool isName = source.starts_with(kBuiltin) && error.code != ErrorCode::OutOfMemory;
    return isName ? badArgument(std::string(option) + " " + source + ": " + error.text) : fileFault(error);
}

void printNotes(const std::string& source, const std::vector<std::string>& notes) {
    for (const std::string& note : notes) {
        const bool named = note.find(source) != std::string::npos;
        printNoteOnce(named ? note : source + ": " + note);
    }
}

/// Returns the image that a source selects: a series of a folder, a frame of a file.
Result<io::VolumeReadOptions> imageChoice(const std::string& source, const NamedImage& image) {
    io::VolumeReadOptions options;
    std::error_code ignored;
    if (std::filesystem::is_directory(image.path, ignored)) {
        options.series = image.which;
    } else if (!image.which.empty() || image.path != source) {
        std::uint32_t frame = 0;
        const char* const end = image.which.data() + image.which.size();
        const auto [read, error] = std::from_chars(image.which.data(), end, frame);
        if (error != std::errc() || read != end) {
            return refuse(forMessage(source) +
                          ": there is no such file, and what follows '#' is not the number of an "
                          "image in " +
                          forMessage(image.path.string()));
        }
        options.frame = frame;
    }
    return options;
}

Result<VolumeData> readImage(const std::string& source, const io::VolumeReadOptions& how) {
    const NamedImage image = namedImage(source);
    Result<io::VolumeReadOptions> options = imageChoice(source, image);
    VOXTACT_TRY(options);
    options->progress = how.progress;
    options->resample = how.resample;
    return io::readVolume(image.path, *options);
}

} // namespace

Result<VolumeData> loadVolume(const std::string& source, const io::VolumeReadOptions& how) {
    const bool builtin = source.starts_with(kBuiltin);
    Result<VolumeData> volume =
        builtin ? makeBuiltinVolume(std::string_view(source).substr(kBuiltin.size())) : readImage(source, how);
    if (!volume.ok()) {
        return sourceFault("--volume", source, volume.error());
    }
    printNotes(source, volume->notes);
    return volume;
}

Result<void> checkVolumesAreThere(const std::vector<std::string>& sources) {
    for (const std::string& source : sources) {
        if (source.starts_with("builtin:")) {
            continue;
        }
        const Result<std::optional<struct stat>> there = statusOf(namedImage(source).path);
        VOXTACT_TRY(there);
        if (!*there) {
            return Error{ErrorCode::File, 0,
                         "cannot read " + forMessage(namedImage(source).path.string()) +
                             ": there is no such file or folder"};
        }
    }
    return {};
}

Result<MeshData> loadMesh(const std::string& source, const MeshOptions& options) {
    const bool builtin = source.starts_with(kBuiltin);
    io::MeshReadOptions reading{.space = {}, .scale = options.scale, .deflection = options.deflection};
    if (!options.space.empty()) {
        reading.space = options.space == "ras" ? io::MeshSpace::RAS : io::MeshSpace::LPS;
    }
    Result<MeshData> mesh =
        builtin ? makeBuiltinMesh(std::string_view(source).substr(kBuiltin.size())) : io::readMesh(source, reading);
    if (!mesh.ok()) {
        return sourceFault("--mesh", source, mesh.error());
    }
    const Result<MeshFacts> facts = checkMesh(mesh->view());
    if (!facts.ok()) {
        return fileFault(facts.error());
    }
    if (facts->degenerate > 0) {
        mesh->notes.push_back(std::to_string(facts->degenerate) + " of " + std::to_string(facts->triangles) +
                              " triangles have no area: only the projection certified counts them");
    }
    if (builtin && options.scale != 1) {
        mesh->notes.emplace_back("--mesh-scale has no effect on a builtin mesh, which is in mm");
    }
    if (builtin && options.space == "ras") {
        mesh->notes.emplace_back("--mesh-space has no effect on a builtin mesh, which is in LPS");
    }
    printNotes(source, mesh->notes);
    return mesh;
}

Result<std::vector<ControlPoint>> loadControlPoints(const TransferFunctionOptions& options) {
    if (options.opacity) {
        Result<std::vector<ControlPoint>> points = io::parseOpacity(*options.opacity);
        if (points.ok() || points.error().code == ErrorCode::OutOfMemory) {
            return points;
        }
        constexpr std::string_view kWhat = "opacity"; // prefix of parseOpacity() errors
        return badArgument(options.opacityOption + points.error().text.substr(kWhat.size()));
    }
    if (options.path.empty()) {
        return std::vector<ControlPoint>{};
    }
    Result<std::vector<ControlPoint>> points = io::readTransferFunction(options.path);
    return points.ok() ? points : fileFault(points.error());
}

ValueRange tableDomain(const TransferFunctionOptions& options, ScalarType type, const ValueRange& data) {
    if (options.domain) {
        return *options.domain;
    }
    if (type == ScalarType::UInt8) {
        return {0, 255};
    }
    if (data.lo < data.hi) {
        return data;
    }
    // All values are equal: use the narrowest representable table, with the value in the middle.
    const double half = std::max(0.5, std::abs(data.lo) * 1e-6);
    return {data.lo - half, data.lo + half};
}

std::uint32_t tableSizeFor(const TransferFunctionOptions& options, ScalarType type) {
    constexpr std::uint32_t kFine = 4096; // fits on every device
    return options.tableSize.value_or(type == ScalarType::UInt8 ? kDefaultTableSize : kFine);
}

/// A domain may exclude some values, but usually by mistake.
ValueRange usedDomain(const TransferFunctionOptions& options, ScalarType type, const ValueRange& data,
                      const std::string& source) {
    const ValueRange domain = tableDomain(options, type, data);
    if (data.lo < domain.lo || data.hi > domain.hi) {
        printNote(source + ": its values " + number(data.lo) + ":" + number(data.hi) +
                  " exceed --tf-domain; outside, the opacity of its ends applies");
    }
    return domain;
}

std::vector<ControlPoint> defaultRamp(const ValueRange& domain) {
    return {{domain.lo, 0}, {domain.hi, 1}};
}

Result<Grid> gridOfVolume(const std::string& source, bool resample) {
    const Result<VolumeData> volume = loadVolume(source, {.resample = resample});
    VOXTACT_TRY(volume);
    return volume->grid;
}

Result<io::LabelFile> loadLabels(const std::filesystem::path& path, const GridSource& grid) {
    if (std::error_code ignored; path.string().starts_with("builtin:") && !std::filesystem::exists(path, ignored)) {
        return badArgument("--labels needs a file, not " + forMessage(path.string()) +
                           "; voxtact make volume writes a builtin to a file");
    }
    const NamedImage image = namedImage(path.string());
    Result<io::VolumeReadOptions> options = imageChoice(path.string(), image);
    if (options.ok() && io::holdsContours(image.path)) {
        const Result<Grid> of = grid();
        VOXTACT_TRY(of);
        options->grid = *of;
    }
    Result<io::LabelFile> file =
        options.ok() ? io::readLabels(image.path, *options) : Result<io::LabelFile>(options.error());
    if (!file.ok()) {
        return fileFault(file.error());
    }
    printNotes(path.string(), file->notes);
    return file;
}

std::filesystem::path labelNamesPath(const std::filesystem::path& names, const std::filesystem::path& labels) {
    if (!names.empty()) {
        return names;
    }
    std::filesystem::path path = labels;
    path.replace_extension(path.extension() == ".gz" ? "" : path.extension());
    path += ".txt";
    return path;
}

Result<std::map<std::int32_t, std::string>> loadLabelNames(const std::filesystem::path& names,
                                                           const std::filesystem::path& labels) {
    const std::filesystem::path path = labelNamesPath(names, labels);
    std::error_code ignored;
    if (names.empty() && !std::filesystem::is_regular_file(path, ignored)) {
        return std::map<std::int32_t, std::string>{};
    }
    Result<std::vector<io::LabelName>> read = io::readLabelNames(path);
    if (!read.ok() && names.empty()) {
        printNoteOnce("labels have numbers only: " + read.error().text + " (--label-names names another file)");
        return std::map<std::int32_t, std::string>{};
    }
    if (!read.ok()) {
        return fileFault(read.error());
    }
    std::map<std::int32_t, std::string> byLabel;
    for (io::LabelName& entry : *read) {
        byLabel.emplace(entry.label, std::move(entry.name));
    }
    return byLabel;
}

Result<NamedLabels> loadNamedLabels(const std::filesystem::path& labels, const std::filesystem::path& names,
                                    const GridSource& grid) {
    Result<io::LabelFile> map = loadLabels(labels, grid);
    VOXTACT_TRY(map);
    Result<std::map<std::int32_t, std::string>> read = loadLabelNames(names, labels);
    VOXTACT_TRY(read);
    if (read->empty()) {
        for (io::LabelName& entry : map->names) {
            read->emplace(entry.label, std::move(entry.name));
        }
    }
    return NamedLabels{std::move(map->labels), std::move(*read)};
}

Result<std::vector<Mat4>> readStandardPoses(io::PoseFormat format) {
    std::vector<Mat4> poses;
    std::ios::sync_with_stdio(false);
    Result<io::PoseReader> reader = io::PoseReader::over(std::cin, "standard input", format);
    const Result<bool> read =
        reader.ok() ? reader->read(std::numeric_limits<std::size_t>::max(), poses) : Result<bool>(reader.error());
    return read.ok() ? Result<std::vector<Mat4>>(std::move(poses)) : read.error();
}

Vec3 lpsFrom(const std::string& space, const Vec3& point) {
    return space == "ras" ? Vec3{-point[0], -point[1], point[2]} : point;
}

Mat4 lpsFrom(const std::string& space, const Mat4& pose) {
    Mat4 out = pose;
    for (std::size_t i = 0; space == "ras" && i < out.size(); ++i) {
        const bool turned = (i % 4 < 2) != (i / 4 < 2);
        out[i] = turned ? -out[i] : out[i];
    }
    return out;
}

Result<std::vector<Mat4>> loadPoses(const ViewOptions& options) {
    if (options.poses.empty()) {
        return std::vector<Mat4>{identity()};
    }
    // Keeps all poses: it may be read several times.
    Result<std::vector<Mat4>> poses = options.poses == "-" ? readStandardPoses(options.posesFormat)
                                                           : io::readPoses(options.poses, options.posesFormat);
    if (!poses.ok()) {
        return fileFault(poses.error());
    }
    for (Mat4& pose : *poses) {
        pose = lpsFrom(options.posesSpace, pose);
    }
    return poses;
}

} // namespace voxtact::app
