// SPDX-License-Identifier: MIT
#include "viewer/model/answers/live_answer.h"

#include "viewer/model/document/labels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

namespace voxtact::view {

namespace {

/// "1 triangle", "2 triangles".
std::string counted(unsigned long long count, const std::string& one) {
    return std::to_string(count) + ' ' + one + (count == 1 ? "" : "s");
}

/// Returns the number of contacts of a pair; the batch lists `listed` of them.
std::uint64_t contactsOf(const BatchAnswer& batch, const PairAnswer& pair, std::size_t listed) {
    if (batch.pairs.size() == 1) {
        return batch.contactsFound;
    }
    const bool cut = batch.contactsFound > batch.contacts.size();
    return cut ? std::max<std::uint64_t>(pair.count, listed) : listed;
}

MeshAnswer meshAnswer(const BatchAnswer& batch, const PairAnswer& pair, std::uint32_t number,
                      const Instrument& instrument) {
    MeshAnswer out;
    out.instrument = instrument;
    out.pair = pair;
    for (const TouchedTriangle& touched : batch.triangles) {
        if (touched.pair == number) {
            out.triangles.push_back(touched.triangle);
        }
    }
    const auto own = [number](const auto& one) { return one.pair == number; };
    std::ranges::copy_if(batch.contacts, std::back_inserter(out.contacts), own);
    out.contactsFound = contactsOf(batch, pair, out.contacts.size());
    std::ranges::stable_sort(out.contacts, [](const Contact& a, const Contact& b) { return a.depth > b.depth; });
    out.contacts.resize(std::min(out.contacts.size(), kShownContacts));
    std::vector<LabelCount> labels;
    std::ranges::copy_if(batch.labels, std::back_inserter(labels), own);
    out.labels = touchedLabels(std::move(labels));
    return out;
}

} // namespace

View answerView(const Grid& grid) {
    constexpr std::uint32_t kSide = 512;
    return {framingCamera(grid, kSide, kSide), kSide, kSide};
}

const MeshAnswer* LiveAnswer::of(std::size_t mesh) const noexcept {
    const auto at = std::ranges::find_if(meshes, [mesh](const MeshAnswer& one) { return one.instrument.mesh == mesh; });
    return at == meshes.end() ? nullptr : &*at;
}

LiveAnswer liveAnswer(BatchAnswer batch, std::uint64_t revision, std::span<const Instrument> instruments,
                      double milliseconds) {
    LiveAnswer out;
    out.revision = revision;
    out.milliseconds = milliseconds;
    for (std::size_t i = 0; i < std::min(instruments.size(), batch.pairs.size()); ++i) {
        out.meshes.push_back(meshAnswer(batch, batch.pairs[i], static_cast<std::uint32_t>(i), instruments[i]));
    }
    return out;
}

const char* verdict(const PairAnswer& answer) noexcept {
    return answer.hit ? "yes" : answer.possible ? "undecided" : "no";
}

std::string countText(const PairAnswer& answer) {
    const std::string one = answer.projection == Projection::Certified ? "certified cell" : "fragment";
    return (answer.exactness == Exactness::Exact ? "" : "at least ") + counted(answer.count, one);
}

std::string trianglesText(const MeshAnswer& answer) {
    std::string triangles = counted(answer.triangles.size(), "triangle");
    if (answer.contacts.empty()) {
        return triangles;
    }
    const double deepest = answer.contacts.front().depth;
    char text[64];
    // The maximum depth.
    std::snprintf(text, sizeof text, ", deepest %.4g mm%s", deepest, deepest >= kDefaultMaxDepth ? " or more" : "");
    return triangles + text;
}

int hitNumber(const PairAnswer& answer) noexcept {
    return answer.hit ? 1 : answer.possible ? 2 : 0;
}

void Times::add(double milliseconds) {
    constexpr std::size_t kMost = 1000;
    last_.push_back(milliseconds);
    if (last_.size() > kMost) {
        last_.pop_front();
    }
}

double Times::percentile(double share) const {
    if (last_.empty()) {
        return 0;
    }
    std::vector<double> sorted(last_.begin(), last_.end());
    const double rank = std::ceil(share * static_cast<double>(sorted.size()));
    const auto at = static_cast<std::size_t>(std::clamp(rank, 1.0, static_cast<double>(sorted.size()))) - 1;
    std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(at));
    return sorted[at];
}

void Strip::add(double when, int hit, double milliseconds) {
    entries_.push_back({when, hit, milliseconds});
    // The first is shown until the second.
    while (entries_.size() > 1 && entries_[1].when <= when - kSeconds) {
        entries_.pop_front();
    }
}

std::vector<Strip::Piece> Strip::pieces(double now) const {
    std::vector<Piece> out;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const double from = std::min(now - entries_[i].when, kSeconds);
        const double to = i + 1 < entries_.size() ? std::min(now - entries_[i + 1].when, kSeconds) : 0;
        if (from > to) {
            out.push_back({from, to, entries_[i].hit, entries_[i].milliseconds});
        }
    }
    return out;
}

} // namespace voxtact::view
