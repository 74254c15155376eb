// SPDX-License-Identifier: MIT
// Structure sets of radiotherapy (PS3.3, C.8.8.5 and C.8.8.6): contours in the slices of an image.
#include "core/base/try.h"
#include "io/dicom/dicom_slice.h"
#include "io/errors.h"
#include "io/labels/dicom_labels.h"
#include "io/labels/segment_map.h"
#include "io/mesh/mesh_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace voxtact::io {

namespace {

/// In voxels: centres are whole numbers.
using Contour = std::vector<std::array<double, 2>>;

std::optional<std::int64_t> wholeOf(std::string_view text) {
    std::int64_t value = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    return end.ec == std::errc{} && end.ptr == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// The contours of one region, by slice.
struct Region {
    std::string name;
    std::map<std::uint32_t, std::vector<Contour>> slices;
};

class RtStructReader {
  public:
    RtStructReader(const DicomFile& file, const Grid& grid, const Mat4& texture_from_world)
        : file_(file), grid_(grid), texture_from_world_(texture_from_world) {}

    Result<LabelFile> read() {
        std::vector<Segment> segments;
        std::vector<Region> regions;
        VOXTACT_TRY(takeRegions(segments, regions));
        Result<SegmentMap> map = SegmentMap::create(file_.path, grid_, std::move(segments));
        VOXTACT_TRY(map);
        for (std::size_t i = 0; i < regions.size(); ++i) {
            for (const auto& [slice, contours] : regions[i].slices) {
                if (!fill(contours, slice, i, *map)) {
                    return map->overlap();
                }
            }
        }
        std::vector<std::string> notes;
        if (points_ != 0) {
            notes.push_back(std::to_string(points_) + " contours of the type POINT left out");
        }
        if (outside_ != 0) {
            notes.push_back(std::to_string(outside_) + " contours beyond the first and the last slice left out");
        }
        return std::move(*map).finish(std::move(notes));
    }

  private:
    Result<void> takeRegions(std::vector<Segment>& segments, std::vector<Region>& regions) {
        const std::vector<DicomDataSet>* const rois = file_.set.items(dicom::kStructureSetRois);
        const std::vector<DicomDataSet>* const contours = file_.set.items(dicom::kRoiContours);
        if (rois == nullptr || contours == nullptr) {
            return cannotRead(file_.path, "it has no contours, ROIContourSequence " + toText(dicom::kRoiContours));
        }
        for (const DicomDataSet& roi : *rois) {
            const std::optional<std::int64_t> number = wholeOf(roi.text(dicom::kRoiNumber));
            if (!number) {
                return cannotRead(file_.path, "a region has no ROINumber " + toText(dicom::kRoiNumber));
            }
            segments.push_back({oneLine(roi.text(dicom::kRoiName)), *number});
            regions.push_back({segments.back().name, {}});
        }
        for (const DicomDataSet& item : *contours) {
            const std::optional<std::int64_t> number = wholeOf(item.text(dicom::kReferencedRoi));
            const auto segment = std::find_if(segments.begin(), segments.end(),
                                              [&](const Segment& one) { return number && one.number == *number; });
            if (segment == segments.end()) {
                return cannotRead(file_.path, "its contours refer to the region '" +
                                                  printable(item.text(dicom::kReferencedRoi)) +
                                                  "', which it does not describe");
            }
            VOXTACT_TRY(takeContours(item, regions[static_cast<std::size_t>(segment - segments.begin())]));
        }
        return {};
    }

    Result<void> takeContours(const DicomDataSet& item, Region& region) {
        const std::vector<DicomDataSet>* const contours = item.items(dicom::kContours);
        for (std::size_t i = 0; contours != nullptr && i < contours->size(); ++i) {
            const DicomDataSet& contour = (*contours)[i];
            const std::string_view type = contour.text(dicom::kContourType);
            if (type == "POINT") {
                ++points_;
                continue;
            }
            const auto refused = [&](const std::string& why) {
                return cannotRead(file_.path,
                                  "contour " + std::to_string(i + 1) + " of '" + printable(region.name) + "' " + why);
            };
            if (type != "CLOSED_PLANAR" && type != "CLOSEDPLANAR_XOR") {
                return refused("is of the type '" + printable(type) + "'; only CLOSED_PLANAR is supported");
            }
            const auto numbers = dicomNumbers(contour.text(dicom::kContourData), 0);
            const std::optional<std::uint64_t> points = parseNatural(contour.text(dicom::kContourPoints));
            if (!numbers || numbers->size() % 3 != 0 || (points && *points != numbers->size() / 3)) {
                return refused("is damaged: its ContourData are not three numbers for each point");
            }
            if (!takeContour(*numbers, region)) {
                return refused("is not within a tenth of the slice distance of one slice of the image; resample it, or "
                               "give the image that it was drawn on");
            }
        }
        return {};
    }

    /// False if the contour is not in a slice.
    bool takeContour(const std::vector<double>& numbers, Region& region) {
        constexpr double kOff = 0.1;
        constexpr double kFar = 1e12; // voxels: differences and quotients of nearer places are finite
        bool isFar = false;
        Contour contour;
        double slice = 0;
        for (std::size_t at = 0; at < numbers.size(); at += 3) {
            const Vec3 texture = transformPoint(texture_from_world_, {numbers[at], numbers[at + 1], numbers[at + 2]});
            std::array<double, 3> voxel{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                voxel[axis] = texture[axis] * static_cast<double>(grid_.size[axis]) - 0.5;
                isFar = isFar || !(std::abs(voxel[axis]) <= kFar);
            }
            slice = at == 0 ? std::round(voxel[2]) : slice;
            if (isFar || !(std::abs(voxel[2] - slice) <= kOff)) {
                return false;
            }
            contour.push_back({voxel[0], voxel[1]});
        }
        if (slice < 0 || slice >= static_cast<double>(grid_.size[2])) {
            ++outside_;
        } else if (contour.size() > 2) {
            region.slices[static_cast<std::uint32_t>(slice)].push_back(std::move(contour));
        }
        return true;
    }

    /// By the even-odd rule over all contours of the slice, at the centres of the voxels. False: it overlaps.
    bool fill(const std::vector<Contour>& contours, std::uint32_t slice, std::size_t segment, SegmentMap& map) const {
        std::vector<double> crossings;
        for (std::uint32_t row = 0; row < grid_.size[1]; ++row) {
            crossings.clear();
            const double y = row;
            for (const Contour& contour : contours) {
                std::array<double, 2> from = contour.back();
                for (const std::array<double, 2>& to : contour) {
                    if ((from[1] <= y) != (to[1] <= y)) {
                        crossings.push_back(from[0] + (y - from[1]) / (to[1] - from[1]) * (to[0] - from[0]));
                    }
                    from = to;
                }
            }
            std::sort(crossings.begin(), crossings.end());
            const std::uint64_t base = (std::uint64_t{slice} * grid_.size[1] + row) * grid_.size[0];
            for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
                const double last = std::min(crossings[i + 1], static_cast<double>(grid_.size[0]));
                for (double x = std::max(0.0, std::ceil(crossings[i])); x < last; ++x) {
                    if (!map.set(base + static_cast<std::uint64_t>(x), segment)) {
                        return false;
                    }
                }
            }
        }
        return true;
    }

    const DicomFile& file_;
    const Grid& grid_;
    const Mat4& texture_from_world_;
    std::uint64_t points_ = 0;
    std::uint64_t outside_ = 0;
};

} // namespace

Result<LabelFile> readRtStruct(const DicomFile& file, const std::optional<Grid>& grid) {
    if (!grid) {
        return cannotRead(file.path, "it holds contours, which are filled on the grid of their image; give the image "
                                     "too (to the program: --volume)");
    }
    const Result<Mat4> texture_from_world = textureFromWorld(*grid);
    VOXTACT_TRY(texture_from_world);
    return RtStructReader(file, *grid, *texture_from_world).read();
}

} // namespace voxtact::io
