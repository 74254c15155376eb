// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "voxtact/io.h"

namespace voxtact::io {

Result<std::vector<NamedPoint>> readPoints(const std::filesystem::path& path) {
    return guard([&]() -> Result<std::vector<NamedPoint>> {
        Result<LineReader> lines = LineReader::open(path);
        VOXTACT_TRY(lines);
        std::vector<NamedPoint> points;
        std::vector<std::string_view> tokens;
        while (const auto line = lines->next()) {
            splitTokens(*line, tokens);
            if (tokens.empty()) {
                continue;
            }
            NamedPoint point;
            point.line = lines->lineNumber();
            if (tokens.size() != 3 && tokens.size() != 4) {
                return badLine(
                    path, point.line,
                    "a point is three numbers x y z, and may have a name of one word behind them; this has " +
                        std::to_string(tokens.size()) + (tokens.size() == 1 ? " word" : " words"));
            }
            for (std::size_t axis = 0; axis < point.position.size(); ++axis) {
                if (const auto reason = parseNumber(tokens[axis], point.position[axis])) {
                    return badLine(path, point.line, *reason);
                }
            }
            point.name = tokens.size() == 4 ? tokens[3] : std::string_view();
            points.push_back(std::move(point));
        }
        if (points.empty()) {
            return cannotRead(path, "it has no point; a point is a line 'x y z' or 'x y z name'");
        }
        return points;
    });
}

} // namespace voxtact::io
