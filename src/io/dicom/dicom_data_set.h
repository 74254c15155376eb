// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace voxtact::io {

/// Group in the upper, element in the lower 16 bits: 0x00280010 is (0028,0010).
using DicomTag = std::uint32_t;

/// The elements that are examined (PS3.6).
namespace dicom {
inline constexpr DicomTag kMediaStorage = 0x00020002;
inline constexpr DicomTag kTransferSyntax = 0x00020010;
inline constexpr DicomTag kImageType = 0x00080008;
inline constexpr DicomTag kSopClass = 0x00080016;
inline constexpr DicomTag kSopInstance = 0x00080018;
inline constexpr DicomTag kModality = 0x00080060;
inline constexpr DicomTag kSeriesDescription = 0x0008103E;
inline constexpr DicomTag kSliceThickness = 0x00180050;
inline constexpr DicomTag kEchoTime = 0x00180081;
inline constexpr DicomTag kEchoNumbers = 0x00180086;
inline constexpr DicomTag kSliceSpacing = 0x00180088;
inline constexpr DicomTag kTriggerTime = 0x00181060;
inline constexpr DicomTag kSeries = 0x0020000E;
inline constexpr DicomTag kSeriesNumber = 0x00200011;
inline constexpr DicomTag kAcquisitionNumber = 0x00200012;
inline constexpr DicomTag kPosition = 0x00200032;
inline constexpr DicomTag kOrientation = 0x00200037;
inline constexpr DicomTag kFrameOfReference = 0x00200052;
inline constexpr DicomTag kTemporalPosition = 0x00200100;
inline constexpr DicomTag kPlanePosition = 0x00209113;
inline constexpr DicomTag kPlaneOrientation = 0x00209116;
inline constexpr DicomTag kSamples = 0x00280002;
inline constexpr DicomTag kPhotometric = 0x00280004;
inline constexpr DicomTag kFrames = 0x00280008;
inline constexpr DicomTag kRows = 0x00280010;
inline constexpr DicomTag kColumns = 0x00280011;
inline constexpr DicomTag kPixelSpacing = 0x00280030;
inline constexpr DicomTag kBitsAllocated = 0x00280100;
inline constexpr DicomTag kBitsStored = 0x00280101;
inline constexpr DicomTag kHighBit = 0x00280102;
inline constexpr DicomTag kPixelRepresentation = 0x00280103;
inline constexpr DicomTag kIntercept = 0x00281052;
inline constexpr DicomTag kSlope = 0x00281053;
inline constexpr DicomTag kModalityTable = 0x00283000;
inline constexpr DicomTag kPixelMeasures = 0x00289110;
inline constexpr DicomTag kValueTransformation = 0x00289145;
inline constexpr DicomTag kRealWorldMapping = 0x00409096;
inline constexpr DicomTag kSegmentationType = 0x00620001;
inline constexpr DicomTag kSegments = 0x00620002;
inline constexpr DicomTag kSegmentNumber = 0x00620004;
inline constexpr DicomTag kSegmentLabel = 0x00620005;
inline constexpr DicomTag kSegmentIdentification = 0x0062000A;
inline constexpr DicomTag kReferencedSegment = 0x0062000B;
inline constexpr DicomTag kMaxFractional = 0x0062000E;
inline constexpr DicomTag kStructureSetRois = 0x30060020;
inline constexpr DicomTag kRoiNumber = 0x30060022;
inline constexpr DicomTag kRoiName = 0x30060026;
inline constexpr DicomTag kRoiContours = 0x30060039;
inline constexpr DicomTag kContours = 0x30060040;
inline constexpr DicomTag kContourType = 0x30060042;
inline constexpr DicomTag kContourPoints = 0x30060046;
inline constexpr DicomTag kContourData = 0x30060050;
inline constexpr DicomTag kReferencedRoi = 0x30060084;
inline constexpr DicomTag kFrameOffsets = 0x3004000C;
inline constexpr DicomTag kDoseScaling = 0x3004000E;
inline constexpr DicomTag kShared = 0x52009229;
inline constexpr DicomTag kPerFrame = 0x52009230;
inline constexpr DicomTag kFloatPixels = 0x7FE00008;
inline constexpr DicomTag kDoublePixels = 0x7FE00009;
inline constexpr DicomTag kPixels = 0x7FE00010;

/// SOP classes of files that make label maps (PS3.4).
inline constexpr std::string_view kSegClass = "1.2.840.10008.5.1.4.1.1.66.4";
inline constexpr std::string_view kRtStructClass = "1.2.840.10008.5.1.4.1.1.481.3";
} // namespace dicom

/// "(0028,0010)"
[[nodiscard]] std::string toText(DicomTag tag);

/// Storage of the pixels.
enum class DicomCoding { Native, Rle, Jpeg, JpegLs, Jpeg2000 };

struct DicomSyntax {
    std::string_view uid;
    bool typed = true;      ///< each element says its type (explicit VR)
    bool big = false;       ///< byte order of the elements
    bool bigPixels = false; ///< byte order of the pixels
    bool deflated = false;
    DicomCoding coding = DicomCoding::Native;
};

/// The elements of the list above, values as text without the blanks around them; numbers are written out.
struct DicomDataSet {
    std::vector<std::pair<DicomTag, std::string>> values;
    std::vector<std::pair<DicomTag, std::vector<DicomDataSet>>> sequences;

    /// Null where it is not there or empty.
    [[nodiscard]] const std::string* find(DicomTag tag) const;
    [[nodiscard]] const std::vector<DicomDataSet>* items(DicomTag tag) const;
    /// The text, or an empty one.
    [[nodiscard]] std::string_view text(DicomTag tag) const;
};

/// Bytes of the file, counted after inflation.
struct DicomPiece {
    std::uint64_t offset = 0;
    std::uint32_t length = 0;
};

struct DicomPixelData {
    DicomTag tag = dicom::kPixels;
    bool words = false; ///< of the type OW, whose bytes the big byte order swaps in pairs
    bool encapsulated = false;
    std::vector<std::uint32_t> frameOffsets; ///< encapsulated: where each frame begins, where the file says it
    std::vector<DicomPiece> pieces;          ///< native: one; encapsulated: the fragments. They lie inside the file
};

struct DicomFile {
    std::filesystem::path path;
    std::uint64_t bytes = 0;
    const DicomSyntax* syntax = nullptr;
    std::uint64_t dataSetAt = 0; ///< where the deflated part begins, if there is one
    DicomDataSet set;
    std::optional<DicomPixelData> pixels;
    bool isOtherSyntax = false; ///< the elements are implicit where the file says explicit, or the reverse
    std::uint64_t zeros = 0;    ///< at the end, which fill a block
};

/// Walks the whole file; inflates compressed data to its end. Empty if the file is no DICOM file; refuses a DICOM file
/// with invalid elements. Reads no pixels, and needs little memory for any claim of the file.
[[nodiscard]] Result<std::optional<DicomFile>> readDicomFile(const std::filesystem::path& path);

} // namespace voxtact::io
