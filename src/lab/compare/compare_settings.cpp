// SPDX-License-Identifier: MIT
#include "lab/compare/compare_settings.h"

#include <algorithm>

namespace voxtact::lab {

const char* toString(Sweep sweep) noexcept {
    switch (sweep) {
    case Sweep::Batch:
        return "batch";
    case Sweep::Triangles:
        return "triangles";
    case Sweep::Fragments:
        return "fragments";
    case Sweep::Voxels:
        return "voxels";
    }
    return "unknown";
}

bool CompareSettings::wants(CountingMethod method) const {
    return methods.empty() || std::find(methods.begin(), methods.end(), method) != methods.end();
}

} // namespace voxtact::lab
