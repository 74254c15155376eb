// SPDX-License-Identifier: MIT
#include "cli/info/info_table.h"

#include "cli/output/progress.h"
#include "cli/output/text_for_messages.h"
#include "cli/version.h"
#include "core/base/escaped.h"
#include "core/base/text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <ostream>

namespace voxtact::app {

namespace {

/// Rounds to a nanometre; more digits have no meaning.
double rounded(double value) {
    constexpr double kParts = 1e6;
    return std::round(value * kParts) / kParts + 0.0;
}

double percent(double share) {
    constexpr double kParts = 1e4;
    return std::round(share * 100 * kParts) / kParts;
}

std::string rangeText(const HistogramBin& bin) {
    return bin.lo == bin.hi ? number(rounded(bin.lo)) : number(rounded(bin.lo)) + ".." + number(rounded(bin.hi));
}

std::vector<io::NamedCount> histogramCounts(const VolumeInfo& volume) {
    std::vector<io::NamedCount> counts;
    for (const HistogramBin& bin : volume.histogram) {
        counts.push_back({static_cast<std::int32_t>(counts.size()), rangeText(bin), bin.voxels});
    }
    return counts;
}

struct Column {
    std::string name;
    std::function<io::Cell(const PathInfo&)> cell;
};

template <class Get> Column ofVolume(std::string name, Get get) {
    return {std::move(name),
            [get](const PathInfo& path) { return path.volume ? io::Cell(get(*path.volume)) : io::Cell(); }};
}

template <class Get> Column ofMesh(std::string name, Get get) {
    return {std::move(name),
            [get](const PathInfo& path) { return path.mesh ? io::Cell(get(*path.mesh)) : io::Cell(); }};
}

template <class Get> Column ofPair(std::string name, Get get) {
    return {std::move(name),
            [get](const PathInfo& path) { return path.pair ? io::Cell(get(*path.pair)) : io::Cell(); }};
}

const Box& boxOf(const PathInfo& path) {
    return path.volume ? path.volume->world : path.mesh->facts.bounds;
}

std::string kindOf(const PathInfo& path) {
    return path.volume ? "volume" : path.mesh ? "mesh" : "pair";
}

io::Cell hintOf(const PathInfo& path) {
    return path.mesh    ? io::Cell(path.mesh->hint)
           : !path.pair ? io::Cell()
                        : io::Cell(path.pair->others.empty() ? std::string() : toText(path.pair->others.front()));
}

std::vector<Column> columns() {
    std::vector<Column> all{{"path", [](const PathInfo& path) { return path.path; }}, {"kind", kindOf}};
    for (const bool upper : {false, true}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            all.push_back({std::string(upper ? "max_" : "min_") + "xyz"[axis], [upper, axis](const PathInfo& path) {
                               return path.pair ? io::Cell() : rounded((upper ? boxOf(path).hi : boxOf(path).lo)[axis]);
                           }});
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        all.push_back(ofVolume(std::string("size_") + "xyz"[axis],
                               [axis](const VolumeInfo& volume) { return std::uint64_t{volume.grid.size[axis]}; }));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        all.push_back(ofVolume(std::string("spacing_") + "xyz"[axis],
                               [axis](const VolumeInfo& volume) { return rounded(volume.grid.spacing[axis]); }));
    }
    all.push_back(ofVolume("orientation", [](const VolumeInfo& volume) { return volume.towards; }));
    all.push_back(ofVolume("oblique_degrees", [](const VolumeInfo& volume) { return rounded(volume.oblique); }));
    all.push_back(ofVolume("type", [](const VolumeInfo& volume) { return std::string(toString(volume.type)); }));
    all.push_back(ofVolume("value_min", [](const VolumeInfo& volume) { return volume.values.lo; }));
    all.push_back(ofVolume("value_max", [](const VolumeInfo& volume) { return volume.values.hi; }));
    all.push_back(ofVolume("value_mean", [](const VolumeInfo& volume) { return rounded(volume.mean); }));
    all.push_back(ofVolume("opaque_percent", [](const VolumeInfo& volume) { return percent(volume.opaque); }));
    all.push_back(ofVolume("histogram", histogramCounts));
    all.push_back(ofMesh("triangles", [](const MeshInfo& mesh) { return std::uint64_t{mesh.facts.triangles}; }));
    all.push_back(ofMesh("vertices", [](const MeshInfo& mesh) { return std::uint64_t{mesh.facts.vertices}; }));
    all.push_back(ofMesh("degenerate", [](const MeshInfo& mesh) { return std::uint64_t{mesh.facts.degenerate}; }));
    all.push_back(ofMesh("parts", [](const MeshInfo& mesh) { return std::uint64_t{mesh.closedness.parts}; }));
    all.push_back(ofMesh("closed", [](const MeshInfo& mesh) {
        return mesh.closedness.closed() ? io::NumberWord{1, "yes"} : io::NumberWord{0, "no"};
    }));
    all.push_back(ofMesh("open_edges", [](const MeshInfo& mesh) { return mesh.closedness.open; }));
    all.push_back(ofMesh("edges_of_many", [](const MeshInfo& mesh) { return mesh.closedness.many; }));
    all.push_back(ofMesh("turned_edges", [](const MeshInfo& mesh) { return mesh.closedness.turned; }));
    all.push_back({"hint", hintOf});
    all.push_back(ofVolume("resampled", [](const VolumeInfo& volume) { return resampledCell(volume.isResampled); }));
    all.push_back(ofPair("volume", [](const PairInfo& pair) { return pair.volume; }));
    all.push_back(ofPair("overlap_percent", [](const PairInfo& pair) { return percent(pair.placement.overlap); }));
    all.push_back(ofPair("box_distance", [](const PairInfo& pair) { return rounded(pair.placement.distance); }));
    return all;
}

std::string vectorText(const Vec3& vector, const char* between) {
    return number(rounded(vector[0])) + between + number(rounded(vector[1])) + between + number(rounded(vector[2]));
}

/// "1.2 %"; never rounds to 0 or 100.
std::string percentText(double share) {
    char text[32];
    const double value = share * 100;
    std::snprintf(text, sizeof text, "%.3g %%", value);
    return value > 99.9 && value < 100 ? "more than 99.9 %" : text;
}

std::string boxText(const Box& box) {
    const Vec3 size{box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]};
    return vectorText(box.lo, " ") + " to " + vectorText(box.hi, " ") + " mm: " + vectorText(size, " x ") + " mm";
}

void writeHistogram(std::ostream& out, const std::vector<HistogramBin>& bins) {
    constexpr double kWidth = 40;
    std::uint64_t max = 1;
    std::size_t widest = 0;
    for (const HistogramBin& bin : bins) {
        max = std::max(max, bin.voxels);
        widest = std::max(widest, rangeText(bin).size());
    }
    for (const HistogramBin& bin : bins) {
        const std::string range = rangeText(bin);
        // Most voxels are air: the square root keeps the other bars visible.
        const double share = std::sqrt(static_cast<double>(bin.voxels) / static_cast<double>(max));
        const auto length = static_cast<std::size_t>(std::ceil(share * kWidth));
        out << "    " << std::string(widest - range.size(), ' ') << range << " |" << std::string(length, '#') << ' '
            << withCommas(bin.voxels) << '\n';
    }
}

void writeVolume(std::ostream& out, const VolumeInfo& volume, double threshold) {
    const std::array<std::uint32_t, 3>& size = volume.grid.size;
    out << "  volume       " << size[0] << " x " << size[1] << " x " << size[2] << " voxels, " << toString(volume.type)
        << '\n'
        << "  spacing      " << vectorText(volume.grid.spacing, " x ") << " mm\n"
        << "  orientation  " << volume.towards << " (directions of index x, y, z)";
    if (volume.oblique > 0) {
        char text[32];
        std::snprintf(text, sizeof text, "%.1f", volume.oblique);
        out << ", oblique by up to " << text << " degrees";
    }
    out << "\n  world box    " << boxText(volume.world) << " (LPS)\n"
        << "  values       " << number(volume.values.lo) << " to " << number(volume.values.hi) << ", mean "
        << number(rounded(volume.mean)) << '\n'
        << "  opaque       " << percentText(volume.opaque) << " of the voxels reach the opacity " << number(threshold)
        << "\n  histogram    voxels per bin; bar lengths: square roots\n";
    writeHistogram(out, volume.histogram);
}

void writeMesh(std::ostream& out, const MeshInfo& mesh) {
    const Closedness& edges = mesh.closedness;
    out << "  mesh         " << withCommas(mesh.facts.triangles) << " triangles, " << withCommas(mesh.facts.vertices)
        << " vertices, " << withCommas(edges.parts) << (edges.parts == 1 ? " part" : " parts") << '\n'
        << "  box          " << boxText(mesh.facts.bounds) << '\n'
        << "  closed       ";
    if (edges.closed()) {
        out << "yes\n";
    } else {
        out << "no: " << withCommas(edges.open) << " edges of one triangle, " << withCommas(edges.many)
            << " of more than two\n";
    }
    if (edges.turned > 0) {
        out << "  turned       " << withCommas(edges.turned) << " edges between triangles of opposite winding\n";
    }
    if (!mesh.hint.empty()) {
        out << "  unit         " << mesh.hint << '\n';
    }
}

void writePair(std::ostream& out, const PairInfo& pair) {
    out << "  in           " << escaped(pair.volume) << "\n  overlap      ";
    if (pair.placement.overlap > 0) {
        out << percentText(pair.placement.overlap) << " of the mesh's box is inside\n";
    } else {
        out << "none, the boxes are " << number(rounded(pair.placement.distance)) << " mm apart\n";
    }
    for (const OtherReading& other : pair.others) {
        out << "  or           " << toText(other) << '\n';
    }
}

} // namespace

io::Table infoTable(const std::vector<PathInfo>& paths) {
    std::vector<Column> all = columns();
    io::Table table;
    for (const Column& column : all) {
        table.columns.push_back(column.name);
    }
    table.rows = paths.size();
    table.cell = [all = std::move(all), &paths](std::size_t row, std::size_t column) {
        return all[column].cell(paths[row]);
    };
    table.facts = {{"voxtact", programVersion()}};
    return table;
}

void writeInfoText(std::ostream& out, const std::vector<PathInfo>& paths, double threshold) {
    for (const PathInfo& path : paths) {
        out << (&path == &paths.front() ? "" : "\n") << escaped(path.path) << '\n';
        if (path.volume) {
            writeVolume(out, *path.volume, threshold);
        } else if (path.mesh) {
            writeMesh(out, *path.mesh);
        } else {
            writePair(out, *path.pair);
        }
    }
}

} // namespace voxtact::app
