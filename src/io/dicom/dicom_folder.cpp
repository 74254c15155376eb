// SPDX-License-Identifier: MIT
#include "io/dicom/dicom_folder.h"

#include "core/base/try.h"
#include "io/dicom/dicom_resample.h"
#include "io/dicom/dicom_stack.h"
#include "io/dicom/dicom_values.h"
#include "io/dicom/dicom_walker.h"
#include "io/errors.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

/// SOP classes without an image (PS3.6): directories, reports, plans, measurements.
bool holdsNoImage(const DicomFile& file) {
    constexpr std::array<std::string_view, 10> kClasses{
        "1.2.840.10008.1.3.10",          // DICOMDIR
        "1.2.840.10008.5.1.4.1.1.11.",   // presentation states
        "1.2.840.10008.5.1.4.1.1.66",    // raw data, registrations, fiducials
        "1.2.840.10008.5.1.4.1.1.67",    // real-world value mapping
        "1.2.840.10008.5.1.4.1.1.78.",   // eyes measured
        "1.2.840.10008.5.1.4.1.1.88.",   // structured reports, key objects
        "1.2.840.10008.5.1.4.1.1.9.",    // waveforms
        "1.2.840.10008.5.1.4.1.1.104.",  // documents
        "1.2.840.10008.5.1.4.1.1.481.",  // structure sets, plans, treatment records
        "1.2.840.10008.5.1.4.1.1.200."}; // protocols
    std::string_view uid = file.set.text(dicom::kSopClass);
    if (uid.empty()) {
        uid = file.set.text(dicom::kMediaStorage);
    }
    return !file.pixels && std::any_of(kClasses.begin(), kClasses.end(), [&](std::string_view one) {
        return uid == one || (uid.starts_with(one) && (one.ends_with('.') || uid[one.size()] == '.'));
    });
}

struct Survey {
    std::vector<DicomFile> images;
    std::vector<std::string> leftOut; ///< names of files that are not DICOM; those too short for it first
    std::size_t others = 0;           ///< DICOM files that hold no image
    bool hasDirectory = false;
};

/// Lists regular files, and links to them, by name. Refuses dangling links and inaccessible files: they may be slices.
Result<std::vector<fs::path>> filesOf(const fs::path& folder) {
    std::error_code problem;
    std::vector<fs::path> paths;
    for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem)) {
        std::error_code unknown;
        const fs::file_type type = entry->status(unknown).type();
        if (type == fs::file_type::not_found) {
            // Else it has gone meanwhile; hidden links are locks of editors.
            if (entry->is_symlink(unknown) && !entry->path().filename().string().starts_with('.')) {
                return cannotRead(entry->path(), "it is a link to a file that is not there", ErrorCode::File);
            }
            continue;
        }
        if (type == fs::file_type::none || type == fs::file_type::unknown) {
            return cannotRead(entry->path(), unknown ? unknown.message() : "nobody knows what it is", ErrorCode::File);
        }
        if (type == fs::file_type::regular) {
            paths.push_back(entry->path());
        }
    }
    if (problem) {
        return cannotRead(folder, problem.message(), ErrorCode::File);
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

/// A file that is not DICOM: its name may say that it was.
Result<void> leaveOut(const fs::path& path, Survey& found) {
    std::error_code unknown;
    const std::uintmax_t size = fs::file_size(path, unknown);
    const std::string what = size == 0 ? "it is empty" : "it is no DICOM file (" + std::to_string(size) + " bytes)";
    // A hidden file is no slice: macOS writes '._NAME' for each file on other disks.
    if (lowerEnding(path) == ".dcm" && !path.filename().string().starts_with('.')) {
        return cannotRead(path, what + ", and its name ends in .dcm; get it again or take it away");
    }
    constexpr std::uintmax_t kShort = 132; // where "DICM" ends
    const std::string name = "'" + printable(path.filename().string()) + "'" + (size == 0 ? " (empty)" : "");
    found.leftOut.insert(size < kShort ? found.leftOut.begin() : found.leftOut.end(), name);
    return {};
}

Result<Survey> survey(const fs::path& folder) {
    constexpr std::string_view kDirectoryClass = "1.2.840.10008.1.3.10";
    const Result<std::vector<fs::path>> paths = filesOf(folder);
    VOXTACT_TRY(paths);
    Survey found;
    for (const fs::path& path : *paths) {
        Result<std::optional<DicomFile>> file = readDicomFile(path);
        VOXTACT_TRY(file); // of one that cannot be read, nobody knows whether it is a slice
        if (!*file) {
            VOXTACT_TRY(leaveOut(path, found));
        } else if (holdsNoImage(**file)) {
            ++found.others;
            found.hasDirectory = found.hasDirectory || (*file)->set.text(dicom::kMediaStorage) == kDirectoryClass;
        } else if (!(*file)->pixels) {
            return cannotRead(path, "it is a DICOM file without an image, or it is truncated; get it again or take it "
                                    "away");
        } else {
            found.images.push_back(std::move(**file));
        }
    }
    if (found.images.empty()) {
        return cannotRead(folder, found.hasDirectory
                                      ? "the folder holds a DICOMDIR and no images; give the folder below it "
                                        "that holds the slices"
                                      : "the folder holds no DICOM series");
    }
    return found;
}

/// "1.2.3 (CT, 'Thorax', 120 files)"
std::string describe(const std::string& uid, const std::vector<const DicomFile*>& files) {
    const DicomDataSet& set = files.front()->set;
    std::string text = (uid.empty() ? "one without SeriesInstanceUID" : printable(uid)) + " (";
    for (const DicomTag tag : {dicom::kModality, dicom::kSeriesDescription}) {
        if (set.find(tag) != nullptr) {
            text += (tag == dicom::kModality ? printable(set.text(tag)) : "'" + printable(set.text(tag)) + "'") + ", ";
        }
    }
    return text + std::to_string(files.size()) + (files.size() == 1 ? " file)" : " files)");
}

using Series = std::map<std::string, std::vector<const DicomFile*>>;

std::string listOf(const Series& series) {
    constexpr std::size_t kMostListed = 8;
    std::string list;
    std::size_t listed = 0;
    for (const auto& [uid, of] : series) {
        if (++listed > kMostListed) {
            list += ", ...";
            break;
        }
        list += (list.empty() ? "" : ", ") + describe(uid, of);
    }
    return list;
}

/// Leaves the files of the series that is wanted, or of the only one.
Result<void> chooseSeries(const fs::path& folder, std::string_view wanted, std::vector<DicomFile>& files) {
    Series series;
    for (const DicomFile& file : files) {
        series[std::string(file.set.text(dicom::kSeries))].push_back(&file);
    }
    if (wanted.empty()) {
        return series.size() == 1 ? Result<void>()
                                  : cannotRead(folder, "the folder holds " + std::to_string(series.size()) +
                                                           " DICOM series: " + listOf(series) +
                                                           "; name the one that is meant (to the program: FOLDER#UID)");
    }
    if (!series.contains(std::string(wanted))) {
        return cannotRead(folder,
                          "the folder holds no DICOM series " + printable(wanted) + "; it holds " + listOf(series));
    }
    std::erase_if(files, [&](const DicomFile& file) { return file.set.text(dicom::kSeries) != wanted; });
    return {};
}

/// Compressed data may claim any size; real series are far below a thousand times their files.
Result<void> checkExpansion(const fs::path& folder, const std::vector<DicomFile>& files,
                            const std::vector<DicomImage>& images) {
    constexpr std::uint64_t kLet = std::uint64_t{1} << 28;
    constexpr std::uint64_t kMost = 1000;
    constexpr std::uint64_t kFar = std::uint64_t{1} << 50;
    std::uint64_t stored = 0;
    std::uint64_t claimed = 0;
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (files[i].syntax->coding != DicomCoding::Native || files[i].syntax->deflated) {
            stored += files[i].bytes;
            claimed += std::min(kFar, images[i].frameBytes() * images[i].frames);
        }
        if (claimed > kLet && claimed / kMost > stored) {
            return cannotRead(folder, "'" + printable(files[i].path.filename().string()) + "' claims " +
                                          std::to_string(images[i].columns) + " x " + std::to_string(images[i].rows) +
                                          " pixels in " + std::to_string(images[i].frames) + " frames, far more than " +
                                          std::to_string(files[i].bytes) +
                                          " compressed bytes hold; get the file again");
        }
    }
    return {};
}

struct Stack {
    std::vector<DicomImage> images; ///< of each file
    std::vector<DicomSlice> slices; ///< of all files
};

Result<Stack> stackOf(const fs::path& folder, const std::vector<DicomFile>& files) {
    Stack stack;
    for (const DicomFile& file : files) {
        const Result<DicomImage> image = dicomImage(file);
        VOXTACT_TRY(image);
        const Result<std::vector<DicomSlice>> frames = dicomSlices(file, *image, stack.images.size());
        VOXTACT_TRY(frames);
        stack.images.push_back(*image);
        stack.slices.insert(stack.slices.end(), frames->begin(), frames->end());
    }
    VOXTACT_TRY(checkAlike(files, stack.images, stack.slices));
    if (stack.slices.size() < 2) {
        return cannotRead(folder, "the DICOM series has fewer than 2 slices; a 3D image is needed");
    }
    VOXTACT_TRY(checkExpansion(folder, files, stack.images));
    return stack;
}

/// "1 file", "4 files"
std::string filesText(std::size_t count) {
    return std::to_string(count) + (count == 1 ? " file" : " files");
}

bool mapsToRealWorld(const DicomDataSet& set) {
    const auto in = [&](DicomTag groups) {
        const std::vector<DicomDataSet>* const list = set.items(groups);
        return list != nullptr && list->front().items(dicom::kRealWorldMapping) != nullptr;
    };
    return set.items(dicom::kRealWorldMapping) != nullptr || in(dicom::kShared) || in(dicom::kPerFrame);
}

/// Harmless oddities and unused properties of the files.
void noteOddities(const Survey& found, const Stack& stack, std::vector<std::string>& notes) {
    const std::vector<DicomFile>& files = found.images;
    const auto count = [](const auto& list, auto&& is) {
        return static_cast<std::size_t>(std::count_if(list.begin(), list.end(), is));
    };
    if (const std::size_t odd = count(files, [](const DicomFile& file) { return file.isOtherSyntax; }); odd != 0) {
        notes.push_back(filesText(odd) + " whose elements are not stored by the transfer syntax that the file names "
                                         "(explicit or implicit); read as they are stored");
    }
    if (const std::size_t odd = count(files, [](const DicomFile& file) { return file.zeros != 0; }); odd != 0) {
        notes.push_back(filesText(odd) + " with blocks of zeros behind the last element");
    }
    if (const std::size_t odd = count(stack.images, [](const DicomImage& image) { return image.excess != 0; });
        odd != 0) {
        notes.push_back(filesText(odd) + " with more bytes of pixels than rows, columns and frames take; the first "
                                         "ones are taken");
    }
    if (count(files, [](const DicomFile& file) { return mapsToRealWorld(file.set); }) != 0) {
        notes.push_back("RealWorldValueMappingSequence " + toText(dicom::kRealWorldMapping) +
                        " is not applied: values are those of RescaleSlope and RescaleIntercept");
    }
    if (count(files, [](const DicomFile& file) { return file.set.find(dicom::kDoseScaling) != nullptr; }) != 0) {
        notes.emplace_back("voxels are doses: DoseGridScaling is applied");
    }
}

std::vector<std::string> notesOf(const Survey& found, const Stack& stack, StoredType type, const std::string& apart) {
    std::vector<std::string> notes{"DICOM series of " + std::to_string(stack.slices.size()) + " slices" + apart};
    if (std::string note = rescaleNote(stack.slices, type); !note.empty()) {
        notes.push_back(std::move(note));
    }
    if (found.others > 0) {
        notes.push_back(std::to_string(found.others) + " DICOM files without images left out");
    }
    if (!found.leftOut.empty()) {
        constexpr std::size_t kMaxNamed = 4;
        std::string names;
        for (std::size_t i = 0; i < std::min(kMaxNamed, found.leftOut.size()); ++i) {
            names += (i == 0 ? "" : ", ") + found.leftOut[i];
        }
        notes.push_back(filesText(found.leftOut.size()) + " left out that are not DICOM: " + names +
                        (found.leftOut.size() > kMaxNamed ? ", ..." : ""));
    }
    noteOddities(found, stack, notes);
    return notes;
}

} // namespace

Result<StoredImage> readDicomFolder(const fs::path& folder, const VolumeReadOptions& options,
                                    std::vector<std::string>& notes) {
    Result<Survey> found = survey(folder);
    VOXTACT_TRY(found);
    VOXTACT_TRY(chooseSeries(folder, options.series, found->images));
    const std::vector<DicomFile>& files = found->images;
    Result<Stack> stack = stackOf(folder, files);
    VOXTACT_TRY(stack);
    VOXTACT_TRY(sortSlices(folder, files, stack->slices));
    std::vector<std::string> places; // notes
    const Result<Grid> grid = stackSlices(folder, stack->images.front(), stack->slices, places);
    std::optional<DicomResampler> resampler;
    if (!grid.ok() && options.resample) {
        Result<DicomResampler> made = DicomResampler::create(folder, stack->images.front(), stack->slices);
        VOXTACT_TRY(made);
        resampler = std::move(*made);
    } else {
        VOXTACT_TRY(grid);
    }
    const StoredType type = dicomType(stack->images, stack->slices);
    Result<std::vector<std::byte>> voxels = dicomVoxels(files, stack->images, stack->slices, type, options.progress);
    VOXTACT_TRY(voxels);
    StoredImage image;
    if (resampler) {
        image = resampler->resample(type, *voxels, places);
    } else {
        image.grid = *grid;
        image.type = type;
        image.voxels = std::move(*voxels);
    }
    notes = notesOf(*found, *stack, type, resampler ? "" : ", " + millimetres(grid->spacing[2]) + " mm apart");
    notes.insert(notes.end(), places.begin(), places.end());
    return image;
}

} // namespace voxtact::io
