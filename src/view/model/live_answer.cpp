// SPDX-License-Identifier: MIT
#include "view/model/live_answer.h"

#include "view/model/labels.h"

#include <algorithm>
#include <cmath>

namespace voxtact::view {

LiveAnswer liveAnswer(BatchAnswer batch, std::uint64_t revision, const Mat4& world_from_object, double milliseconds) {
    LiveAnswer out;
    out.revision = revision;
    out.world_from_object = world_from_object;
    out.pair = batch.pairs.front();
    out.milliseconds = milliseconds;
    out.contactsFound = batch.contactsFound;
    for (const TouchedTriangle& touched : batch.triangles) {
        out.triangles.push_back(touched.triangle);
    }
    std::ranges::stable_sort(batch.contacts, [](const Contact& a, const Contact& b) { return a.depth > b.depth; });
    batch.contacts.resize(std::min(batch.contacts.size(), kShownContacts));
    out.contacts = std::move(batch.contacts);
    out.labels = touchedLabels(std::move(batch.labels));
    return out;
}

const char* verdict(const PairAnswer& answer) noexcept {
    return answer.hit ? "yes" : answer.possible ? "possible" : "no";
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
    // The first is in sight until the second comes.
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
