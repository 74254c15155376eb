// SPDX-License-Identifier: MIT
#pragma once

#include "device/count/compute.h"
#include "device/count/view.h"
#include "device/detector/pair_setup.h"
#include "device/touch/certified.h"

#include <variant>

namespace voxtact {

using AnyPass = std::variant<ViewPass, ComputePass, CertifiedPass>;

struct DetectorImpl {
    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    DetectorDesc given;
    PassDesc desc; ///< of `given`
    AnyPass pass;
    std::optional<PairSetup> setup{}; ///< with devicePoses
};

} // namespace voxtact
