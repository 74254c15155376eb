// SPDX-License-Identifier: MIT
#include "io/dicom/dicom_stack.h"
#include "core/geometry/vec3.h"

#include "core/base/text.h"
#include "core/base/try.h"
#include "io/dicom/dicom_walker.h"
#include "io/errors.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace voxtact::io {

namespace {

bool near(const Vec3& a, const Vec3& b, double tolerance) {
    const Vec3 d = minus(a, b);
    return std::abs(d[0]) <= tolerance && std::abs(d[1]) <= tolerance && std::abs(d[2]) <= tolerance;
}

std::string toText(const Vec3& vector) {
    return "(" + millimetres(vector[0]) + ", " + millimetres(vector[1]) + ", " + millimetres(vector[2]) + ")";
}

/// Something in which all slices of a stack agree.
struct Property {
    const char* name;
    std::function<bool(const DicomSlice&, const DicomSlice&)> agree;
    std::function<std::string(const DicomSlice&)> text;
};

std::vector<Property> properties(const std::vector<DicomFile>& files, const std::vector<DicomImage>& images) {
    constexpr double kDirection = 1e-4;
    constexpr double kSpacing = 1e-4;
    const auto frameOfReference = [&files](const DicomSlice& slice) {
        return files[slice.file].set.text(dicom::kFrameOfReference);
    };
    const auto size = [&images](const DicomSlice& slice) {
        return std::to_string(images[slice.file].columns) + " x " + std::to_string(images[slice.file].rows);
    };
    return {{"size", [size](const DicomSlice& a, const DicomSlice& b) { return size(a) == size(b); }, size},
            {"orientation",
             [](const DicomSlice& a, const DicomSlice& b) {
                 return near(a.across, b.across, kDirection) && near(a.down, b.down, kDirection);
             },
             [](const DicomSlice& s) { return "rows " + toText(s.across) + ", columns " + toText(s.down); }},
            {"pixel spacing in mm",
             [](const DicomSlice& a, const DicomSlice& b) {
                 return std::abs(a.spacing[0] - b.spacing[0]) <= kSpacing * b.spacing[0] &&
                        std::abs(a.spacing[1] - b.spacing[1]) <= kSpacing * b.spacing[1];
             },
             [](const DicomSlice& s) { return number(s.spacing[0]) + " x " + number(s.spacing[1]); }},
            {"frame of reference",
             [frameOfReference](const DicomSlice& a, const DicomSlice& b) {
                 return frameOfReference(a) == frameOfReference(b);
             },
             [frameOfReference](const DicomSlice& s) { return "'" + printable(frameOfReference(s)) + "'"; }},
            {"rescaling", [](const DicomSlice& a, const DicomSlice& b) { return a.isRescaled == b.isRescaled; },
             [](const DicomSlice& s) {
                 return std::string(s.isRescaled ? "RescaleSlope and RescaleIntercept" : "neither");
             }}};
}

/// Returns the majority value, if any (Boyer and Moore's vote).
const DicomSlice& usual(const std::vector<DicomSlice>& slices, const Property& property) {
    std::size_t candidate = 0;
    std::size_t votes = 0;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        if (votes == 0) {
            candidate = i;
        }
        votes = property.agree(slices[i], slices[candidate]) ? votes + 1 : votes - 1;
    }
    return slices[candidate];
}

/// Elements that distinguish two images at one position.
std::string difference(const DicomDataSet& a, const DicomDataSet& b) {
    if (!a.text(dicom::kSopInstance).empty() && a.text(dicom::kSopInstance) == b.text(dicom::kSopInstance)) {
        return "they are the same image; take one of them away";
    }
    for (const auto& [tag, name] :
         {std::pair{dicom::kTemporalPosition, "TemporalPositionIdentifier"},
          std::pair{dicom::kEchoNumbers, "EchoNumbers"}, std::pair{dicom::kEchoTime, "EchoTime"},
          std::pair{dicom::kTriggerTime, "TriggerTime"}, std::pair{dicom::kAcquisitionNumber, "AcquisitionNumber"},
          std::pair{dicom::kImageType, "ImageType"}}) {
        if (a.text(tag) != b.text(tag)) {
            return std::string("they differ in ") + name + " ('" + printable(a.text(tag)) + "' and '" +
                   printable(b.text(tag)) +
                   "'): the series holds more than one image; put one into a folder of its own";
        }
    }
    return "the series holds more than one image, or one of them twice; put one image into a folder of its own";
}

/// Written positions are rounded, so a hundredth of a millimetre or a fiftieth of a gap is let pass.
double tolerance(double gap) {
    constexpr double kLeast = 0.01;
    constexpr double kShare = 0.02;
    return std::max(kLeast, kShare * gap);
}

constexpr const char* kHow = " (to the program: --resample)";

/// "'a.dcm' (at 12.5 mm) and 'b.dcm' (at 17.5 mm)"; places along the normal, from the patient's origin.
std::string between(const DicomSlice& a, const DicomSlice& b) {
    return a.name + " (at " + millimetres(a.height) + " mm) and " + b.name + " (at " + millimetres(b.height) + " mm)";
}

Error unevenGap(const std::filesystem::path& folder, const std::vector<DicomSlice>& slices, std::size_t at,
                double usualGap) {
    std::size_t others = 0;
    for (std::size_t i = 1; i < slices.size(); ++i) {
        const double here = slices[i].height - slices[i - 1].height;
        others += i != at && std::abs(here - usualGap) > tolerance(usualGap) ? 1 : 0;
    }
    const double here = slices[at].height - slices[at - 1].height;
    const double missing = std::round(here / usualGap) - 1;
    const bool isGap = missing >= 1 && std::abs(here - (missing + 1) * usualGap) <= tolerance(usualGap) * (missing + 1);
    const std::string where = between(slices[at - 1], slices[at]);
    const std::string rest = others == 0 ? "" : " (and " + std::to_string(others) + " more such gaps)";
    if (isGap) {
        const std::string what = missing == 1 ? "a slice is missing" : number(missing) + " slices are missing";
        return cannotRead(folder, what + " between " + where + rest + ": most gaps are " + millimetres(usualGap) +
                                      " mm, this one is " + millimetres(here) +
                                      " mm; add what is missing, or resample the series" + kHow);
    }
    return cannotRead(folder, "the gaps between its slices are uneven: " + millimetres(here) + " mm between " + where +
                                  rest + ", where " + millimetres(usualGap) +
                                  " mm are usual; resample the series to even gaps" + kHow);
}

/// Returns the first slice off the even spacing; 0 if none.
std::size_t firstUneven(const std::vector<DicomSlice>& slices, double usualGap) {
    for (std::size_t i = 1; i < slices.size(); ++i) {
        if (std::abs(slices[i].height - slices[i - 1].height - usualGap) > tolerance(usualGap)) {
            return i;
        }
    }
    // Gaps that drift, each a little.
    const double begin = slices.front().height;
    const double mean = (slices.back().height - begin) / static_cast<double>(slices.size() - 1);
    for (std::size_t i = 1; i < slices.size(); ++i) {
        if (std::abs(slices[i].height - begin - mean * static_cast<double>(i)) > tolerance(mean)) {
            return i;
        }
    }
    return 0;
}

Result<void> checkGaps(const std::filesystem::path& folder, const std::vector<DicomSlice>& slices) {
    std::vector<double> gaps;
    for (std::size_t i = 1; i < slices.size(); ++i) {
        gaps.push_back(slices[i].height - slices[i - 1].height);
    }
    std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>((gaps.size() - 1) / 2), gaps.end());
    const double usualGap = gaps[(gaps.size() - 1) / 2];
    if (const std::size_t at = firstUneven(slices, usualGap); at != 0) {
        return unevenGap(folder, slices, at, usualGap);
    }
    return {};
}

/// A tilted gantry shifts each slice within its plane, which spacing and direction cannot say.
Result<void> checkUpright(const std::filesystem::path& folder, const std::vector<DicomSlice>& slices, double gap,
                          std::vector<std::string>& notes) {
    const DicomSlice& first = slices.front();
    const double allowed = std::max(tolerance(gap), 0.1 * std::min(first.spacing[0], first.spacing[1]));
    const auto shiftOf = [&](const DicomSlice& slice) {
        const Vec3 step = minus(slice.position, first.position);
        return std::array{dot(step, first.across), dot(step, first.down)};
    };
    const std::array<double, 2> whole = shiftOf(slices.back());
    const double rise = slices.back().height - first.height;
    double most = 0;
    for (std::size_t i = 1; i < slices.size(); ++i) {
        const double share = (slices[i].height - first.height) / rise;
        const std::array<double, 2> shift = shiftOf(slices[i]);
        most = std::max(most, std::hypot(shift[0], shift[1]));
        const double offset = std::hypot(shift[0] - share * whole[0], shift[1] - share * whole[1]);
        if (offset > allowed) {
            return cannotRead(
                folder, slices[i].name + " (at " + millimetres(slices[i].height) + " mm) lies " + millimetres(offset) +
                            " mm off the line of the other slices' first pixels; resample the series" + kHow);
        }
    }
    const double shift = std::hypot(whole[0], whole[1]);
    const double degrees = std::atan2(shift, rise) * 180 / std::numbers::pi;
    if (shift > allowed) {
        return cannotRead(folder, "its slices are sheared by " + number(std::round(degrees * 10) / 10) +
                                      " degrees (tilted gantry); resample the series to an upright one" + kHow);
    }
    constexpr double kRounding = 0.01; // mm, of positions as they are written
    if (most > kRounding) {
        notes.push_back("the slices lie up to " + millimetres(most) + " mm off the first one's normal (" +
                        number(std::round(degrees * 100) / 100) + " degrees in all); they are stacked upright");
    }
    return {};
}

} // namespace

std::string millimetres(double length) {
    const double rounded = std::round(length * 1000) / 1000;
    return number(rounded == 0 ? 0 : rounded);
}

Result<void> checkAlike(const std::vector<DicomFile>& files, const std::vector<DicomImage>& images,
                        const std::vector<DicomSlice>& slices) {
    for (const Property& property : properties(files, images)) {
        const DicomSlice& most = usual(slices, property);
        for (const DicomSlice& slice : slices) {
            if (!property.agree(slice, most)) {
                return cannotRead(files[slice.file].path, "the " + std::string(property.name) + " of " + slice.name +
                                                              " is " + property.text(slice) + ", that of " + most.name +
                                                              " in the same series is " + property.text(most) +
                                                              "; take away what is not of this image");
            }
        }
    }
    return {};
}

Result<void> sortSlices(const std::filesystem::path& folder, const std::vector<DicomFile>& files,
                        std::vector<DicomSlice>& slices) {
    constexpr double kSame = 1e-4;
    const Vec3 normal = cross(slices.front().across, slices.front().down);
    for (DicomSlice& slice : slices) {
        slice.height = dot(slice.position, normal);
    }
    std::stable_sort(slices.begin(), slices.end(),
                     [](const DicomSlice& a, const DicomSlice& b) { return a.height < b.height; });
    for (std::size_t i = 1; i < slices.size(); ++i) {
        if (slices[i].height - slices[i - 1].height < kSame) {
            const bool oneFile = slices[i].file == slices[i - 1].file;
            return cannotRead(folder,
                              slices[i - 1].name + " and " + slices[i].name + " are at the same place (" +
                                  millimetres(slices[i].height) + " mm): " +
                                  (oneFile ? "the file holds more than one image; export one of them alone"
                                           : difference(files[slices[i - 1].file].set, files[slices[i].file].set)));
        }
    }
    return {};
}

Result<Grid> stackSlices(const std::filesystem::path& folder, const DicomImage& image,
                         const std::vector<DicomSlice>& slices, std::vector<std::string>& notes) {
    VOXTACT_TRY(checkGaps(folder, slices));
    const DicomSlice& first = slices.front();
    const Vec3 normal = cross(first.across, first.down);
    const double gap = (slices.back().height - first.height) / static_cast<double>(slices.size() - 1);
    VOXTACT_TRY(checkUpright(folder, slices, gap, notes));
    Grid grid;
    grid.size = {image.columns, image.rows, static_cast<std::uint32_t>(slices.size())};
    grid.spacing = {first.spacing[0], first.spacing[1], gap};
    grid.origin = first.position;
    for (std::size_t row = 0; row < 3; ++row) {
        grid.direction[row] = first.across[row];
        grid.direction[3 + row] = first.down[row];
        grid.direction[6 + row] = normal[row];
    }
    if (const Result<void> checked = checkGrid(grid); !checked.ok()) {
        return cannotRead(folder, checked.error().text);
    }
    return grid;
}

} // namespace voxtact::io
