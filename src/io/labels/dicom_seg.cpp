// SPDX-License-Identifier: MIT
// Segmentations of DICOM (PS3.3, A.51): frames of masks, each of one segment at one place.
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/geometry/vec3.h"
#include "io/dicom/dicom_pixels.h"
#include "io/dicom/dicom_slice.h"
#include "io/dicom/dicom_stack.h"
#include "io/errors.h"
#include "io/labels/dicom_labels.h"
#include "io/labels/segment_map.h"
#include "io/mesh/mesh_text.h"

#include <algorithm>
#include <cmath>

namespace voxtact::io {

namespace {

Result<std::vector<Segment>> segmentsOf(const DicomFile& file) {
    const std::vector<DicomDataSet>* const items = file.set.items(dicom::kSegments);
    if (items == nullptr) {
        return cannotRead(file.path, "it names no segments, SegmentSequence " + toText(dicom::kSegments));
    }
    std::vector<Segment> segments;
    for (const DicomDataSet& item : *items) {
        const std::optional<std::uint64_t> number = parseNatural(item.text(dicom::kSegmentNumber));
        if (!number) {
            return cannotRead(file.path, "a segment has no SegmentNumber " + toText(dicom::kSegmentNumber));
        }
        segments.push_back({oneLine(item.text(dicom::kSegmentLabel)), static_cast<std::int64_t>(*number)});
    }
    return segments;
}

/// The segment of each frame, by its place in the list.
Result<std::vector<std::size_t>> segmentsOfFrames(const DicomFile& file, std::uint32_t frames,
                                                  const std::vector<Segment>& segments) {
    const std::vector<DicomDataSet>* const perFrame = file.set.items(dicom::kPerFrame);
    const std::vector<DicomDataSet>* const shared = file.set.items(dicom::kShared);
    if (perFrame == nullptr || perFrame->size() != frames) {
        return cannotRead(file.path, "it has " + std::to_string(frames) + " frames and states the places of " +
                                         std::to_string(perFrame == nullptr ? 0 : perFrame->size()) +
                                         " (PerFrameFunctionalGroupsSequence)");
    }
    std::vector<std::size_t> places;
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
        const std::vector<DicomDataSet>* groups = (*perFrame)[frame].items(dicom::kSegmentIdentification);
        groups = groups == nullptr && shared != nullptr ? shared->front().items(dicom::kSegmentIdentification) : groups;
        const std::string_view text =
            groups == nullptr ? std::string_view() : groups->front().text(dicom::kReferencedSegment);
        const auto found = std::find_if(segments.begin(), segments.end(),
                                        [&](const Segment& segment) { return std::to_string(segment.number) == text; });
        if (found == segments.end()) {
            return cannotRead(file.path, "frame " + std::to_string(frame + 1) + " is of the segment '" +
                                             printable(text) + "', which it does not describe");
        }
        places.push_back(static_cast<std::size_t>(found - segments.begin()));
    }
    return places;
}

/// The distance of the slices as the file states it; 0 if it does not.
double statedGap(const DicomFile& file, DicomTag tag) {
    for (const DicomTag groups : {dicom::kPerFrame, dicom::kShared}) {
        const std::vector<DicomDataSet>* const list = file.set.items(groups);
        const std::vector<DicomDataSet>* const measures =
            list == nullptr ? nullptr : list->front().items(dicom::kPixelMeasures);
        const auto gap = measures == nullptr ? std::nullopt : dicomNumbers(measures->front().text(tag), 1);
        if (gap && gap->front() > 0) {
            return gap->front();
        }
    }
    return 0;
}

/// Written positions are rounded.
double tolerance(double gap) {
    return std::max(0.01, 0.02 * gap);
}

class SegStack {
  public:
    SegStack(const DicomFile& file, const DicomImage& image, std::vector<DicomSlice> slices)
        : file_(file), image_(image), slices_(std::move(slices)),
          normal_(cross(slices_.front().across, slices_.front().down)) {
        for (DicomSlice& slice : slices_) {
            slice.height = dot(slice.position, normal_);
        }
        lowest_ = *std::min_element(slices_.begin(), slices_.end(),
                                    [](const DicomSlice& a, const DicomSlice& b) { return a.height < b.height; });
    }

    Result<Grid> grid() {
        double highest = lowest_.height;
        for (const DicomSlice& slice : slices_) {
            highest = std::max(highest, slice.height);
        }
        const double rise = highest - lowest_.height;
        double gap = statedGap(file_, dicom::kSliceSpacing);
        gap = gap > 0 && isEven(gap) ? gap : smallestGap();
        gap = gap > 0 ? gap : statedGap(file_, dicom::kSliceThickness);
        if (!(gap > 0)) {
            return cannotRead(file_.path, "it has one slice and does not state SpacingBetweenSlices " +
                                              toText(dicom::kSliceSpacing) + ", so its thickness is not known");
        }
        const double steps = std::round(rise / gap);
        VOXTACT_TRY(checkSize(steps + 1));
        gap_ = steps > 0 ? rise / steps : gap;
        VOXTACT_TRY(checkSlices());
        Grid grid;
        grid.size = {image_.columns, image_.rows, static_cast<std::uint32_t>(steps) + 1};
        grid.spacing = {lowest_.spacing[0], lowest_.spacing[1], gap_};
        grid.origin = lowest_.position;
        for (std::size_t row = 0; row < 3; ++row) {
            grid.direction[row] = lowest_.across[row];
            grid.direction[3 + row] = lowest_.down[row];
            grid.direction[6 + row] = normal_[row];
        }
        return grid;
    }

    [[nodiscard]] std::uint64_t sliceOf(std::size_t frame) const {
        return static_cast<std::uint64_t>(std::round((slices_[frame].height - lowest_.height) / gap_));
    }

  private:
    /// Frames that lie far apart must not take far more memory than the file.
    [[nodiscard]] Result<void> checkSize(double slices) const {
        constexpr double kMaxVoxels = 1U << 26U;
        constexpr double kMaxPerByte = 1024;
        const double voxels = slices * static_cast<double>(image_.pixels());
        return voxels <= std::max(kMaxVoxels, kMaxPerByte * static_cast<double>(file_.bytes))
                   ? Result<void>()
                   : cannotRead(file_.path, "its frames would make " + number(slices) +
                                                " slices, nearly all of them empty; mend its positions");
    }

    [[nodiscard]] bool isEven(double gap) const {
        return std::all_of(slices_.begin(), slices_.end(), [&](const DicomSlice& slice) {
            const double rise = slice.height - lowest_.height;
            return std::abs(rise - std::round(rise / gap) * gap) <= tolerance(gap);
        });
    }

    /// Between slices at different places; 0 if all are at one.
    [[nodiscard]] double smallestGap() const {
        constexpr double kSame = 1e-3;
        std::vector<double> heights;
        for (const DicomSlice& slice : slices_) {
            heights.push_back(slice.height);
        }
        std::sort(heights.begin(), heights.end());
        double smallest = 0;
        for (std::size_t i = 1; i < heights.size(); ++i) {
            const double gap = heights[i] - heights[i - 1];
            smallest = gap > kSame && (smallest == 0 || gap < smallest) ? gap : smallest;
        }
        return smallest;
    }

    [[nodiscard]] Result<void> checkSlices() const {
        for (const DicomSlice& slice : slices_) {
            const double rise = slice.height - lowest_.height;
            const double off = std::abs(rise - std::round(rise / gap_) * gap_);
            if (off > tolerance(gap_)) {
                return cannotRead(file_.path, "the gaps between its slices are uneven: " + slice.name + " is " +
                                                  millimetres(off) + " mm off the steps of " + millimetres(gap_) +
                                                  " mm; resample it");
            }
            const Vec3 shift = step(minus(slice.position, lowest_.position), normal_, -rise);
            if (length(shift) > std::max(0.01, 0.1 * std::min(lowest_.spacing[0], lowest_.spacing[1]))) {
                return cannotRead(file_.path, slice.name + " lies " + millimetres(length(shift)) +
                                                  " mm off the normal of the first one; resample it");
            }
        }
        return {};
    }

    const DicomFile& file_;
    const DicomImage& image_;
    std::vector<DicomSlice> slices_;
    Vec3 normal_;
    DicomSlice lowest_;
    double gap_ = 1;
};

/// Cells from which on a pixel is inside.
Result<std::uint32_t> threshold(const DicomFile& file, bool isFractional) {
    if (!isFractional) {
        return std::uint32_t{1};
    }
    const std::optional<std::uint64_t> most = parseNatural(file.set.text(dicom::kMaxFractional));
    if (!most || *most == 0) {
        return cannotRead(file.path, "it does not state MaximumFractionalValue " + toText(dicom::kMaxFractional));
    }
    return static_cast<std::uint32_t>((*most + 1) / 2);
}

Result<DicomImage> imageOf(const DicomFile& file, bool& isFractional) {
    const std::string_view type = file.set.text(dicom::kSegmentationType);
    isFractional = type == "FRACTIONAL";
    if (type != "BINARY" && !isFractional) {
        return cannotRead(file.path, "its SegmentationType " + toText(dicom::kSegmentationType) + " is '" +
                                         printable(type) + "', which is neither BINARY nor FRACTIONAL");
    }
    if (!file.pixels || file.pixels->tag != dicom::kPixels || file.syntax->bigPixels) {
        return cannotRead(file.path, file.pixels ? "its pixels are floats or big-endian; convert it to explicit VR "
                                                   "little endian"
                                                 : "it has no pixels; get the file again");
    }
    return isFractional ? dicomImage(file) : dicomMask(file);
}

} // namespace

Result<LabelFile> readDicomSeg(DicomFile file) {
    bool isFractional = false;
    const Result<DicomImage> image = imageOf(file, isFractional);
    VOXTACT_TRY(image);
    const Result<std::uint32_t> inside = threshold(file, isFractional);
    VOXTACT_TRY(inside);
    Result<std::vector<Segment>> segments = segmentsOf(file);
    VOXTACT_TRY(segments);
    const Result<std::vector<std::size_t>> segmentOf = segmentsOfFrames(file, image->frames, *segments);
    VOXTACT_TRY(segmentOf);
    Result<std::vector<DicomSlice>> slices = dicomSlices(file, *image, 0);
    VOXTACT_TRY(slices);
    const std::vector<DicomFile> files{std::move(file)};
    VOXTACT_TRY(checkAlike(files, {*image}, *slices));
    SegStack stack(files[0], *image, std::move(*slices));
    const Result<Grid> grid = stack.grid();
    VOXTACT_TRY(grid);
    Result<SegmentMap> map = SegmentMap::create(files[0].path, *grid, std::move(*segments));
    VOXTACT_TRY(map);
    std::vector<bool> hasFrame(grid->size[2]);
    bool isOverlapping = false;
    VOXTACT_TRY(readDicomFrames(files[0], *image, [&](std::uint32_t frame, std::span<const std::uint32_t> cells) {
        const std::uint64_t slice = stack.sliceOf(frame);
        hasFrame[static_cast<std::size_t>(slice)] = true;
        for (std::size_t i = 0; i < cells.size() && !isOverlapping; ++i) {
            isOverlapping = cells[i] >= *inside && !map->set(slice * image->pixels() + i, (*segmentOf)[frame]);
        }
    }));
    if (isOverlapping) {
        return map->overlap();
    }
    std::vector<std::string> notes;
    if (const auto empty = std::count(hasFrame.begin(), hasFrame.end(), false); empty != 0) {
        notes.push_back(std::to_string(empty) + " of " + std::to_string(hasFrame.size()) +
                        " slices have no frame, and are empty");
    }
    if (isFractional) {
        notes.emplace_back("fractions of a half or more are inside of their segment");
    }
    return std::move(*map).finish(std::move(notes));
}

} // namespace voxtact::io
