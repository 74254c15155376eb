// SPDX-License-Identifier: MIT
#include "io/dicom/dicom_data_set.h"

#include "core/base/try.h"
#include "io/byte_source.h"
#include "io/dicom/dicom_stream.h"
#include "io/dicom/dicom_walker.h"
#include "io/errors.h"

#include <algorithm>
#include <array>

namespace voxtact::io {

namespace {

using namespace std::string_view_literals;

constexpr std::array<DicomSyntax, 14> kSyntaxes{{
    {"1.2.840.10008.1.2", false},
    {"1.2.840.10008.1.2.1"},
    {"1.2.840.10008.1.2.1.99", true, false, false, true},
    {"1.2.840.10008.1.2.2", true, true, true},
    {"1.2.840.113619.5.2", false, false, true}, // GE's own
    {"1.2.840.10008.1.2.5", true, false, false, false, DicomCoding::Rle},
    {"1.2.840.10008.1.2.4.50", true, false, false, false, DicomCoding::Jpeg},
    {"1.2.840.10008.1.2.4.51", true, false, false, false, DicomCoding::Jpeg},
    {"1.2.840.10008.1.2.4.57", true, false, false, false, DicomCoding::Jpeg},
    {"1.2.840.10008.1.2.4.70", true, false, false, false, DicomCoding::Jpeg},
    {"1.2.840.10008.1.2.4.80", true, false, false, false, DicomCoding::JpegLs},
    {"1.2.840.10008.1.2.4.81", true, false, false, false, DicomCoding::JpegLs},
    {"1.2.840.10008.1.2.4.90", true, false, false, false, DicomCoding::Jpeg2000},
    {"1.2.840.10008.1.2.4.91", true, false, false, false, DicomCoding::Jpeg2000},
}};
constexpr const DicomSyntax* kUntyped = &kSyntaxes[0];
constexpr const DicomSyntax* kTyped = &kSyntaxes[1];

/// Common transfer syntaxes that are not supported.
std::string_view nameOfSyntax(std::string_view uid) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kNames{{
        {"1.2.840.10008.1.2.1.98", "encapsulated uncompressed"},
        {"1.2.840.10008.1.2.4.92", "JPEG 2000 part 2"},
        {"1.2.840.10008.1.2.4.93", "JPEG 2000 part 2"},
        {"1.2.840.10008.1.2.4.10", "MPEG video"},
        {"1.2.840.10008.1.2.4.20", "high-throughput JPEG 2000"},
        {"1.2.840.10008.1.2.4.", "a kind of JPEG"},
    }};
    const auto* known =
        std::find_if(kNames.begin(), kNames.end(), [&](const auto& name) { return uid.starts_with(name.first); });
    return known == kNames.end() ? "unknown"sv : known->second;
}

Result<const DicomSyntax*> syntaxNamed(const std::filesystem::path& path, std::string_view uid) {
    const auto* known =
        std::find_if(kSyntaxes.begin(), kSyntaxes.end(), [&](const DicomSyntax& syntax) { return syntax.uid == uid; });
    if (known == kSyntaxes.end()) {
        return cannotRead(path, "its transfer syntax " + printable(uid) + " (" + std::string(nameOfSyntax(uid)) +
                                    ") is not supported; convert the series to explicit VR little endian");
    }
    return known;
}

/// Without a meta header: the first element is one of the first of group 0008, with a type and a length that fit it.
const DicomSyntax* syntaxWithoutHeader(std::string_view head) {
    constexpr std::uint16_t kFirstGroup = 8;
    constexpr std::uint16_t kLastPlausible = 0x0018;
    constexpr std::uint32_t kLongest = 64;
    if (head.size() < 8 || numberAt<std::uint16_t>(head, 0) != kFirstGroup ||
        numberAt<std::uint16_t>(head, 2) > kLastPlausible) {
        return nullptr;
    }
    if (DicomWalker::isType(head.substr(4, 2))) {
        return numberAt<std::uint16_t>(head, 6) <= kLongest ? kTyped : nullptr;
    }
    return numberAt<std::uint32_t>(head, 4) <= kLongest ? kUntyped : nullptr;
}

/// Beginnings of files: 128 bytes and a magic word, the meta header only, or a data set.
enum class Beginning { Magic, Meta, DataSet, Other };

constexpr std::size_t kMagicAt = 128;
constexpr std::string_view kMagic = "DICM";

Beginning beginningOf(DicomStream& stream) {
    const std::string_view head = stream.peek(kMagicAt + kMagic.size());
    if (head.size() == kMagicAt + kMagic.size() && head.ends_with(kMagic)) {
        return Beginning::Magic;
    }
    if (head.starts_with("\x02\0\0\0UL\4\0"sv)) {
        return Beginning::Meta;
    }
    return syntaxWithoutHeader(head.substr(0, 8)) != nullptr ? Beginning::DataSet : Beginning::Other;
}

/// Returns the transfer syntax of the meta header or, without one, of the data set's form.
Result<const DicomSyntax*> syntaxOf(const DicomFile& file, DicomStream& stream) {
    if (const std::string* uid = file.set.find(dicom::kTransferSyntax); uid != nullptr) {
        return syntaxNamed(file.path, *uid);
    }
    const DicomSyntax* likely = syntaxWithoutHeader(stream.peek(8));
    if (likely == nullptr) {
        return cannotRead(file.path, "it says no TransferSyntaxUID (0002,0010); get the file again");
    }
    return likely;
}

} // namespace

std::string toText(DicomTag tag) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    std::string text = "(";
    for (int shift = 28; shift >= 0; shift -= 4) {
        text += kDigits[(tag >> shift) & 15U];
        text += shift == 16 ? "," : "";
    }
    return text + ")";
}

const std::string* DicomDataSet::find(DicomTag tag) const {
    const auto at = std::find_if(values.begin(), values.end(), [&](const auto& value) { return value.first == tag; });
    return at == values.end() || at->second.empty() ? nullptr : &at->second;
}

const std::vector<DicomDataSet>* DicomDataSet::items(DicomTag tag) const {
    const auto at = std::find_if(sequences.begin(), sequences.end(), [&](const auto& one) { return one.first == tag; });
    return at == sequences.end() || at->second.empty() ? nullptr : &at->second;
}

std::string_view DicomDataSet::text(DicomTag tag) const {
    const std::string* value = find(tag);
    return value == nullptr ? std::string_view() : std::string_view(*value);
}

namespace {

Result<std::optional<DicomFile>> dicomFileIn(const std::filesystem::path& path, DicomStream& stream) {
    DicomFile file;
    file.path = path;
    file.bytes = stream.mostLeft();
    const Beginning beginning = beginningOf(stream);
    if (beginning == Beginning::Other) {
        return std::optional<DicomFile>();
    }
    DicomWalker meta(stream, *kTyped);
    if ((beginning == Beginning::Magic && !stream.skip(kMagicAt + kMagic.size())) || !meta.meta(file.set)) {
        return cannotRead(path, meta.problem());
    }
    const Result<const DicomSyntax*> syntax = syntaxOf(file, stream);
    VOXTACT_TRY(syntax);
    file.syntax = *syntax;
    file.dataSetAt = stream.position();
    if (file.syntax->deflated) {
        // A bomb of gigabytes takes seconds; data other than pixels are short.
        constexpr std::uint64_t kBeside = std::uint64_t{1} << 26;
        VOXTACT_TRY(stream.inflateFromHere(kBeside));
    }
    const DicomSyntax* const likely = syntaxWithoutHeader(stream.peek(8));
    if (likely != nullptr && likely != file.syntax && (file.syntax == kTyped || file.syntax == kUntyped)) {
        file.syntax = likely;
        file.isOtherSyntax = true;
    }
    DicomWalker data(stream, *file.syntax);
    if (!data.dataSet(file.set) || (data.pixels() && !data.behindPixels(file.zeros))) {
        // Ignores files that only look like DICOM.
        constexpr std::size_t kSure = 3;
        if (beginning == Beginning::DataSet && data.elements() < kSure) {
            return std::optional<DicomFile>();
        }
        return cannotRead(path, data.problem());
    }
    if (!stream.isWhole()) {
        return cannotRead(path, "its compressed data is cut off or damaged; get the file again");
    }
    file.pixels = data.pixels();
    return std::optional(std::move(file));
}

} // namespace

Result<std::optional<DicomFile>> readDicomFile(const std::filesystem::path& path) {
    Result<DicomStream> stream = DicomStream::open(path);
    VOXTACT_TRY(stream);
    Result<std::optional<DicomFile>> file = dicomFileIn(path, *stream);
    // Whatever came before, which may not even look like DICOM.
    return stream->failed() ? readingStopped(path) : std::move(file);
}

} // namespace voxtact::io
