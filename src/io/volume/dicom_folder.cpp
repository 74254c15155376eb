// SPDX-License-Identifier: MIT
#include "core/text.h"
#include "io/byte_source.h"
#include "io/errors.h"
#include "io/volume/itk_image.h"

#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

struct Slice {
    fs::path path;
    ItkImage image;    ///< without voxels
    double height = 0; ///< along the normal of the first slice, mm
};

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// In thousandths, for messages.
std::string millimetres(double length) {
    return number(std::round(length * 1000) / 1000);
}

Vec3 normalOf(const Grid& grid) {
    return {grid.direction[6], grid.direction[7], grid.direction[8]};
}

Result<std::vector<std::string>> seriesFiles(const fs::path& folder) {
    const auto names = itk::GDCMSeriesFileNames::New();
    names->SetUseSeriesDetails(false);
    names->SetRecursive(false);
    names->SetDirectory(folder.string());
    const std::vector<std::string> series = names->GetSeriesUIDs();
    if (series.empty()) {
        return cannotRead(folder, "the folder holds no DICOM series");
    }
    if (series.size() > 1) {
        std::string list;
        for (const std::string& uid : series) {
            list +=
                (list.empty() ? "" : ", ") + uid + " (" + std::to_string(names->GetFileNames(uid).size()) + " files)";
        }
        return cannotRead(folder, "the folder holds " + std::to_string(series.size()) + " DICOM series: " + list +
                                      "; put the one that is meant into a folder of its own");
    }
    return std::vector<std::string>(names->GetFileNames(series.front()));
}

/// A DICOM file that GDCM cannot read is left out of the series; at the end of the stack nobody would miss it.
Result<void> checkNothingLeftOut(const fs::path& folder, const std::vector<std::string>& files) {
    constexpr std::size_t kMagicEnd = 132;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        const bool taken = std::any_of(files.begin(), files.end(),
                                       [&](const std::string& file) { return fs::path(file).filename() == name; });
        if (taken || name == "DICOMDIR" || !entry.is_regular_file()) {
            continue;
        }
        const Result<std::string> head = contentHead(entry.path(), kMagicEnd);
        if (head.ok() && head->size() == kMagicEnd && head->ends_with("DICM")) {
            return cannotRead(entry.path(),
                              "it is a DICOM file without a readable image; get it again or take it away");
        }
    }
    return {};
}

Result<std::vector<Slice>> readSlices(const std::vector<std::string>& files) {
    std::vector<Slice> slices;
    for (const std::string& file : files) {
        if (Result<void> whole = checkDicomSlice(file); !whole.ok()) {
            return whole.error();
        }
        const auto io = itk::GDCMImageIO::New();
        Result<ItkImage> image = readInformation(*io, file);
        if (!image.ok()) {
            return image.error();
        }
        if (image->grid.size[2] != 1) {
            return cannotRead(file, "it holds " + std::to_string(image->grid.size[2]) +
                                        " frames; only series with one slice a file are supported");
        }
        slices.push_back({file, std::move(*image), 0});
    }
    return slices;
}

/// All slices must be of one size, type, spacing and direction.
Result<void> checkAlike(const std::vector<Slice>& slices) {
    const ItkImage& first = slices.front().image;
    for (const Slice& slice : slices) {
        const Grid& grid = slice.image.grid;
        const char* what = nullptr;
        if (grid.size != first.grid.size) {
            what = "size";
        } else if (slice.image.component != first.component) {
            what = "voxel type";
        }
        constexpr double kTolerance = 1e-4;
        for (std::size_t i = 0; i < grid.direction.size(); ++i) {
            if (std::abs(grid.direction[i] - first.grid.direction[i]) > kTolerance) {
                what = "direction";
            }
        }
        for (std::size_t axis = 0; axis < 2; ++axis) {
            if (std::abs(grid.spacing[axis] - first.grid.spacing[axis]) > kTolerance * first.grid.spacing[axis]) {
                what = "spacing";
            }
        }
        if (what != nullptr) {
            return cannotRead(slice.path, std::string("the slice's ") + what + " is not that of '" +
                                              slices.front().path.filename().string() + "' in the same series");
        }
    }
    return {};
}

void sortAlongNormal(std::vector<Slice>& slices) {
    const Vec3 normal = normalOf(slices.front().image.grid);
    for (Slice& slice : slices) {
        slice.height = dot(slice.image.grid.origin, normal);
    }
    std::stable_sort(slices.begin(), slices.end(), [](const Slice& a, const Slice& b) { return a.height < b.height; });
}

/// Written positions are rounded, so a hundredth of a millimetre or a fiftieth of a gap is let pass.
double tolerance(double gap) {
    constexpr double kLeast = 0.01;
    constexpr double kShare = 0.02;
    return std::max(kLeast, kShare * gap);
}

Result<double> evenGap(const fs::path& folder, const std::vector<Slice>& slices) {
    const double begin = slices.front().height;
    const double gap = (slices.back().height - begin) / static_cast<double>(slices.size() - 1);
    for (std::size_t i = 1; i < slices.size(); ++i) {
        const double here = slices[i].height - slices[i - 1].height;
        if (here < 1e-4) {
            return cannotRead(folder, "'" + slices[i - 1].path.filename().string() + "' and '" +
                                          slices[i].path.filename().string() + "' are at the same place");
        }
    }
    for (std::size_t i = 1; i < slices.size(); ++i) {
        const double here = slices[i].height - slices[i - 1].height;
        if (std::abs(slices[i].height - begin - gap * static_cast<double>(i)) > tolerance(gap) ||
            std::abs(here - gap) > tolerance(gap)) {
            return cannotRead(folder, "the gaps between its slices are uneven: " + millimetres(here) + " mm before '" +
                                          slices[i].path.filename().string() + "', " + millimetres(gap) +
                                          " mm on average; a slice is missing, or the series must be resampled");
        }
    }
    return gap;
}

/// A tilted gantry shifts each slice within its plane, which spacing and direction cannot say.
Result<void> checkUpright(const fs::path& folder, const std::vector<Slice>& slices, double gap) {
    const Grid& first = slices.front().image.grid;
    const Grid& last = slices.back().image.grid;
    const Vec3 step{last.origin[0] - first.origin[0], last.origin[1] - first.origin[1],
                    last.origin[2] - first.origin[2]};
    const double rise = dot(step, normalOf(first));
    const double shift = std::sqrt(std::max(0.0, dot(step, step) - rise * rise));
    if (shift > std::max(tolerance(gap), 0.1 * std::min(first.spacing[0], first.spacing[1]))) {
        const double degrees = std::atan2(shift, rise) * 180 / std::numbers::pi;
        return cannotRead(folder, "its slices are sheared by " + number(std::round(degrees * 10) / 10) +
                                      " degrees (tilted gantry); resample the series to an upright one");
    }
    return {};
}

} // namespace

Result<ItkImage> readDicomFolder(const fs::path& folder, std::vector<std::string>& notes) {
    const Result<std::vector<std::string>> files = seriesFiles(folder);
    if (!files.ok()) {
        return files.error();
    }
    if (Result<void> all = checkNothingLeftOut(folder, *files); !all.ok()) {
        return all.error();
    }
    if (files->size() < 2) {
        return cannotRead(folder, "the DICOM series has fewer than 2 slices; a 3D image is needed");
    }
    Result<std::vector<Slice>> slices = readSlices(*files);
    if (!slices.ok()) {
        return slices.error();
    }
    sortAlongNormal(*slices);
    if (Result<void> alike = checkAlike(*slices); !alike.ok()) {
        return alike.error();
    }
    const Result<double> gap = evenGap(folder, *slices);
    if (!gap.ok()) {
        return gap.error();
    }
    if (Result<void> upright = checkUpright(folder, *slices, *gap); !upright.ok()) {
        return upright.error();
    }
    ItkImage image = slices->front().image;
    image.grid.size[2] = static_cast<std::uint32_t>(slices->size());
    image.grid.spacing[2] = *gap;
    for (const Slice& slice : *slices) {
        const auto io = itk::GDCMImageIO::New();
        if (Result<ItkImage> information = readInformation(*io, slice.path); !information.ok()) {
            return information;
        }
        readVoxels(*io, image.voxels);
    }
    notes.push_back("DICOM series of " + std::to_string(slices->size()) + " slices, " + millimetres(*gap) +
                    " mm apart");
    return image;
}

} // namespace voxtact::io
