// SPDX-License-Identifier: MIT
#pragma once

#include "bench/engines/scene.h"
#include "bench/program/compare_options.h"

namespace voxtact::app {

/// Inputs named by options.
[[nodiscard]] Result<lab::Scene> readScene(const CompareOptions& options);

/// `voxtact compare --localize`.
[[nodiscard]] Outcome runLocalize(const CompareOptions& given, const CLI::App& parser);

} // namespace voxtact::app
