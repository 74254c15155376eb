// SPDX-License-Identifier: MIT
#pragma once

#include "device/results/results_impl.h"

namespace voxtact {

/// What Results have: refuses a desc that no device, or not this one, has room for.
[[nodiscard]] Result<std::unique_ptr<ResultsImpl>> makeResults(ContextImpl& context, const ResultsDesc& desc);

} // namespace voxtact
