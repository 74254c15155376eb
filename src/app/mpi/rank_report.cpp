// SPDX-License-Identifier: MIT
#include "app/mpi/rank_report.h"

#include <algorithm>
#include <cstdlib>

namespace voxtact::app {

std::string RankEnd::message() const {
    return std::to_string(status) + (done ? " 1\n" : " 0\n") + text;
}

RankEnd RankEnd::of(const std::string& message) {
    const std::size_t line = std::min(message.find('\n'), message.size());
    return {std::atoi(message.c_str()), line > 0 && message[line - 1] == '1',
            message.substr(std::min(line + 1, message.size()))};
}

void RankNotes::add(int rank, const std::string& note) {
    auto found = std::ranges::find(notes_, note, &std::pair<std::string, std::vector<int>>::first);
    if (found == notes_.end()) {
        found = notes_.insert(notes_.end(), {note, {}});
    }
    std::vector<int>& ranks = found->second;
    if (std::ranges::find(ranks, rank) == ranks.end()) {
        ranks.insert(std::ranges::upper_bound(ranks, rank), rank);
    }
}

std::vector<std::string> RankNotes::lines(int ranks) const {
    std::vector<std::string> lines;
    for (const auto& [note, of] : notes_) {
        std::string who;
        for (const int rank : of) {
            who += (who.empty() ? "" : ", ") + std::to_string(rank);
        }
        // A count is one of each rank, so that ranks are named even where all say the same.
        const bool all = static_cast<int>(of.size()) == ranks;
        lines.push_back((ranks == 1      ? ""
                         : all           ? "all ranks: "
                         : of.size() > 1 ? "ranks " + who + ": "
                                         : "rank " + who + ": ") +
                        note);
    }
    return lines;
}

} // namespace voxtact::app
