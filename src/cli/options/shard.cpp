// SPDX-License-Identifier: MIT
#include "cli/options/shard.h"

#include "cli/options/shared_options.h"

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace voxtact::app {

namespace {

std::optional<Shard> parseShard(std::string_view text) {
    Shard shard;
    const char* const end = text.data() + text.size();
    const auto [slash, badIndex] = std::from_chars(text.data(), end, shard.index);
    if (badIndex != std::errc() || slash == end || *slash != '/') {
        return std::nullopt;
    }
    const auto [rest, badCount] = std::from_chars(slash + 1, end, shard.count);
    return badCount == std::errc() && rest == end && shard.index >= 1 && shard.index <= shard.count
               ? std::optional(shard)
               : std::nullopt;
}

} // namespace

std::pair<std::uint64_t, std::uint64_t> Shard::range(std::uint64_t rows) const noexcept {
    // No overflow: the product of the remainder and an index fits in 64 bits.
    const auto first = [&](std::uint64_t part) { return rows / count * part + rows % count * part / count; };
    return {first(index - 1), first(index)};
}

void addShardOption(CLI::App& parser, Shard& shard) {
    addText(
        parser, "--shard",
        [&shard](const std::string& text) -> std::optional<std::string> {
            const std::optional<Shard> parsed = parseShard(text);
            shard = parsed.value_or(Shard{});
            return parsed ? std::nullopt
                          : std::optional<std::string>("is not I/N, two whole numbers below 2^32 with I from 1 to N");
        },
        "write part I of N of the rows, CSV", "I/N");
}

Result<void> checkShard(const Shard& shard, OutputOptions& output,
                        std::initializer_list<std::pair<bool, const char*>> whole) {
    if (!shard.isPart()) {
        return {};
    }
    if (output.formatName.empty()) {
        output.formatName = "csv";
    }
    if (output.formatName != "csv") {
        return badArgument("--format " + output.formatName + ": --shard writes CSV; leave --format out");
    }
    for (const auto& [given, option] : whole) {
        if (given) {
            return badArgument(
                option +
                std::string(": not with --shard, because it describes the whole run; leave out one of the two"));
        }
    }
    return {};
}

} // namespace voxtact::app
