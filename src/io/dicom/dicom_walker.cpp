// SPDX-License-Identifier: MIT
#include "io/dicom/dicom_walker.h"

#include "io/byte_source.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace voxtact::io {

namespace {

using namespace std::string_view_literals;

constexpr std::uint32_t kUndefined = 0xFFFFFFFF;
constexpr DicomTag kItem = 0xFFFEE000;
constexpr DicomTag kItemEnd = 0xFFFEE00D;
constexpr DicomTag kSequenceEnd = 0xFFFEE0DD;
constexpr const char* kNoElement = "it is damaged: bytes that are no element follow its pixels; get the file again";
constexpr std::uint64_t kNoEnd = std::numeric_limits<std::uint64_t>::max();

/// The types with two spare bytes and a length of four.
constexpr std::string_view kLongTypes = "OB OD OF OL OV OW SQ SV UC UN UR UT UV";
constexpr std::string_view kShortTypes = "AE AS AT CS DA DS DT FD FL IS LO LT PN SH SL SS ST TM UI UL US";

bool isAmong(std::string_view types, std::string_view type) {
    for (std::size_t at = 0; at < types.size(); at += 3) {
        if (types.substr(at, 2) == type) {
            return true;
        }
    }
    return false;
}

enum class Kind { None, Text, Short, Sequence };

Kind kindOf(DicomTag tag) {
    using namespace dicom;
    constexpr std::array kTexts{
        kMediaStorage, kTransferSyntax,    kImageType,        kSopClass,
        kSopInstance,  kModality,          kEchoTime,         kEchoNumbers,
        kTriggerTime,  kSeriesDescription, kSeries,           kSeriesNumber,
        kPosition,     kOrientation,       kFrames,           kFrameOfReference,
        kIntercept,    kAcquisitionNumber, kPhotometric,      kPixelSpacing,
        kSlope,        kTemporalPosition,  kFrameOffsets,     kDoseScaling,
        kSliceSpacing, kSliceThickness,    kSegmentationType, kSegmentLabel,
        kRoiNumber,    kRoiName,           kContourType,      kContourPoints,
        kContourData,  kReferencedRoi,
    };
    constexpr std::array kShorts{kSamples,
                                 kRows,
                                 kColumns,
                                 kBitsAllocated,
                                 kBitsStored,
                                 kHighBit,
                                 kPixelRepresentation,
                                 kSegmentNumber,
                                 kReferencedSegment,
                                 kMaxFractional};
    constexpr std::array kSequences{
        kPlanePosition, kPlaneOrientation, kPixelMeasures, kValueTransformation,   kShared,           kPerFrame,
        kModalityTable, kRealWorldMapping, kSegments,      kSegmentIdentification, kStructureSetRois, kRoiContours,
        kContours};
    const auto in = [tag](const auto& tags) { return std::find(tags.begin(), tags.end(), tag) != tags.end(); };
    if (in(kTexts)) {
        return Kind::Text;
    }
    if (in(kShorts)) {
        return Kind::Short;
    }
    return in(kSequences) ? Kind::Sequence : Kind::None;
}

/// Returns the maximum bytes of the pixels by their tags; 0 if unknown.
std::uint64_t pixelBytes(const DicomDataSet& set) {
    std::uint64_t bits = 1;
    for (const DicomTag tag : {dicom::kRows, dicom::kColumns, dicom::kBitsAllocated, dicom::kSamples, dicom::kFrames}) {
        const std::string_view text = set.text(tag);
        std::uint64_t count = tag == dicom::kSamples || tag == dicom::kFrames ? 1 : 0;
        std::from_chars(text.data(), text.data() + text.size(), count);
        constexpr std::uint64_t kFar = std::uint64_t{1} << 50;
        bits = count != 0 && bits > kFar / count ? kFar : bits * count;
    }
    return bits / 8 + 1;
}

std::string withoutPadding(std::string_view text) {
    const auto blank = [](char c) { return c == ' ' || c == '\0'; };
    while (!text.empty() && blank(text.back())) {
        text.remove_suffix(1);
    }
    while (!text.empty() && blank(text.front())) {
        text.remove_prefix(1);
    }
    return std::string(text);
}

} // namespace

DicomWalker::DicomWalker(DicomStream& stream, const DicomSyntax& syntax)
    : stream_(stream), typed_(syntax.typed), big_(syntax.big), encapsulated_(syntax.coding != DicomCoding::Native) {}

bool DicomWalker::isType(std::string_view letters) {
    return isAmong(kLongTypes, letters) || isAmong(kShortTypes, letters);
}

bool DicomWalker::fail(const Element& element, std::string_view what) {
    problem_ = "it is damaged or truncated: element " + toText(element.tag) + " at byte " + std::to_string(element.at) +
               " " + std::string(what) + "; get the file again";
    return false;
}

bool DicomWalker::length(Element& element, std::size_t bytes) {
    const std::string_view head = stream_.peek(bytes);
    if (head.size() < bytes) {
        return fail(element, "is cut off");
    }
    element.length = bytes == 2 ? numberAt<std::uint16_t>(head, 0, big_) : numberAt<std::uint32_t>(head, 0, big_);
    return stream_.skip(bytes);
}

bool DicomWalker::header(Element& element) {
    element.at = stream_.position();
    const std::string_view head = stream_.peek(4);
    if (head.size() < 4) {
        problem_ = "it is truncated: it ends within an element; get the file again";
        return false;
    }
    element.tag =
        static_cast<DicomTag>(numberAt<std::uint16_t>(head, 0, big_)) << 16U | numberAt<std::uint16_t>(head, 2, big_);
    constexpr DicomTag kDelimiterGroup = 0xFFFE;
    if (!stream_.skip(4)) {
        return fail(element, "is cut off");
    }
    element.type.clear();
    if (!typed_ || element.tag >> 16U == kDelimiterGroup) {
        return length(element, 4);
    }
    element.type = stream_.peek(2);
    if (!isType(element.type)) {
        return fail(element, "is of no known type");
    }
    const bool isLong = isAmong(kLongTypes, element.type);
    if (!stream_.skip(isLong ? 4 : 2)) {
        return fail(element, "is cut off");
    }
    return length(element, isLong ? 4 : 2);
}

bool DicomWalker::fits(const Element& element, std::uint64_t end) {
    if (stream_.position() > end) {
        return fail(element, "begins beyond the end of its parent");
    }
    const std::uint64_t left = std::min(end - stream_.position(), stream_.mostLeft());
    return element.length <= left || fail(element, "says that it is " + std::to_string(element.length) +
                                                       " bytes long, " + std::to_string(left) + " are left");
}

bool DicomWalker::meta(DicomDataSet& into) {
    for (;;) {
        const std::string_view head = stream_.peek(2);
        if (head.size() < 2 || numberAt<std::uint16_t>(head, 0) != 2) {
            return true;
        }
        Element here;
        if (!header(here) || !element(here, into, kNoEnd)) {
            return false;
        }
    }
}

bool DicomWalker::dataSet(DicomDataSet& into) {
    while (!stream_.peek(1).empty()) {
        Element here;
        if (!header(here)) {
            return false;
        }
        if (here.tag == dicom::kPixels || here.tag == dicom::kFloatPixels || here.tag == dicom::kDoublePixels) {
            return pixelData(here, into);
        }
        if (!element(here, into, kNoEnd)) {
            return false;
        }
        ++elements_;
    }
    return true;
}

bool DicomWalker::behindPixels(std::uint64_t& zeros) {
    zeros = 0;
    if (!pixels_->encapsulated && !stream_.skip(pixels_->pieces.front().length)) {
        problem_ = "it is truncated: it ends before its pixels do; get the file again";
        return false;
    }
    DicomDataSet unused;
    constexpr std::size_t kLeast = 8;
    while (!stream_.peek(1).empty()) {
        const std::string_view next = stream_.peek(kLeast);
        if (std::all_of(next.begin(), next.end(), [](char c) { return c == 0; })) {
            return zerosToTheEnd(zeros);
        }
        if (next.size() < kLeast) {
            problem_ = kNoElement;
            return false;
        }
        Element here;
        if (!header(here)) {
            return false;
        }
        if (here.tag <= pixels_->tag) {
            return fail(here, "stands behind the pixels");
        }
        if (!element(here, unused, kNoEnd)) {
            return false;
        }
    }
    return true;
}

/// Files are filled up to whole blocks of media. Bytes that were put in among pixels which end in zeros look the same,
/// except for the length of the file.
bool DicomWalker::zerosToTheEnd(std::uint64_t& zeros) {
    constexpr std::uint64_t kBlock = 512;
    bool isZero = true;
    for (std::string_view next = stream_.peek(kBlock); !next.empty() && isZero; next = stream_.peek(kBlock)) {
        isZero = std::all_of(next.begin(), next.end(), [](char c) { return c == 0; });
        zeros += next.size();
        isZero = stream_.skip(next.size()) && isZero;
    }
    if (isZero && stream_.position() % kBlock == 0) {
        return true;
    }
    problem_ = kNoElement;
    return false;
}

bool DicomWalker::element(const Element& here, DicomDataSet& into, std::uint64_t end) {
    const Kind kind = kindOf(here.tag);
    if (here.length == kUndefined && (here.type == "OB" || here.type == "OW")) {
        DicomPixelData unused; // of a preview
        return fragments(here, unused);
    }
    const bool sequence = here.type.empty() || here.type == "SQ" || here.type == "UN";
    if (here.length == kUndefined && !sequence) {
        return fail(here, "has no length");
    }
    if (here.length != kUndefined && !fits(here, end)) {
        return false;
    }
    if (here.length != kUndefined && (kind == Kind::None || (kind == Kind::Sequence && !sequence))) {
        return stream_.skip(here.length) || fail(here, "is cut off");
    }
    if (here.length == kUndefined || kind == Kind::Sequence) {
        std::vector<DicomDataSet> list;
        if (!items(here, list, end)) {
            return false;
        }
        if (kind == Kind::Sequence) {
            into.sequences.emplace_back(here.tag, std::move(list));
        }
        return true;
    }
    return value(here, into);
}

bool DicomWalker::value(const Element& here, DicomDataSet& into) {
    constexpr std::uint32_t kLongestText = 4096;
    constexpr std::uint32_t kLongestList = 1U << 20U;
    constexpr std::uint32_t kLongestContour = 1U << 28U; // its bytes are in the file, or the walk ends here
    const std::uint32_t longest = here.tag == dicom::kFrameOffsets  ? kLongestList
                                  : here.tag == dicom::kContourData ? kLongestContour
                                                                    : kLongestText;
    if (std::any_of(into.values.begin(), into.values.end(), [&](const auto& one) { return one.first == here.tag; })) {
        return fail(here, "comes a second time");
    }
    if (here.length > longest) {
        return fail(here, "is " + std::to_string(here.length) + " bytes long, far more than such an element has");
    }
    std::string bytes(here.length, '\0');
    if (!stream_.read(bytes.data(), bytes.size())) {
        return fail(here, "is cut off");
    }
    if (kindOf(here.tag) == Kind::Text) {
        into.values.emplace_back(here.tag, withoutPadding(bytes));
        return true;
    }
    if (here.length == 0) {
        return true;
    }
    if (here.length != 2 || !(here.type.empty() || here.type == "US" || here.type == "UN")) {
        return fail(here, "is not one number of 16 bits");
    }
    into.values.emplace_back(here.tag, std::to_string(numberAt<std::uint16_t>(bytes, 0, big_)));
    return true;
}

bool DicomWalker::items(const Element& here, std::vector<DicomDataSet>& into, std::uint64_t end) {
    constexpr std::size_t kDeepest = 16;
    if (depth_ == kDeepest) {
        return fail(here, "is nested too deep");
    }
    ++depth_;
    const bool typed = typed_;
    typed_ = typed && here.type != "UN"; // of an unknown type: implicit (PS3.5, 6.2.2)
    const bool open = here.length == kUndefined;
    const std::uint64_t stop = open ? end : stream_.position() + here.length;
    const bool kept = kindOf(here.tag) == Kind::Sequence;
    for (;;) {
        if (!open && stream_.position() == stop) {
            break;
        }
        if (stream_.position() > stop) {
            return fail(here, "ends before what is in it");
        }
        Element next;
        if (!header(next)) {
            return false;
        }
        if (open && next.tag == kSequenceEnd) {
            break;
        }
        if (next.tag != kItem) {
            return fail(next, "stands where an item of " + toText(here.tag) + " should begin");
        }
        DicomDataSet set;
        if (!item(next, set, stop)) {
            return false;
        }
        if (kept) {
            into.push_back(std::move(set));
        }
    }
    typed_ = typed;
    --depth_;
    return true;
}

bool DicomWalker::item(const Element& here, DicomDataSet& into, std::uint64_t end) {
    const bool open = here.length == kUndefined;
    if (!open && !fits(here, end)) {
        return false;
    }
    const std::uint64_t stop = open ? end : stream_.position() + here.length;
    for (;;) {
        if (!open && stream_.position() == stop) {
            return true;
        }
        if (stream_.position() > stop) {
            return fail(here, "ends before what is in it");
        }
        Element next;
        if (!header(next)) {
            return false;
        }
        if (open && next.tag == kItemEnd) {
            return true;
        }
        if (!element(next, into, stop)) {
            return false;
        }
    }
}

bool DicomWalker::fragments(const Element& here, DicomPixelData& into) {
    bool first = true;
    for (;;) {
        Element next;
        if (!header(next)) {
            problem_ = "it is truncated: the file ends before its pixels do; get the file again";
            return false;
        }
        if (next.tag == kSequenceEnd) {
            return true;
        }
        if (next.tag != kItem || next.length == kUndefined) {
            return fail(next, "stands where a piece of the pixels " + toText(here.tag) + " should begin");
        }
        if (next.length > stream_.mostLeft()) {
            problem_ = "it is truncated: a piece of its pixels takes " + std::to_string(next.length) + " bytes, " +
                       std::to_string(stream_.mostLeft()) + " are left; get the file again";
            return false;
        }
        if (first) {
            // The table of where frames begin; it may be empty.
            for (std::uint32_t at = 0; at + 4 <= next.length; at += 4) {
                const std::string_view offset = stream_.peek(4);
                into.frameOffsets.push_back(offset.size() == 4 ? numberAt<std::uint32_t>(offset, 0, big_) : 0);
                if (!stream_.skip(4)) {
                    return fail(next, "is cut off");
                }
            }
            next.length %= 4;
            first = false;
        } else {
            into.pieces.push_back({stream_.position(), next.length});
        }
        if (!stream_.skip(next.length)) {
            return fail(next, "is cut off");
        }
    }
}

bool DicomWalker::pixelData(const Element& here, const DicomDataSet& set) {
    DicomPixelData data;
    stream_.allow(pixelBytes(set));
    data.tag = here.tag;
    data.words = here.type == "OW" || here.type.empty();
    data.encapsulated = here.length == kUndefined;
    if (data.encapsulated != encapsulated_) {
        return fail(here, encapsulated_ ? "holds no pieces, which the compression that the file names asks for"
                                        : "has no length");
    }
    if (data.encapsulated) {
        if (!fragments(here, data)) {
            return false;
        }
    } else if (here.length > stream_.mostLeft()) {
        problem_ = "it is truncated: its pixels take " + std::to_string(here.length) + " bytes, " +
                   std::to_string(stream_.mostLeft()) + " are left; get the file again";
        return false;
    } else {
        data.pieces.push_back({stream_.position(), here.length});
    }
    pixels_ = std::move(data);
    return true;
}

} // namespace voxtact::io
