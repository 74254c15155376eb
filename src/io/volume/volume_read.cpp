// SPDX-License-Identifier: MIT
#include "core/base/guard.h"

#include "core/base/try.h"
#include "io/errors.h"
#include "io/volume/dicom_folder.h"
#include "io/volume/volume_container.h"
#include "voxtact/io.h"

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

Result<VolumeData> readFolder(const fs::path& path, const VolumeReadOptions& options, std::vector<std::string>& notes) {
    if (options.frame) {
        return cannotRead(path, "it is a folder of DICOM files: one of several series is chosen, and no frame (" +
                                    std::to_string(*options.frame) + ")");
    }
    Result<StoredImage> image = readDicomFolder(path, options, notes);
    return image.ok() ? toScalars(std::move(*image), path) : Result<VolumeData>(image.error());
}

Result<VolumeData> readOne(const VolumeSource& source, const fs::path& path, const VolumeReadOptions& options,
                           std::vector<std::string>& notes) {
    Result<ContainedImage> contained = readContainer(source, path, options);
    VOXTACT_TRY(contained);
    notes = std::move(contained->notes);
    return toScalars(std::move(contained->image), path);
}

std::string nameOf(const fs::path& path) {
    return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

/// What every reader's volume goes through at last.
Result<VolumeData> checked(Result<VolumeData> volume, const fs::path& path, std::vector<std::string> notes) {
    if (!volume.ok()) {
        return volume;
    }
    if (const Result<ValueRange> range = checkVolume(volume->view()); !range.ok()) {
        return cannotRead(path, range.error().text);
    }
    volume->name = nameOf(path);
    notes.insert(notes.end(), volume->notes.begin(), volume->notes.end());
    volume->notes = std::move(notes);
    return volume;
}

} // namespace

Result<VolumeData> readVolume(const fs::path& path, const VolumeReadOptions& options) {
    return guard([&]() -> Result<VolumeData> {
        std::error_code ignored;
        std::vector<std::string> notes;
        Result<VolumeData> volume = fs::is_directory(path, ignored)
                                        ? readFolder(path, options, notes)
                                        : readOne(VolumeSource(options.progress), path, options, notes);
        return checked(std::move(volume), path, std::move(notes));
    });
}

Result<VolumeData> readVolume(std::string_view name, std::span<const std::byte> content,
                              const VolumeReadOptions& options) {
    return guard([&]() -> Result<VolumeData> {
        const fs::path path(name);
        std::vector<std::string> notes;
        Result<VolumeData> volume = readOne(VolumeSource(path, content), path, options, notes);
        return checked(std::move(volume), path, std::move(notes));
    });
}

} // namespace voxtact::io
