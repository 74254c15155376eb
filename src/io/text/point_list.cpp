// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/slicer_points.h"
#include "io/text/text_lines.h"
#include "voxtact/io.h"

namespace voxtact::io {

Result<std::vector<NamedPoint>> readPoints(const std::filesystem::path& path, std::optional<MeshSpace> space) {
    return guard([&]() -> Result<std::vector<NamedPoint>> {
        if (isSlicerPoints(path)) {
            Result<std::vector<NamedPoint>> points = readSlicerPoints(path, space);
            return points.ok() && points->empty() ? Result<std::vector<NamedPoint>>(cannotRead(path, "it has no point"))
                                                  : std::move(points);
        }
        const double sign = space == MeshSpace::RAS ? -1 : 1;
        std::vector<NamedPoint> points;
        const Result<void> read = forWords(path, [&](const auto& words, std::uint64_t line) -> Result<void> {
            NamedPoint point;
            point.line = line;
            if (words.size() != 3 && words.size() != 4) {
                return badLine(
                    path, line,
                    "a point is three numbers x y z, and may have a name of one word behind them; this has " +
                        std::to_string(words.size()) + (words.size() == 1 ? " word" : " words"));
            }
            for (std::size_t axis = 0; axis < point.position.size(); ++axis) {
                if (const auto reason = parseNumber(words[axis], point.position[axis])) {
                    return badLine(path, line, *reason);
                }
            }
            point.position = {sign * point.position[0], sign * point.position[1], point.position[2]};
            point.name = words.size() == 4 ? words[3] : std::string_view();
            points.push_back(std::move(point));
            return {};
        });
        if (!read.ok()) {
            return formatByName(path, read.error(), "write a point as a line 'x y z' or 'x y z name'");
        }
        if (points.empty()) {
            return cannotRead(path, "it has no point; a point is a line 'x y z' or 'x y z name'");
        }
        return points;
    });
}

} // namespace voxtact::io
