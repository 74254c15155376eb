// SPDX-License-Identifier: MIT
#include "io/labels/segment_map.h"

#include "core/base/try.h"
#include "io/errors.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace voxtact::io {

Result<SegmentMap> SegmentMap::create(const std::filesystem::path& path, const Grid& grid,
                                      std::vector<Segment> segments) {
    if (segments.size() >= std::numeric_limits<std::uint16_t>::max()) {
        return cannotRead(path, "it has " + std::to_string(segments.size()) + " segments, a label map has 65534");
    }
    if (const Result<void> checked = checkGrid(grid); !checked.ok()) {
        return cannotRead(path, checked.error().text);
    }
    return SegmentMap(path, grid, std::move(segments));
}

SegmentMap::SegmentMap(std::filesystem::path path, const Grid& grid, std::vector<Segment> segments)
    : path_(std::move(path)), grid_(grid), segments_(std::move(segments)),
      owners_(static_cast<std::size_t>(voxelCount(grid))) {}

bool SegmentMap::set(std::uint64_t voxel, std::size_t segment) {
    std::uint16_t& owner = owners_[static_cast<std::size_t>(voxel)];
    if (owner != 0 && owner != segment + 1) {
        first_ = owner - std::size_t{1};
        second_ = segment;
        return false;
    }
    owner = static_cast<std::uint16_t>(segment + 1);
    return true;
}

Error SegmentMap::overlap() const {
    return cannotRead(path_, "its segments '" + printable(segments_[first_].name) + "' and '" +
                                 printable(segments_[second_].name) +
                                 "' overlap, and a voxel of a label map has one label; export them one by one");
}

LabelFile SegmentMap::finish(std::vector<std::string> notes) && {
    std::map<std::int64_t, std::size_t> byNumber;
    for (std::size_t i = 0; i < segments_.size(); ++i) {
        byNumber.emplace(segments_[i].number, i);
    }
    const bool isKept =
        byNumber.size() == segments_.size() &&
        (byNumber.empty() || (byNumber.begin()->first > 0 && std::in_range<std::int32_t>(byNumber.rbegin()->first)));
    if (!isKept) {
        byNumber.clear();
        for (std::size_t i = 0; i < segments_.size(); ++i) {
            byNumber.emplace(static_cast<std::int64_t>(i + 1), i);
        }
        notes.push_back("the segments are numbered from 1 to " + std::to_string(segments_.size()) +
                        ", in the order of the file");
    }
    std::vector<bool> isUsed(segments_.size() + 1);
    for (const std::uint16_t owner : owners_) {
        isUsed[owner] = true;
    }
    LabelFile file;
    file.labels.grid = grid_;
    file.labels.values = {0};
    std::vector<std::uint16_t> places(segments_.size() + 1);
    for (const auto& [number, segment] : byNumber) {
        const auto label = static_cast<std::int32_t>(number);
        if (isUsed[segment + 1]) {
            places[segment + 1] = static_cast<std::uint16_t>(file.labels.values.size());
            file.labels.values.push_back(label);
        }
        if (!segments_[segment].name.empty()) {
            file.names.push_back({label, std::move(segments_[segment].name)});
        }
    }
    for (std::uint16_t& owner : owners_) {
        owner = places[owner];
    }
    file.labels.indices = std::move(owners_);
    file.notes = std::move(notes);
    return file;
}

} // namespace voxtact::io
