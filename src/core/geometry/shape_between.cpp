// SPDX-License-Identifier: MIT
#include "core/geometry/shape_between.h"
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "voxtact/motion.h"

namespace voxtact {

void fillShapeBetween(std::span<const float> from, std::span<const float> to, double parameter,
                      std::vector<float>& out) {
    out.resize(from.size());
    for (std::size_t at = 0; at < from.size(); ++at) {
        out[at] = static_cast<float>((1 - parameter) * static_cast<double>(from[at]) +
                                     parameter * static_cast<double>(to[at]));
    }
}

Result<std::vector<float>> shapeBetween(std::span<const float> from, std::span<const float> to, double parameter) {
    return guard([&]() -> Result<std::vector<float>> {
        if (!(parameter >= 0 && parameter <= 1)) {
            return refuse("the parameter " + number(parameter) + " is outside of 0 to 1");
        }
        if (from.size() != to.size()) {
            return refuse("the shapes have " + std::to_string(from.size()) + " and " + std::to_string(to.size()) +
                          " coordinates");
        }
        std::vector<float> out;
        fillShapeBetween(from, to, parameter, out);
        return out;
    });
}

} // namespace voxtact
