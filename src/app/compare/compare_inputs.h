// SPDX-License-Identifier: MIT
#pragma once

#include "app/compare/compare_options.h"
#include "lab/engines/scene.h"

namespace voxtact::app {

/// What the options name.
[[nodiscard]] Result<lab::Scene> readScene(const CompareOptions& options);

/// `voxtact compare --localize`.
[[nodiscard]] Outcome runLocalize(const CompareOptions& given, const CLI::App& parser);

} // namespace voxtact::app
