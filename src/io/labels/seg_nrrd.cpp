// SPDX-License-Identifier: MIT
// Segmentations of 3D Slicer: a label map whose header names the segments. Segments that overlap are in several layers,
// which the file has as a fourth axis.
#include "core/base/try.h"
#include "io/errors.h"
#include "io/labels/segment_map.h"
#include "io/mesh/mesh_text.h"
#include "io/text/text_lines.h"
#include "io/volume/nrrd_header.h"
#include "io/volume/volume_container.h"

#include <charconv>
#include <map>
#include <utility>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

/// A segment as the header states it: "Segment3_LabelValue:=4".
struct StoredSegment {
    std::string name;
    std::optional<std::int64_t> label;
    std::optional<std::int64_t> layer;
};

using StoredSegments = std::map<std::uint64_t, StoredSegment>; // by the number in the key

Result<StoredSegments> segmentsOf(const fs::path& path, const NrrdHeader& header) {
    constexpr std::string_view kPrefix = "Segment";
    StoredSegments segments;
    for (const auto& [key, value] : header.keys) {
        const std::size_t line = std::min(key.find('_'), key.size());
        const std::string_view number = std::string_view(key).substr(0, line);
        const auto index = number.starts_with(kPrefix) ? parseNatural(number.substr(kPrefix.size())) : std::nullopt;
        if (!index) {
            continue; // "Segmentation_..." and others
        }
        StoredSegment& segment = segments[*index];
        const std::string_view field = std::string_view(key).substr(line);
        const std::string_view text = trimmed(value);
        if (field == "_Name") {
            segment.name = oneLine(text);
        }
        if (field == "_LabelValue" || field == "_Layer") {
            std::int64_t whole = 0;
            const auto end = std::from_chars(text.data(), text.data() + text.size(), whole);
            if (end.ec != std::errc{} || end.ptr != text.data() + text.size()) {
                return cannotRead(path, "its " + inQuotes(key) + " is " + inQuotes(text) + ", not a whole number");
            }
            (field == "_Layer" ? segment.layer : segment.label) = whole;
        }
    }
    return segments;
}

/// The axis of the layers.
struct LayerAxis {
    std::uint32_t layers = 1;
    bool isFirst = true; ///< in the file: the layers of a voxel lie side by side
};

std::vector<std::string> wordsOf(const std::string& text) {
    std::vector<std::string_view> tokens;
    splitTokens(text, tokens);
    return {tokens.begin(), tokens.end()};
}

/// Takes the axis of the layers out of the header, which is 3D then.
LayerAxis takeLayers(NrrdHeader& header) {
    const std::vector<std::string> kinds = wordsOf(header.get("kinds"));
    const std::vector<std::string> sizes = wordsOf(header.get("sizes"));
    constexpr std::size_t kAxes = 4;
    if (kinds.size() != kAxes || sizes.size() != kAxes || header.get("dimension") != std::to_string(kAxes)) {
        return {};
    }
    const auto isSpace = [](const std::string& kind) { return kind == "domain" || kind == "space"; };
    const std::size_t axis = !isSpace(kinds.front()) ? 0 : kAxes - 1;
    const std::optional<std::uint64_t> layers = parseNatural(sizes[axis]);
    constexpr std::uint64_t kMaxLayers = 65535;
    const std::size_t none = header.get("spacedirections").find("none");
    if (isSpace(kinds[axis]) || !layers || *layers < 2 || *layers > kMaxLayers || none == std::string::npos) {
        return {}; // left to the reader of images
    }
    header.fields["spacedirections"].erase(none, 4);
    header.fields["dimension"] = "3";
    for (const char* field :
         {"sizes", "kinds", "spacings", "axismins", "axismaxs", "thicknesses", "centerings", "centers"}) {
        const auto entry = header.fields.find(field);
        std::vector<std::string> words =
            entry == header.fields.end() ? std::vector<std::string>() : wordsOf(entry->second);
        if (words.size() != kAxes) {
            continue;
        }
        words.erase(words.begin() + static_cast<std::ptrdiff_t>(axis));
        entry->second = words[0] + " " + words[1] + " " + words[2];
    }
    return {static_cast<std::uint32_t>(*layers), axis == 0};
}

/// The segment of each label of each layer.
Result<std::map<std::pair<std::int64_t, std::int64_t>, std::size_t>>
placesOf(const fs::path& path, const StoredSegments& stored, std::uint32_t layers) {
    std::map<std::pair<std::int64_t, std::int64_t>, std::size_t> places;
    std::size_t number = 0;
    for (const auto& [index, segment] : stored) {
        // Before 4.11, 3D Slicer wrote each segment into a layer of its own, as 1.
        const std::int64_t layer = segment.layer.value_or(segment.label ? 0 : static_cast<std::int64_t>(number));
        if (layer < 0 || layer >= layers) {
            return cannotRead(path, "its segment '" + printable(segment.name) + "' is in the layer " +
                                        std::to_string(layer) + ", the file has " + std::to_string(layers));
        }
        if (!places.try_emplace({layer, segment.label.value_or(1)}, number++).second) {
            return cannotRead(path, "its segment '" + printable(segment.name) +
                                        "' has the layer and the label of another one");
        }
    }
    return places;
}

/// The layers in one map.
Result<LabelFile> mergeLayers(const fs::path& path, const StoredSegments& stored, const LayerAxis& axis,
                              ContainedImage contained) {
    const auto places = placesOf(path, stored, axis.layers);
    VOXTACT_TRY(places);
    StoredImage flat = std::move(contained.image);
    const Grid grid = flat.grid;
    flat.grid.size[axis.isFirst ? 0 : 2] *= axis.layers;
    const Result<std::vector<std::int32_t>> values = toLabels(flat, path);
    VOXTACT_TRY(values);
    std::vector<Segment> segments;
    for (const auto& [index, segment] : stored) {
        segments.push_back({segment.name, 0}); // numbered below
    }
    Result<SegmentMap> map = SegmentMap::create(path, grid, std::move(segments));
    VOXTACT_TRY(map);
    const std::uint64_t voxels = voxelCount(grid);
    for (std::uint64_t i = 0; i < values->size(); ++i) {
        const std::int32_t value = (*values)[static_cast<std::size_t>(i)];
        if (value == 0) {
            continue;
        }
        const std::uint64_t layer = axis.isFirst ? i % axis.layers : i / voxels;
        const auto place = places->find({static_cast<std::int64_t>(layer), value});
        if (place == places->end()) {
            return cannotRead(path, "its layer " + std::to_string(layer) + " has the label " + std::to_string(value) +
                                        ", which is no segment's");
        }
        if (!map->set(axis.isFirst ? i / axis.layers : i % voxels, place->second)) {
            return map->overlap();
        }
    }
    contained.notes.push_back("its " + std::to_string(axis.layers) + " layers are merged into one label map");
    return std::move(*map).finish(std::move(contained.notes));
}

} // namespace

Result<std::optional<LabelFile>> readSegNrrd(const fs::path& path, const VolumeReadOptions& options) {
    std::error_code ignored;
    if (volumeFormat(path) != VolumeFormat::Nrrd || fs::is_directory(path, ignored)) {
        return std::optional<LabelFile>();
    }
    const VolumeSource source(options.progress);
    Result<ByteReader> reader = source.open(path);
    VOXTACT_TRY(reader);
    Result<NrrdHeader> header = readNrrdHeader(*reader);
    VOXTACT_TRY(header);
    const Result<StoredSegments> segments = segmentsOf(path, *header);
    VOXTACT_TRY(segments);
    if (segments->empty()) {
        return std::optional<LabelFile>();
    }
    const LayerAxis axis = takeLayers(*header);
    if (axis.layers == 1) {
        Result<LabelFile> file = readLabelImage(path, options);
        VOXTACT_TRY(file);
        for (const auto& [index, segment] : *segments) {
            if (segment.label && std::in_range<std::int32_t>(*segment.label) && !segment.name.empty()) {
                file->names.push_back({static_cast<std::int32_t>(*segment.label), segment.name});
            }
        }
        return std::optional(std::move(*file));
    }
    VOXTACT_TRY(frameOf(path, 1, options));
    Result<ContainedImage> contained =
        readNrrdImage(source, std::move(*reader), *header, axis.isFirst ? 0 : 2, axis.layers);
    VOXTACT_TRY(contained);
    Result<LabelFile> file = mergeLayers(path, *segments, axis, std::move(*contained));
    VOXTACT_TRY(file);
    return std::optional(std::move(*file));
}

} // namespace voxtact::io
