// SPDX-License-Identifier: MIT
#include "core/base/guard.h"

#include "core/base/try.h"
#include "io/dicom/dicom_folder.h"
#include "io/dicom/dicom_resample.h"
#include "io/errors.h"
#include "io/labels/dicom_labels.h"
#include "io/labels/segment_map.h"
#include "io/volume/volume_container.h"
#include "voxtact/io.h"

#include <algorithm>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

Result<StoredImage> readFolder(const fs::path& path, const VolumeReadOptions& options,
                               std::vector<std::string>& notes) {
    if (options.frame) {
        return cannotRead(path, "it is a folder of DICOM files: one of several series is chosen, and no frame (" +
                                    std::to_string(*options.frame) + ")");
    }
    return readDicomFolder(path, options, notes);
}

Result<StoredImage> readFile(const VolumeSource& source, const fs::path& path, const VolumeReadOptions& options,
                             std::vector<std::string>& notes) {
    Result<ContainedImage> contained = readContainer(source, path, options);
    VOXTACT_TRY(contained);
    notes = std::move(contained->notes);
    return std::move(contained->image);
}

Result<StoredImage> readStored(const fs::path& path, const VolumeReadOptions& options,
                               std::vector<std::string>& notes) {
    std::error_code ignored;
    return fs::is_directory(path, ignored) ? readFolder(path, options, notes)
                                           : readFile(VolumeSource(options.progress), path, options, notes);
}

std::string nameOf(const fs::path& path) {
    return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

/// The last step of every reader.
Result<VolumeData> volumeOf(Result<StoredImage> image, const fs::path& path, std::vector<std::string> notes) {
    VOXTACT_TRY(image);
    Result<VolumeData> volume = toScalars(std::move(*image), path);
    VOXTACT_TRY(volume);
    if (const Result<ValueRange> range = checkVolume(volume->view()); !range.ok()) {
        return cannotRead(path, range.error().text);
    }
    volume->name = nameOf(path);
    notes.insert(notes.end(), volume->notes.begin(), volume->notes.end());
    volume->notes = std::move(notes);
    return volume;
}

/// Returns true if a float may not hold the labels of such voxels.
bool isWide(const StoredImage& image) {
    return !image.scaling && storedBytes(image.type) >= 4 && image.type != StoredType::Float32;
}

} // namespace

Result<VolumeData> readVolume(const fs::path& path, const VolumeReadOptions& options) {
    return guard([&]() -> Result<VolumeData> {
        std::vector<std::string> notes;
        Result<StoredImage> image = readStored(path, options, notes);
        return volumeOf(std::move(image), path, std::move(notes));
    });
}

Result<VolumeData> readVolume(std::string_view name, std::span<const std::byte> content,
                              const VolumeReadOptions& options) {
    return guard([&]() -> Result<VolumeData> {
        const fs::path path(name);
        std::vector<std::string> notes;
        Result<StoredImage> image = readFile(VolumeSource(path, content), path, options, notes);
        return volumeOf(std::move(image), path, std::move(notes));
    });
}

bool wasResampled(const VolumeData& volume) noexcept {
    return std::ranges::any_of(volume.notes, [](const std::string& note) { return note.starts_with(kResampledNote); });
}

Result<LabelFile> readLabels(const fs::path& path, const VolumeReadOptions& options) {
    return guard([&]() -> Result<LabelFile> {
        Result<std::optional<LabelFile>> segmentation = readSegNrrd(path, options);
        VOXTACT_TRY(segmentation);
        if (*segmentation) {
            return std::move(**segmentation);
        }
        Result<std::optional<LabelFile>> dicom = readDicomLabels(path, options);
        VOXTACT_TRY(dicom);
        return *dicom ? std::move(**dicom) : readLabelImage(path, options);
    });
}

bool holdsContours(const fs::path& path) {
    const Result<bool> holds = guard([&]() -> Result<bool> { return isRtStruct(path); });
    return holds.ok() && *holds;
}

Result<LabelFile> readLabelImage(const fs::path& path, const VolumeReadOptions& options) {
    return guard([&]() -> Result<LabelFile> {
        LabelFile file;
        VolumeReadOptions asStored = options;
        asStored.resample = false;
        Result<StoredImage> image = readStored(path, asStored, file.notes);
        VOXTACT_TRY(image);
        Result<LabelData> labels = [&]() -> Result<LabelData> {
            if (isWide(*image)) {
                const Result<std::vector<std::int32_t>> wide = toLabels(*image, path);
                VOXTACT_TRY(wide);
                return makeLabels(image->grid, *wide);
            }
            Result<VolumeData> volume = volumeOf(std::move(image), path, std::move(file.notes));
            VOXTACT_TRY(volume);
            file.notes = std::move(volume->notes);
            return makeLabels(volume->view());
        }();
        if (!labels.ok()) {
            const bool isNamed = labels.error().text.starts_with("cannot ");
            return isNamed ? labels.error()
                           : Error{ErrorCode::Format, 0,
                                   "cannot use '" + path.string() + "' as a label map: " + labels.error().text};
        }
        file.labels = std::move(*labels);
        return file;
    });
}

} // namespace voxtact::io
