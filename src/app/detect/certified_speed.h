// SPDX-License-Identifier: MIT
#pragma once

#include "app/options/open_session.h"
#include "voxtact/detector.h"

#include <span>
#include <string>
#include <vector>

namespace voxtact::app {

/// How fast this machine answers in the projection conservative: by compute, and by the host with all its processors,
/// in this order; a count, or yes or no. The scene is makeMeasureScene()'s at more poses, in submissions as detect
/// makes them. compute is trusted where it passes its self-test and answers every pair as the host does. Blocks: the
/// making of pipelines, and for a second or so.
[[nodiscard]] Result<std::vector<MethodSpeed>> measureCertified(const device::Session& session, bool yesNo);

/// How many pairs a device answers otherwise than the host, in words; empty: none. Counts that one of them calls a
/// lower bound may differ.
[[nodiscard]] std::string otherAnswers(std::span<const PairAnswer> device, std::span<const PairAnswer> host);

} // namespace voxtact::app
