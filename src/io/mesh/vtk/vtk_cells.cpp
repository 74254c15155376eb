// SPDX-License-Identifier: MIT
#include "io/mesh/vtk/vtk_cells.h"

#include "io/byte_source.h"

#include <limits>
#include <type_traits>
#include <utility>

namespace voxtact::io {

std::optional<std::string> VtkCells::add(VtkCellKind kind, std::span<const std::uint64_t> corners) {
    const std::size_t vertices = file_.vertices.size() - firstVertex_;
    cell_.clear();
    for (const std::uint64_t corner : corners) {
        if (corner >= vertices) {
            return "it uses point " + std::to_string(corner) + ", there are " + std::to_string(vertices);
        }
        cell_.push_back(static_cast<std::uint32_t>(firstVertex_ + corner));
    }
    if (kind == VtkCellKind::Vertices || kind == VtkCellKind::Lines) {
        file_.pointsAndLines += kind == VtkCellKind::Vertices || cell_.empty() ? cell_.size() : cell_.size() - 1;
        return std::nullopt;
    }
    if (cell_.size() < 3) {
        return "it needs 3 corners or more, and has " + std::to_string(cell_.size());
    }
    if (kind == VtkCellKind::Strips) {
        addStrip(cell_, file_);
        return std::nullopt;
    }
    if (cell_.size() > std::numeric_limits<std::uint32_t>::max()) {
        return "it has more corners than 32 bits count";
    }
    file_.corners.insert(file_.corners.end(), cell_.begin(), cell_.end());
    file_.faceSizes.push_back(static_cast<std::uint32_t>(cell_.size()));
    return std::nullopt;
}

std::optional<std::string> VtkCells::addCounted(VtkCellKind kind, std::span<const std::uint64_t> numbers,
                                                std::uint64_t cells) {
    for (std::uint64_t i = 0; i < cells; ++i) {
        if (numbers.empty() || numbers.front() > numbers.size() - 1) {
            return "cell " + std::to_string(i) + ": its corners go on behind the section";
        }
        const auto size = static_cast<std::size_t>(numbers.front());
        if (auto reason = add(kind, numbers.subspan(1, size))) {
            return "cell " + std::to_string(i) + ": " + *reason;
        }
        numbers = numbers.subspan(1 + size);
    }
    return numbers.empty() ? std::nullopt
                           : std::optional<std::string>("its cells take " + std::to_string(numbers.size()) +
                                                        " numbers fewer than stated");
}

std::optional<std::string> VtkCells::addListed(VtkCellKind kind, std::span<const std::uint64_t> ends,
                                               std::span<const std::uint64_t> corners) {
    std::uint64_t begin = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        if (ends[i] < begin || ends[i] > corners.size()) {
            return "cell " + std::to_string(i) + ": its offset " + std::to_string(ends[i]) + " is not between " +
                   std::to_string(begin) + " and " + std::to_string(corners.size());
        }
        if (auto reason = add(kind, corners.subspan(begin, ends[i] - begin))) {
            return "cell " + std::to_string(i) + ": " + *reason;
        }
        begin = ends[i];
    }
    return begin == corners.size()
               ? std::nullopt
               : std::optional<std::string>("its connectivity has " + std::to_string(corners.size() - begin) +
                                            " numbers that no cell uses");
}

void appendVtkReals(std::string_view bytes, StoredType type, bool swapped, std::vector<double>& values) {
    withStored(type, [&](auto kind) {
        using Number = decltype(kind);
        values.reserve(values.size() + bytes.size() / sizeof(Number));
        for (std::size_t at = 0; at + sizeof(Number) <= bytes.size(); at += sizeof(Number)) {
            values.push_back(static_cast<double>(numberAt<Number>(bytes, at, swapped)));
        }
    });
}

bool appendVtkNaturals(std::string_view bytes, StoredType type, bool swapped, std::vector<std::uint64_t>& values) {
    return withStored(type, [&](auto kind) {
        using Number = decltype(kind);
        if constexpr (!std::is_integral_v<Number>) {
            return false;
        } else {
            values.reserve(values.size() + bytes.size() / sizeof(Number));
            for (std::size_t at = 0; at + sizeof(Number) <= bytes.size(); at += sizeof(Number)) {
                const Number value = numberAt<Number>(bytes, at, swapped);
                if (std::cmp_less(value, 0)) {
                    return false;
                }
                values.push_back(static_cast<std::uint64_t>(value));
            }
            return true;
        }
    });
}

bool addVtkPoints(std::span<const double> coordinates, MeshFile& file) {
    constexpr std::size_t kMax = std::numeric_limits<std::uint32_t>::max();
    const std::size_t points = coordinates.size() / 3;
    if (points > kMax - file.vertices.size()) {
        return false;
    }
    file.vertices.reserve(file.vertices.size() + points);
    for (std::size_t i = 0; i < points; ++i) {
        file.vertices.push_back({coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]});
    }
    return true;
}

void takeVtkSpace(std::string_view value, MeshFile& file) {
    file.saysLps = file.saysLps || value.find("LPS") != std::string_view::npos;
    file.saysRas = file.saysRas || value.find("RAS") != std::string_view::npos;
}

} // namespace voxtact::io
