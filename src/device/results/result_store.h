// SPDX-License-Identifier: MIT
#pragma once

#include "device/detector/pass_desc.h"
#include "device/results/results_impl.h"

namespace voxtact {

/// What Results of a detector have: refuses a desc that no device, or not this one, has room for.
[[nodiscard]] Result<std::unique_ptr<ResultsImpl>> makeResults(ContextImpl& context, const PassDesc& detector,
                                                               const ResultsDesc& desc);

} // namespace voxtact
