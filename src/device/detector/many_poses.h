// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/detector.h"

#include <optional>

namespace voxtact {

/// The host makes the pairs of fewer in the time that the dispatch takes: some 40 us on an H100.
inline constexpr std::uint32_t kFewestHostPoses = 256;

/// Returns the description of a detector that makes the pairs of a batch of the host's poses on the device, in Results
/// that stage them; empty if the given one does so, or it saves no time.
[[nodiscard]] std::optional<DetectorDesc> forManyPoses(const DetectorImpl& detector, std::uint64_t poses);

/// Whether a device can have the detector that was asked for, but not that of forManyPoses(), which only saves time.
[[nodiscard]] inline bool doesWithout(const Error& error) noexcept {
    return error.code == ErrorCode::Unsupported || error.code == ErrorCode::LimitExceeded;
}

/// What `make` makes of a description, Results or a ring of them. Staging saves time alone: where the device has no
/// room for that, they are made without. Other failures are not hidden.
template <class Make> [[nodiscard]] auto stagedWhereThereIsRoom(const ResultsDesc& desc, const Make& make) {
    auto made = make(desc);
    if (made.ok() || made.error().code != ErrorCode::LimitExceeded || !desc.staged) {
        return made;
    }
    ResultsDesc plain = desc;
    plain.staged = false;
    auto without = make(plain);
    return without.ok() ? std::move(without) : std::move(made);
}

} // namespace voxtact
