// SPDX-License-Identifier: MIT
#include "io/labels/dicom_labels.h"

#include "core/base/try.h"
#include "io/errors.h"
#include "io/volume/volume_container.h"

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

/// The only file of a folder; the path itself if it is no folder; empty otherwise.
fs::path onlyFile(const fs::path& path) {
    std::error_code problem;
    if (!fs::is_directory(path, problem)) {
        return volumeFormat(path) || !fs::is_regular_file(path, problem) ? fs::path() : path;
    }
    fs::path only;
    for (fs::directory_iterator entry(path, problem); !problem && entry != fs::directory_iterator();
         entry.increment(problem)) {
        if (!only.empty()) {
            return {};
        }
        only = entry->path();
    }
    return fs::is_regular_file(only, problem) ? only : fs::path();
}

std::string_view classOf(const DicomFile& file) {
    const std::string_view uid = file.set.text(dicom::kSopClass);
    return uid.empty() ? file.set.text(dicom::kMediaStorage) : uid;
}

} // namespace

bool isRtStruct(const fs::path& path) {
    const fs::path only = onlyFile(path);
    if (only.empty()) {
        return false;
    }
    const Result<std::optional<DicomFile>> file = readDicomFile(only);
    return file.ok() && *file && classOf(**file) == dicom::kRtStructClass;
}

Result<std::optional<LabelFile>> readDicomLabels(const fs::path& path, const VolumeReadOptions& options) {
    const fs::path only = onlyFile(path);
    if (only.empty()) {
        return std::optional<LabelFile>();
    }
    Result<std::optional<DicomFile>> file = readDicomFile(only);
    if (!file.ok() && only != path) {
        return std::optional<LabelFile>(); // the reader of series says it
    }
    VOXTACT_TRY(file);
    if (!*file) {
        return std::optional<LabelFile>();
    }
    const std::string_view uid = classOf(**file);
    const bool isSegmentation = uid == dicom::kSegClass;
    if (!isSegmentation && uid != dicom::kRtStructClass) {
        return std::optional<LabelFile>();
    }
    if (options.frame || !options.series.empty()) {
        return cannotRead(only, "it holds one label map, of which no frame and no series is chosen");
    }
    Result<LabelFile> labels = isSegmentation ? readDicomSeg(std::move(**file)) : readRtStruct(**file, options.grid);
    VOXTACT_TRY(labels);
    return std::optional(std::move(*labels));
}

} // namespace voxtact::io
