// SPDX-License-Identifier: MIT
#include "io/dicom/dicom_slice.h"
#include "core/geometry/vec3.h"

#include "core/base/text.h"
#include "core/base/try.h"
#include "io/dicom/dicom_walker.h"
#include "io/errors.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <span>

namespace voxtact::io {

namespace {

std::string named(const char* name, DicomTag tag) {
    return std::string(name) + " " + toText(tag);
}

Error malformed(const DicomFile& file, const char* name, DicomTag tag, std::string_view text, std::string_view what) {
    return cannotRead(file.path, "its " + named(name, tag) + " is '" + printable(text) + "', which is not " +
                                     std::string(what) + "; get the file again");
}

Result<std::uint32_t> count(const DicomFile& file, DicomTag tag, const char* name) {
    const std::string* text = file.set.find(tag);
    if (text == nullptr) {
        return cannotRead(file.path, "it has no " + named(name, tag) + "; get the file again");
    }
    std::uint32_t value = 0;
    const auto parsed = std::from_chars(text->data(), text->data() + text->size(), value);
    if (parsed.ec != std::errc() || parsed.ptr != text->data() + text->size()) {
        return malformed(file, name, tag, *text, "a count");
    }
    return value;
}

/// All that is counted, in one go.
Result<void> counts(const DicomFile& file, DicomImage& image) {
    struct Count {
        DicomTag tag;
        const char* name;
        std::uint32_t* to;
    };
    std::uint32_t isSigned = 0;
    for (const Count& one :
         {Count{dicom::kRows, "Rows", &image.rows}, Count{dicom::kColumns, "Columns", &image.columns},
          Count{dicom::kBitsAllocated, "BitsAllocated", &image.bitsAllocated},
          Count{dicom::kBitsStored, "BitsStored", &image.bitsStored}, Count{dicom::kHighBit, "HighBit", &image.highBit},
          Count{dicom::kPixelRepresentation, "PixelRepresentation", &isSigned}}) {
        const Result<std::uint32_t> value = count(file, one.tag, one.name);
        VOXTACT_TRY(value);
        *one.to = *value;
    }
    if (isSigned > 1) {
        return malformed(file, "PixelRepresentation", dicom::kPixelRepresentation, std::to_string(isSigned), "0 or 1");
    }
    image.isSigned = isSigned == 1;
    image.isMultiFrame = file.set.items(dicom::kPerFrame) != nullptr;
    if (file.set.find(dicom::kFrames) != nullptr) {
        const Result<std::uint32_t> frames = count(file, dicom::kFrames, "NumberOfFrames");
        VOXTACT_TRY(frames);
        image.frames = *frames;
        image.isMultiFrame = image.isMultiFrame || image.frames != 1;
    }
    return {};
}

Error noPixels(const DicomFile& file, const DicomImage& image) {
    return cannotRead(file.path, "it has no pixels: " + std::to_string(image.columns) + " columns, " +
                                     std::to_string(image.rows) + " rows, " + std::to_string(image.frames) + " frames");
}

Result<void> checkBits(const DicomFile& file, const DicomImage& image) {
    if (image.rows == 0 || image.columns == 0 || image.frames == 0) {
        return noPixels(file, image);
    }
    if (image.bitsAllocated != 8 && image.bitsAllocated != 16 && image.bitsAllocated != 32) {
        return cannotRead(file.path, "its pixels take " + std::to_string(image.bitsAllocated) +
                                         " bits each (BitsAllocated); only 8, 16 and 32 are supported");
    }
    if (image.bitsStored == 0 || image.bitsStored > image.bitsAllocated || image.highBit >= image.bitsAllocated ||
        image.highBit + 1 < image.bitsStored) {
        return cannotRead(file.path, "its BitsAllocated " + std::to_string(image.bitsAllocated) + ", BitsStored " +
                                         std::to_string(image.bitsStored) + " and HighBit " +
                                         std::to_string(image.highBit) + " contradict each other; get the file again");
    }
    // The type OW has words of 16 bits; readers disagree about other sizes.
    const bool words = file.pixels->words && image.bitsAllocated == 8;
    if (file.syntax->bigPixels && (words || image.bitsAllocated == 32)) {
        return cannotRead(file.path, "its pixels take " + std::to_string(image.bitsAllocated) +
                                         " bits each in big endian, which is not supported; convert the series to "
                                         "explicit VR little endian");
    }
    return {};
}

/// Colours, floats and tables are not numbers in real units.
Result<void> checkMeaning(const DicomFile& file) {
    if (file.pixels->tag != dicom::kPixels) {
        return cannotRead(file.path, "its pixels are floats " + toText(file.pixels->tag) +
                                         ", which are not supported; convert the series to NIfTI or NRRD");
    }
    if (const std::string_view type = file.set.text(dicom::kImageType); type.find("MOSAIC") != std::string_view::npos) {
        return cannotRead(file.path, "it is a Siemens mosaic (ImageType " + toText(dicom::kImageType) + " '" +
                                         printable(type) +
                                         "'): each file holds all slices side by side; convert the series, for "
                                         "example by dcm2niix");
    }
    const std::string_view samples = file.set.text(dicom::kSamples);
    const std::string_view photometric = file.set.text(dicom::kPhotometric);
    if ((!samples.empty() && samples != "1") || !photometric.starts_with("MONOCHROME")) {
        return cannotRead(file.path, "its pixels are colours (PhotometricInterpretation '" + printable(photometric) +
                                         "', " + (samples.empty() ? "no" : printable(samples)) +
                                         " samples per pixel); a grey image is needed");
    }
    if (file.set.items(dicom::kModalityTable) != nullptr) {
        return cannotRead(file.path, "its values are given by a table, ModalityLUTSequence " +
                                         toText(dicom::kModalityTable) +
                                         ", which is not supported; convert the series");
    }
    return {};
}

/// Less than a frame too much is padding (PS3.5, 8).
Result<void> checkPixelLength(const DicomFile& file, DicomImage& image) {
    const std::uint64_t length = file.pixels->pieces.empty() ? 0 : file.pixels->pieces.front().length;
    // Rows and columns have 16 bits, frames 32: a product of 64 bits needs care only with them.
    const std::uint64_t frame = image.frameBytes();
    const std::uint64_t wanted = frame > length ? frame : frame * std::min<std::uint64_t>(image.frames, length + 1);
    image.excess = file.pixels->encapsulated || length <= wanted + wanted % 2 ? 0 : length - wanted;
    if (!file.pixels->encapsulated && (length < wanted || image.excess >= frame)) {
        return cannotRead(file.path, "its pixels take " + std::to_string(length) + " bytes, which is not " +
                                         std::to_string(image.columns) + " columns x " + std::to_string(image.rows) +
                                         " rows x " + std::to_string(image.frames) + " frames x " +
                                         std::to_string(image.bitsAllocated / 8) + " bytes; get the file again");
    }
    if (file.pixels->encapsulated && file.pixels->pieces.size() < image.frames) {
        return cannotRead(file.path, "it says " + std::to_string(image.frames) + " frames, " +
                                         std::to_string(file.pixels->pieces.size()) +
                                         " compressed pieces are there; get the file again");
    }
    return {};
}

/// Data sets to search for the elements of a frame: its own groups, the shared ones, the file.
struct Groups {
    std::array<const DicomDataSet*, 3> sets{};

    /// In the macro `sequence` where the file has groups, else in the file itself.
    [[nodiscard]] const DicomDataSet* holding(DicomTag sequence, DicomTag tag) const {
        for (const DicomDataSet* set : sets) {
            const std::vector<DicomDataSet>* list = set == nullptr ? nullptr : set->items(sequence);
            if (list != nullptr && list->front().find(tag) != nullptr) {
                return &list->front();
            }
        }
        return sets[2]->find(tag) != nullptr ? sets[2] : nullptr;
    }
};

class FrameReader {
  public:
    FrameReader(const DicomFile& file, const Groups& groups, DicomSlice& slice)
        : file_(file), groups_(groups), slice_(slice) {}

    Result<void> read() {
        for (const auto step :
             {&FrameReader::place, &FrameReader::orientation, &FrameReader::spacing, &FrameReader::rescale}) {
            VOXTACT_TRY((this->*step)());
        }
        return {};
    }

  private:
    [[nodiscard]] Error refused(const std::string& why) const {
        const bool several = slice_.name.starts_with("frame");
        return cannotRead(file_.path, (several ? "frame " + std::to_string(slice_.frame + 1) + ": " : "") + why);
    }

    Result<std::vector<double>> numbers(DicomTag sequence, DicomTag tag, const char* name, std::size_t wanted,
                                        const char* consequence) {
        const DicomDataSet* set = groups_.holding(sequence, tag);
        if (set == nullptr) {
            return refused("it has no " + named(name, tag) + ", " + consequence);
        }
        const auto values = dicomNumbers(*set->find(tag), wanted);
        if (!values) {
            return refused("its " + named(name, tag) + " is '" + printable(*set->find(tag)) + "', not " +
                           std::to_string(wanted) + " numbers; get the file again");
        }
        return *values;
    }

    Result<void> place() {
        const auto at = numbers(dicom::kPlanePosition, dicom::kPosition, "ImagePositionPatient", 3,
                                "so its place in the series is not known; export the series again with its original "
                                "attributes, or convert it by a tool that knows the scanner");
        VOXTACT_TRY(at);
        slice_.position = {(*at)[0], (*at)[1], (*at)[2]};
        return {};
    }

    Result<void> orientation() {
        const auto axes = numbers(dicom::kPlaneOrientation, dicom::kOrientation, "ImageOrientationPatient", 6,
                                  "so how it lies in the patient is not known; export the series again with its "
                                  "original attributes, or convert it by a tool that knows the scanner");
        VOXTACT_TRY(axes);
        slice_.across = {(*axes)[0], (*axes)[1], (*axes)[2]};
        slice_.down = {(*axes)[3], (*axes)[4], (*axes)[5]};
        const double across = std::sqrt(dot(slice_.across, slice_.across));
        const double down = std::sqrt(dot(slice_.down, slice_.down));
        const double lean = dot(slice_.across, slice_.down);
        // Files with two or three decimals are common.
        constexpr double kLength = 0.01;
        constexpr double kLean = 0.002;
        if (std::abs(across - 1) > kLength || std::abs(down - 1) > kLength || std::abs(lean) > kLean) {
            return refused("its " + named("ImageOrientationPatient", dicom::kOrientation) +
                           " is not two unit vectors at right angles; get the file again");
        }
        double rest = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            slice_.across[i] /= across;
        }
        const double along = dot(slice_.across, slice_.down);
        for (std::size_t i = 0; i < 3; ++i) {
            slice_.down[i] -= along * slice_.across[i];
            rest += slice_.down[i] * slice_.down[i];
        }
        for (double& component : slice_.down) {
            component /= std::sqrt(rest);
        }
        return {};
    }

    Result<void> spacing() {
        const auto gaps = numbers(dicom::kPixelMeasures, dicom::kPixelSpacing, "PixelSpacing", 2,
                                  "so the size of its pixels is not known; export the series again with its original "
                                  "attributes, or convert it by a tool that knows the scanner");
        VOXTACT_TRY(gaps);
        // The first is the distance of the rows.
        slice_.spacing = {(*gaps)[1], (*gaps)[0]};
        if (!(slice_.spacing[0] > 0) || !(slice_.spacing[1] > 0)) {
            return refused("its " + named("PixelSpacing", dicom::kPixelSpacing) + " is " + number((*gaps)[0]) +
                           " and " + number((*gaps)[1]) + " mm; both must be above 0");
        }
        return {};
    }

    Result<void> rescale() {
        VOXTACT_TRY(rescaleValues());
        if (file_.set.find(dicom::kDoseScaling) == nullptr) {
            return {};
        }
        const auto dose = numbers(dicom::kValueTransformation, dicom::kDoseScaling, "DoseGridScaling", 1, "");
        VOXTACT_TRY(dose);
        if (slice_.isRescaled || !(dose->front() > 0)) {
            return refused(
                "its " + named("DoseGridScaling", dicom::kDoseScaling) + " is " + number(dose->front()) +
                (slice_.isRescaled ? ", and it has a RescaleSlope, too; get the file again" : "; it must be above 0"));
        }
        slice_.isRescaled = true;
        slice_.slope = dose->front();
        return {};
    }

    Result<void> rescaleValues() {
        const bool slope = groups_.holding(dicom::kValueTransformation, dicom::kSlope) != nullptr;
        const bool intercept = groups_.holding(dicom::kValueTransformation, dicom::kIntercept) != nullptr;
        slice_.isRescaled = slope || intercept;
        if (!slice_.isRescaled) {
            return {};
        }
        const char* alone = "but the other half of the rescaling, so its values are not known; get the file again";
        const auto m = numbers(dicom::kValueTransformation, dicom::kSlope, "RescaleSlope", 1, alone);
        const auto b = numbers(dicom::kValueTransformation, dicom::kIntercept, "RescaleIntercept", 1, alone);
        if (!m.ok() || !b.ok()) {
            return m.ok() ? b.error() : m.error();
        }
        slice_.slope = m->front();
        slice_.intercept = b->front();
        if (slice_.slope == 0) {
            return refused("its " + named("RescaleSlope", dicom::kSlope) + " is 0, which makes all voxels equal");
        }
        return {};
    }

    const DicomFile& file_;
    const Groups& groups_;
    DicomSlice& slice_;
};

/// Frames of a dose (PS3.3, C.8.8.3.2): offsets from the first along the normal, or places along the patient's z.
Result<void> shiftFrames(const DicomFile& file, std::vector<DicomSlice>& slices) {
    const std::string_view text = file.set.text(dicom::kFrameOffsets);
    const std::optional<std::vector<double>> offsets = dicomNumbers(text, slices.size());
    if (!offsets) {
        return malformed(file, "GridFrameOffsetVector", dicom::kFrameOffsets, text,
                         std::to_string(slices.size()) + " numbers, one a frame");
    }
    constexpr double kRounding = 0.01;
    const Vec3 normal = cross(slices.front().across, slices.front().down);
    const double first = offsets->front();
    const bool isRelative = first == 0;
    if (!isRelative && (std::abs(normal[2]) < 1 - kRounding || std::abs(first - slices[0].position[2]) > kRounding)) {
        return cannotRead(file.path, "its " + named("GridFrameOffsetVector", dicom::kFrameOffsets) + " begins with " +
                                         number(first) +
                                         ", which is neither 0 nor the place of the first frame; get the file again");
    }
    for (std::size_t frame = 0; frame < slices.size(); ++frame) {
        const double along = isRelative ? (*offsets)[frame] : ((*offsets)[frame] - first) * normal[2];
        for (std::size_t i = 0; i < 3; ++i) {
            slices[frame].position[i] += along * normal[i];
        }
    }
    return {};
}

} // namespace

std::optional<std::vector<double>> dicomNumbers(std::string_view text, std::size_t wanted) {
    std::vector<double> numbers;
    for (bool more = true; more;) {
        const std::size_t end = std::min(text.find('\\'), text.size());
        std::string_view one = text.substr(0, end);
        while (!one.empty() && one.front() == ' ') {
            one.remove_prefix(1);
        }
        if (one.starts_with('+')) {
            one.remove_prefix(1);
        }
        while (!one.empty() && one.back() == ' ') {
            one.remove_suffix(1);
        }
        double value = 0;
        const auto parsed = std::from_chars(one.data(), one.data() + one.size(), value);
        if (parsed.ec != std::errc() || parsed.ptr != one.data() + one.size() || !std::isfinite(value) ||
            (wanted != 0 && numbers.size() == wanted)) {
            return std::nullopt;
        }
        numbers.push_back(value);
        more = end < text.size();
        text.remove_prefix(more ? end + 1 : end);
    }
    return wanted == 0 || numbers.size() == wanted ? std::optional(numbers) : std::nullopt;
}

Result<DicomImage> dicomMask(const DicomFile& file) {
    DicomImage image;
    VOXTACT_TRY(counts(file, image));
    if (image.rows == 0 || image.columns == 0 || image.frames == 0) {
        return noPixels(file, image);
    }
    if (image.bitsAllocated != 1 || image.bitsStored != 1 || image.highBit != 0 || file.pixels->encapsulated) {
        return cannotRead(file.path, "its pixels are no plain mask of one bit each (BitsAllocated " +
                                         std::to_string(image.bitsAllocated) +
                                         "); convert it to explicit VR little "
                                         "endian");
    }
    const std::uint64_t length = file.pixels->pieces.front().length;
    const std::uint64_t frame = image.pixels();
    // Frames follow each other without padding.
    if (frame > 8 * length || image.frames > 8 * length / frame || length > (frame * image.frames + 7) / 8 + 1) {
        return cannotRead(file.path, "its pixels take " + std::to_string(length) + " bytes, which is not " +
                                         std::to_string(image.columns) + " columns x " + std::to_string(image.rows) +
                                         " rows x " + std::to_string(image.frames) +
                                         " frames of bits; get the file again");
    }
    return image;
}

Result<DicomImage> dicomImage(const DicomFile& file) {
    DicomImage image;
    VOXTACT_TRY(checkMeaning(file));
    VOXTACT_TRY(counts(file, image));
    VOXTACT_TRY(checkBits(file, image));
    VOXTACT_TRY(checkPixelLength(file, image));
    const std::vector<DicomDataSet>* perFrame = file.set.items(dicom::kPerFrame);
    if (image.frames > 1 && perFrame == nullptr && file.set.find(dicom::kFrameOffsets) == nullptr) {
        return cannotRead(file.path, "it holds " + std::to_string(image.frames) +
                                         " frames (multi-frame) and does not say where each lies "
                                         "(PerFrameFunctionalGroupsSequence); give a series with one slice a file, or "
                                         "an enhanced one");
    }
    if (perFrame != nullptr && perFrame->size() != image.frames) {
        return cannotRead(file.path, "it holds " + std::to_string(image.frames) + " frames and says of " +
                                         std::to_string(perFrame->size()) + " where they lie; get the file again");
    }
    return image;
}

Result<std::vector<DicomSlice>> dicomSlices(const DicomFile& file, const DicomImage& image, std::size_t index) {
    const std::vector<DicomDataSet>* shared = file.set.items(dicom::kShared);
    const std::vector<DicomDataSet>* perFrame = file.set.items(dicom::kPerFrame);
    std::vector<DicomSlice> slices(image.frames);
    for (std::uint32_t frame = 0; frame < image.frames; ++frame) {
        DicomSlice& slice = slices[frame];
        slice.file = index;
        slice.frame = frame;
        slice.name = "'" + printable(file.path.filename().string()) + "'";
        if (image.isMultiFrame) {
            slice.name = "frame " + std::to_string(frame + 1) + " of " + slice.name;
        }
        const Groups groups{{perFrame == nullptr ? nullptr : &(*perFrame)[frame],
                             shared == nullptr ? nullptr : &shared->front(), &file.set}};
        VOXTACT_TRY(FrameReader(file, groups, slice).read());
    }
    if (image.frames > 1 && perFrame == nullptr) {
        VOXTACT_TRY(shiftFrames(file, slices));
    }
    return slices;
}

} // namespace voxtact::io
