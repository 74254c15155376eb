// SPDX-License-Identifier: MIT
#pragma once

#include "bench/engines/scene.h"
#include "bench/program/compare_options.h"

namespace voxtact::app {

/// What the options name.
[[nodiscard]] Result<lab::Scene> readScene(const CompareOptions& options);

/// `voxtact compare --localize`.
[[nodiscard]] Outcome runLocalize(const CompareOptions& given, const CLI::App& parser);

} // namespace voxtact::app
