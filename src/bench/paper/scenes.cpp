// SPDX-License-Identifier: MIT
#include "bench/paper/parts.h"
#include "core/base/refuse.h"

#include "bench/measure/numbers.h"
#include "cli/make/poses.h"
#include "core/base/try.h"
#include "core/transfer/opaque_intervals.h"
#include "voxtact/looks.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::lab {

namespace {

namespace fs = std::filesystem;

/// A volume of the paper. Its own files are not available: what stands for it is a file of the same size and type or,
/// where there is none, a builtin with as large a share of opaque voxels as its histogram allows.
struct PaperVolume {
    const char* name;
    const char* file; ///< in --data
    std::array<std::uint32_t, 3> voxels;
    const char* builtin;
    double rampBegin; ///< of the file: opacity 0, and 1 a width further on
    double rampWidth;
    double share; ///< of the file's voxels that this ramp makes opaque at the threshold
};

/// Shares of opaque voxels in the two files under the ramps: an MR head of the studyforrest project, resampled, and the
/// bonsai of OpenSciVis, pairs of its slices averaged.
constexpr double kHeadShare = 0.1495;
constexpr double kBonsaiShare = 0.0743;
constexpr std::array<PaperVolume, 2> kVolumes{
    {{"v1", "volumes/mrhead_256.nii.gz", {256, 256, 256}, "builtin:head", 40, 40, kHeadShare},
     {"v2", "volumes/bonsai_256x256x128.nrrd", {256, 256, 128}, "builtin:vessels", 50, 50, kBonsaiShare}}};

/// A mesh of the paper.
struct PaperMesh {
    const char* name;
    const char* file; ///< in --data; null: always the builtin
    std::uint32_t triangles;
    const char* builtin;
};

constexpr std::array<PaperMesh, 2> kMeshes{{{"s1", nullptr, 3068, "builtin:scalpel:3068"},
                                            {"s2", "meshes/armadillo_49998.ply", 49998, "builtin:ellipsoid:49998"}}};

/// Random poses that are tried for one that touches.
constexpr std::uint32_t kTries = 64;
/// Maximum distance of a vertex of randomPoses() beyond the volume, relative to its side, plus a margin.
constexpr double kBeyond = 0.11;

/// Source of a volume or mesh of the paper.
struct Source {
    std::string path; ///< or builtin:NAME
    std::string name; ///< a file's alone
    bool isFile = false;
};

/// The file, if --data has it.
Source sourceOf(const PaperSettings& settings, const char* file, const std::string& builtin) {
    const fs::path path = settings.data.empty() || file == nullptr ? fs::path() : settings.data / file;
    std::error_code ignored;
    return !path.empty() && fs::exists(path, ignored) ? Source{path.string(), path.filename().string(), true}
                                                      : Source{builtin, builtin};
}

Result<void> checkData(const PaperSettings& settings) {
    const char* const files[] = {kVolumes[0].file, kVolumes[1].file, kMeshes[1].file};
    const auto isThere = [&](const char* file) { return sourceOf(settings, file, {}).isFile; };
    if (settings.data.empty() || std::ranges::any_of(files, isThere)) {
        return {};
    }
    return Error{
        ErrorCode::File, 0,
        concat("--data ", settings.data.string(), ": none of ", files[0], ", ", files[1], ", ", files[2], " exists")};
}

using Histogram = std::array<std::uint64_t, 256>;

/// Returns the share of opaque voxels.
double opaqueShare(const Histogram& histogram, std::span<const ControlPoint> points) {
    const OpaqueIntervals intervals(points, kDefaultThreshold);
    std::uint64_t opaque = 0;
    std::uint64_t all = 0;
    for (std::size_t value = 0; value < histogram.size(); ++value) {
        const auto at = static_cast<double>(value);
        opaque += intervals.contain(at, at) ? histogram[value] : 0;
        all += histogram[value];
    }
    return static_cast<double>(opaque) / static_cast<double>(all);
}

/// A file's own ramp; a builtin's begins where the share of opaque voxels is nearest to that of the file. Returns it.
Result<double> placeRamp(const PaperVolume& volume, bool builtin, VolumePart& part) {
    Histogram histogram{};
    for (const std::byte voxel : part.data.voxels) {
        ++histogram[static_cast<std::size_t>(voxel)];
    }
    const double first = builtin ? 0 : volume.rampBegin;
    const double last = builtin ? 255 - volume.rampWidth : volume.rampBegin;
    double nearest = 2;
    for (double begin = first; begin <= last; ++begin) {
        std::vector<ControlPoint> points{{begin, 0}, {begin + volume.rampWidth, 1}};
        const Result<double> share = opaqueShare(histogram, points);
        VOXTACT_TRY(share);
        if (std::abs(*share - volume.share) < std::abs(nearest - volume.share)) {
            nearest = *share;
            part.points = std::move(points);
        }
    }
    return nearest;
}

/// Returns the share of its voxels that are opaque.
Result<double> loadPaperVolume(const PaperSettings& settings, const PaperVolume& volume, VolumePart& part) {
    const Source source =
        sourceOf(settings, volume.file, concat(volume.builtin, ":", volume.voxels[0] / settings.scale));
    VOXTACT_TRY(put(settings.load.volume(source.path), part.data));
    if (source.isFile && (part.data.grid.size != volume.voxels || part.data.type != ScalarType::UInt8)) {
        return Error{ErrorCode::Format, 0,
                     concat("'", source.path, "' has ", sizeText(part.data.grid.size), " voxels of ",
                            toString(part.data.type), "; the paper's scenes need ", sizeText(volume.voxels),
                            " of uint8")};
    }
    part.name = source.name;
    part.domain = {0, 255};
    return placeRamp(volume, !source.isFile, part);
}

Result<void> loadPaperMesh(const PaperSettings& settings, const PaperMesh& mesh, MeshPart& part) {
    const Source source = sourceOf(settings, mesh.file, mesh.builtin);
    VOXTACT_TRY(put(settings.load.mesh(source.path), part.data));
    part.name = source.name;
    return part.triangles() == mesh.triangles && part.data.indices.size() % 3 == 0
               ? Result<void>()
               : Error{ErrorCode::Format, 0,
                       concat("'", source.path, "' has ", part.triangles(), " triangles; the paper's scenes need ",
                              mesh.triangles)};
}

/// From the front; deep enough for the mesh at every pose that can be.
Result<View> cameraOf(const PaperSettings& settings, const Grid& grid, const MeshData& mesh) {
    const Result<MeshFacts> facts = checkMesh(mesh.view());
    VOXTACT_TRY(facts);
    Box box =
        transformBox(worldFromTexture(grid), {{-kBeyond, -kBeyond, -kBeyond}, {1 + kBeyond, 1 + kBeyond, 1 + kBeyond}});
    const double longest =
        std::hypot(facts->bounds.hi[0] - facts->bounds.lo[0], facts->bounds.hi[1] - facts->bounds.lo[1],
                   facts->bounds.hi[2] - facts->bounds.lo[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] -= longest;
        box.hi[axis] += longest;
    }
    return View{viewFrom({}, grid, box, settings.size.width, settings.size.height), settings.size.width,
                settings.size.height};
}

/// Creates the input of a scene with loaded parts; `share` of the voxels are opaque.
Result<PaperInput> makeInput(const PaperSettings& settings, std::string name, double share, Scene scene) {
    const VolumePart& volume = *scene.volume;
    VOXTACT_TRY(put(cameraOf(settings, volume.data.grid, scene.mesh->data), scene.view));
    VOXTACT_TRY(chooseTouching(settings.poses, settings.seed, name, scene));
    return PaperInput{{.name = std::move(name),
                       .volume = volume.name,
                       .mesh = scene.mesh->name,
                       .voxels = volume.data.grid.size,
                       .voxelType = toString(volume.data.type),
                       .triangles = scene.mesh->triangles(),
                       .opaqueShare = share,
                       .opacity = opacityText(volume.points),
                       .poses = settings.poses,
                       .step = *std::ranges::min_element(volume.data.grid.spacing) / 2},
                      std::move(scene)};
}

} // namespace

Result<void> chooseTouching(std::uint32_t count, std::uint64_t seed, const std::string& name, Scene& scene) {
    scene.poses.clear();
    scene.poseNumbers.clear();
    VOXTACT_TRY(makeHost(*scene.volume));
    VOXTACT_TRY(makeReady(nullptr, *scene.mesh));
    const MadeEngine yesNo = makeHostEngine({.stopAtFirst = true});
    VOXTACT_TRY(yesNo);
    const std::uint64_t most = std::min<std::uint64_t>(std::uint64_t{kTries} * count, UINT32_MAX);
    std::uint64_t end = count;
    for (std::uint64_t tried = 0; scene.poses.size() < count; tried = end, end = std::min(2 * end, most)) {
        if (tried == most) {
            return refuse(concat("--number: of ", tried, " random poses of ", name, " only ", scene.poses.size(),
                                 " touch in a view of ", scene.view.width, "x", scene.view.height, " pixels (--size)"));
        }
        const std::vector<Mat4> all =
            randomPoses(scene.volume->data.grid, scene.mesh->data.view(), static_cast<std::uint32_t>(end), seed);
        const std::span<const Mat4> fresh = std::span(all).subspan(tried);
        const Result<Pass> pass = yesNo->run(Work(scene).at(fresh), {});
        VOXTACT_TRY(pass);
        for (std::size_t i = 0; i < fresh.size() && scene.poses.size() < count; ++i) {
            if (pass->pairs[i].hit) {
                scene.poseNumbers.push_back(static_cast<std::uint32_t>(scene.poses.size()));
                scene.poses.push_back(fresh[i]);
            }
        }
    }
    return {};
}

Result<std::vector<PaperInput>> loadPaperScenes(const PaperSettings& settings) {
    VOXTACT_TRY(checkData(settings));
    std::array<std::shared_ptr<MeshPart>, kMeshes.size()> meshes;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        meshes[i] = std::make_shared<MeshPart>();
        VOXTACT_TRY(loadPaperMesh(settings, kMeshes[i], *meshes[i]));
    }
    std::vector<PaperInput> inputs;
    for (const PaperVolume& volume : kVolumes) {
        const auto part = std::make_shared<VolumePart>();
        const Result<double> share = loadPaperVolume(settings, volume, *part);
        VOXTACT_TRY(share);
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            Result<PaperInput> input = makeInput(settings, std::string(volume.name) + kMeshes[i].name, *share,
                                                 {part, meshes[i], {}, {}, {}, {}});
            VOXTACT_TRY(input);
            inputs.push_back(std::move(*input));
        }
    }
    return inputs;
}

} // namespace voxtact::lab
