// SPDX-License-Identifier: MIT
#pragma once

#include "oracle/oracle.h"
#include "voxtact/data.h"

#include <cstdint>

/// The oracle of contact areas: double precision, no hierarchy, nothing but triangles that are quartered until the box
/// around a quarter is opaque all over, or nowhere. Of the opaque part it says what the certified oracle says.
namespace voxtact::oracle {

/// The contact area is within it, mm^2, up to some roundings of a triangle's area.
struct OracleArea {
    double lo = 0;
    double hi = 0;
};

/// Triangles are quartered until there are more than `mostParts` of them to go on with. The pair's view is ignored.
/// Refuses what certifiedOracle() refuses.
[[nodiscard]] Result<OracleArea> areaOracle(const OraclePair& pair, std::size_t mostParts = 20000);

/// The same of what is opaque and where labelAt() says the label. The map is on the volume's grid.
[[nodiscard]] Result<OracleArea> labelAreaOracle(const OraclePair& pair, const LabelData& labels, std::int32_t label,
                                                 std::size_t mostParts = 20000);

} // namespace voxtact::oracle
