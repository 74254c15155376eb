// SPDX-License-Identifier: MIT
#pragma once

#include "app/chunks/run_facts.h"

#include <cstdint>
#include <string>
#include <vector>

namespace voxtact::app {

/// A file that a run makes: the head, then what its chunks have, with something between, then the tail. Several of one
/// option are parts of one file, in their order.
struct RunOutput {
    std::string option; ///< that asks for it: "--output", "--triangles"
    std::string ending; ///< that the file must have; empty: any
    std::string head;
    std::string between;
    std::string tail;
    std::string part{}; ///< of several of one option: a word for each
    /// Not empty: as many files, of these targets in this order (target_path.h), each in a frame (frames.h).
    std::vector<std::string> targets{};

    /// "output", as the files of chunks end.
    [[nodiscard]] std::string name() const { return option.substr(2) + (part.empty() ? "" : "-" + part); }
    bool operator==(const RunOutput&) const = default;
};

/// What a run is.
struct RunManifest {
    RunFacts facts;
    std::vector<RunOutput> outputs; ///< the table is the first
    std::uint64_t chunks = 0;

    /// All of an option, in their order; none: the run was not asked for it.
    [[nodiscard]] std::vector<const RunOutput*> outputsOf(const std::string& option) const;

    /// A hash of the facts: by it chunks know whose they are.
    [[nodiscard]] std::string id() const;
    /// As a file, with a check of all of it.
    [[nodiscard]] std::string text() const;
    /// As it will be read: what a file of text cannot hold is replaced.
    [[nodiscard]] RunManifest asWritten() const;
};

/// What a file of a manifest is.
enum class ManifestState { Whole, Damaged, OfAnotherVersion };

struct ReadManifest {
    ManifestState state = ManifestState::Damaged;
    RunManifest manifest{}; ///< where it is whole
};
[[nodiscard]] ReadManifest readManifestText(const std::string& text);

} // namespace voxtact::app
