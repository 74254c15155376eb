// SPDX-License-Identifier: MIT
#include "core/base/text.h"

#include "core/base/try.h"
#include "io/errors.h"
#include "io/volume/nifti_header.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

struct NiftiFiles {
    fs::path header;
    fs::path image;
};

/// A pair is named by either of its files, each of which may be compressed. Where the other one is there both ways, it
/// is the one that is as the named one is.
NiftiFiles filesOf(const VolumeSource& source, const fs::path& path) {
    const std::string ending = lowerEnding(path);
    if (ending == ".nii" || ending == ".nii.gz") {
        return {path, path};
    }
    const std::string name = path.string();
    const std::string stem = name.substr(0, name.size() - ending.size());
    const bool zipped = ending.ends_with(".gz");
    const auto partner = [&](const std::string& plain, const std::string& upper) {
        const std::string first = stem + plain + (zipped ? ".gz" : "");
        for (const std::string& candidate :
             {first, stem + upper + (zipped ? ".GZ" : ""), stem + plain + (zipped ? "" : ".gz"),
              stem + upper + (zipped ? "" : ".GZ")}) {
            if (source.has(candidate)) {
                return fs::path(candidate);
            }
        }
        return fs::path(first);
    };
    return ending.starts_with(".hdr") ? NiftiFiles{path, partner(".img", ".IMG")}
                                      : NiftiFiles{partner(".hdr", ".HDR"), path};
}

/// The type, or the reason why such voxels are no scalars.
Result<StoredType> storedType(const fs::path& path, std::int16_t type) {
    for (const NiftiType& known : kNiftiTypes) {
        if (known.number == type) {
            return known.stored;
        }
    }
    const char* const what = type == 128 || type == 2304                  ? "colours (RGB)"
                             : type == 32 || type == 1792 || type == 2048 ? "complex numbers"
                             : type == 1                                  ? "single bits"
                                                                          : "of a type that is not supported";
    return cannotRead(path, std::string("its voxels are ") + what + " (NIfTI data type " + std::to_string(type) +
                                "); convert it to integers or floats");
}

/// NIfTI: a slope of 0 means none. NaN means none for nibabel, too, with a note; with an intercept its meaning is
/// unknown. SPM's Analyze files have a slope in the same field, and NaN means none.
Result<std::optional<Scaling>> scalingOf(const fs::path& path, const NiftiHeader& header,
                                         std::vector<std::string>& notes) {
    const bool isAnalyze = header.kind == NiftiHeader::Kind::Analyze;
    const double slope = header.slope;
    const double intercept = isAnalyze && !std::isfinite(header.intercept) ? 0 : header.intercept;
    const std::optional<Scaling> none;
    if (slope == 0 || (isAnalyze && !std::isfinite(slope))) {
        return none;
    }
    if (std::isnan(slope) && (intercept == 0 || std::isnan(intercept))) {
        notes.emplace_back("the file's scl_slope is NaN; its voxels are taken as they are stored, as nibabel does");
        return none;
    }
    if (!std::isfinite(slope) || !std::isfinite(intercept)) {
        return cannotRead(path, "its voxels have no scale: scl_slope is " + number(slope) + ", scl_inter is " +
                                    number(intercept) + "; mend its header");
    }
    if (slope == 1 && intercept == 0) {
        return none;
    }
    if (isAnalyze) {
        notes.push_back("the file is scaled as SPM does it: " + number(slope) + " * voxel + " + number(intercept));
    }
    return std::optional(Scaling{slope, intercept});
}

struct NiftiContent {
    NiftiHeader header;
    StoredImage image; ///< without voxels
    std::uint64_t voxelsAt = 0;
    std::uint64_t behind = 0; ///< bytes of the images that follow
    std::vector<std::string> notes;
};

/// Sizes of 0 beyond the third, which some programs write for an axis that they do not use, are 1.
void takeUnusedAxes(NiftiHeader& header, std::vector<std::string>& notes) {
    for (std::size_t axis = 3; axis < header.sizes.size(); ++axis) {
        if (header.sizes[axis] == 0) {
            notes.push_back("the file's dim[" + std::to_string(axis + 1) + "] is 0; 1 is taken");
            header.sizes[axis] = 1;
        }
    }
}

Result<NiftiContent> contentOf(const fs::path& path, NiftiHeader header, const VolumeReadOptions& options) {
    NiftiContent content;
    takeUnusedAxes(header, content.notes);
    const Result<StoredType> type = storedType(path, header.type);
    VOXTACT_TRY(type);
    std::uint64_t frames = 0;
    const Result<std::uint64_t> bytes = frameBytes(path, header.sizes, storedBytes(*type), frames);
    VOXTACT_TRY(bytes);
    const Result<std::uint64_t> frame = frameOf(path, frames, options);
    VOXTACT_TRY(frame);
    const Result<Grid> grid = niftiGrid(path, header, content.notes);
    VOXTACT_TRY(grid);
    const Result<std::optional<Scaling>> scaling = scalingOf(path, header, content.notes);
    VOXTACT_TRY(scaling);
    content.image = {*grid, *type, *scaling, {}};
    content.voxelsAt = header.voxelOffset + *frame * *bytes;
    content.behind = (frames - 1 - *frame) * *bytes;
    content.header = std::move(header);
    return content;
}

struct OpenNifti {
    NiftiContent content;
    ByteReader reader;           ///< stands behind the header's bytes
    std::uint64_t readBytes = 0; ///< how many those are
};

Result<OpenNifti> openHeader(const VolumeSource& source, const NiftiFiles& files, const VolumeReadOptions& options) {
    Result<ByteReader> reader = source.open(files.header);
    VOXTACT_TRY(reader);
    VOXTACT_TRY(reader->unpack(ByteReader::Packing::GzipOrPlain));
    Result<std::string> head = reader->head(kNifti1Bytes);
    if (head.ok() && isNifti2(*head)) {
        const Result<std::string> rest = reader->head(kNifti2Bytes - kNifti1Bytes);
        head = rest.ok() ? Result<std::string>(*head + *rest) : rest;
    }
    VOXTACT_TRY(head);
    Result<NiftiHeader> header = parseNiftiHeader(files.header, *head, files.header == files.image);
    VOXTACT_TRY(header);
    Result<NiftiContent> content = contentOf(files.header, std::move(*header), options);
    VOXTACT_TRY(content);
    return OpenNifti{std::move(*content), std::move(*reader), head->size()};
}

/// The voxels of a pair are in a file of their own.
Result<ByteReader> openImage(const VolumeSource& source, const fs::path& path) {
    Result<ByteReader> reader = source.open(path);
    // Voxels may begin as gzip does; only the ending tells.
    if (reader.ok() && lowerEnding(path).ends_with(".gz")) {
        VOXTACT_TRY(reader->unpack(ByteReader::Packing::GzipOrPlain));
    }
    return reader;
}

} // namespace

Result<ContainedImage> readNifti(const VolumeSource& source, const fs::path& path, const VolumeReadOptions& options) {
    const NiftiFiles files = filesOf(source, path);
    Result<OpenNifti> opened = openHeader(source, files, options);
    VOXTACT_TRY(opened);
    NiftiContent& content = opened->content;
    const bool pair = files.header != files.image;
    Result<ByteReader> opener = pair ? openImage(source, files.image) : std::move(opened->reader);
    VOXTACT_TRY(opener);
    ByteReader& reader = *opener;
    VOXTACT_TRY(reader.skip(content.voxelsAt - (pair ? 0 : opened->readBytes)));
    VOXTACT_TRY(takeVoxels(reader, content.image, content.header.swapped));
    const Result<std::uint64_t> left = reader.finish();
    VOXTACT_TRY(left);
    noteMore(*left - std::min(*left, content.behind), content.notes);
    return ContainedImage{std::move(content.image), std::move(content.notes)};
}

} // namespace voxtact::io
