// SPDX-License-Identifier: MIT
#include "core/geometry/shape_between.h"
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "voxtact/motion.h"

namespace voxtact {

void fillShapeBetween(std::span<const double> from, std::span<const double> to, double parameter,
                      std::vector<double>& out) {
    out.resize(from.size());
    for (std::size_t at = 0; at < from.size(); ++at) {
        out[at] = (1 - parameter) * from[at] + parameter * to[at];
    }
}

Result<std::vector<double>> shapeBetween(std::span<const double> from, std::span<const double> to, double parameter) {
    return guard([&]() -> Result<std::vector<double>> {
        if (!(parameter >= 0 && parameter <= 1)) {
            return refuse("the parameter " + number(parameter) + " is outside of 0 to 1");
        }
        if (from.size() != to.size()) {
            return refuse("the shapes have " + std::to_string(from.size()) + " and " + std::to_string(to.size()) +
                          " coordinates");
        }
        std::vector<double> out;
        fillShapeBetween(from, to, parameter, out);
        return out;
    });
}

} // namespace voxtact
