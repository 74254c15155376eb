// SPDX-License-Identifier: MIT
#include "core/base/refuse.h"
#include "lab/paper/parts.h"

#include "core/base/try.h"
#include "lab/engines/opaque_cells.h"
#include "lab/measure/numbers.h"
#include "lab/measure/poses.h"
#include "voxtact/looks.h"

#include <algorithm>
#include <cmath>

namespace voxtact::lab {

namespace {

namespace fs = std::filesystem;

/// A volume of the paper. Its own files are not to be had: what stands for it is a file of the same size and type or,
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

/// What the ramps make opaque of the two files, counted once: an MR head of the studyforrest project, resampled, and
/// the bonsai of OpenSciVis, pairs of its slices averaged.
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
/// Of the side of a volume: how far beyond it randomPoses() puts a vertex, and a little.
constexpr double kBeyond = 0.11;

struct LoadedVolume {
    std::shared_ptr<VolumePart> part = std::make_shared<VolumePart>();
    double share = 0; ///< of the voxels that are opaque
};

/// The file of a volume or mesh, if --data has it.
std::optional<fs::path> fileOf(const PaperSettings& settings, const char* file) {
    if (settings.data.empty() || file == nullptr) {
        return std::nullopt;
    }
    std::error_code ignored;
    const fs::path path = settings.data / file;
    return fs::exists(path, ignored) ? std::optional(path) : std::nullopt;
}

Result<void> checkData(const PaperSettings& settings) {
    if (settings.data.empty()) {
        return {};
    }
    const bool any =
        fileOf(settings, kVolumes[0].file) || fileOf(settings, kVolumes[1].file) || fileOf(settings, kMeshes[1].file);
    return any ? Result<void>()
               : Error{ErrorCode::File, 0,
                       "--data " + settings.data.string() + ": none of " + kVolumes[0].file + ", " + kVolumes[1].file +
                           ", " + kMeshes[1].file + " is there"};
}

using Histogram = std::array<std::uint64_t, 256>;

Histogram histogramOf(const VolumeData& volume) {
    Histogram histogram{};
    for (const std::byte voxel : volume.voxels) {
        ++histogram[static_cast<std::size_t>(voxel)];
    }
    return histogram;
}

std::vector<ControlPoint> ramp(double begin, double width) {
    return {{begin, 0}, {begin + width, 1}};
}

/// Of all voxels, those that are opaque.
Result<double> opaqueShare(const Histogram& histogram, std::span<const ControlPoint> points) {
    Result<std::vector<float>> table = sampleTable({points});
    VOXTACT_TRY(table);
    const IsOpaque isOpaque(std::move(*table), TransferFunctionDesc{}.domain, kDefaultThreshold);
    std::uint64_t opaque = 0;
    std::uint64_t all = 0;
    for (std::size_t value = 0; value < histogram.size(); ++value) {
        opaque += isOpaque(static_cast<double>(value)) ? histogram[value] : 0;
        all += histogram[value];
    }
    return static_cast<double>(opaque) / static_cast<double>(all);
}

/// A file's own ramp; a builtin's begins where the share is nearest to that of the file.
Result<void> placeRamp(const PaperVolume& volume, bool builtin, LoadedVolume& loaded) {
    const Histogram histogram = histogramOf(loaded.part->data);
    const double first = builtin ? 0 : volume.rampBegin;
    const double last = builtin ? 255 - volume.rampWidth : volume.rampBegin;
    double nearest = 2;
    for (double begin = first; begin <= last; ++begin) {
        std::vector<ControlPoint> points = ramp(begin, volume.rampWidth);
        const Result<double> share = opaqueShare(histogram, points);
        VOXTACT_TRY(share);
        if (std::abs(*share - volume.share) < nearest) {
            nearest = std::abs(*share - volume.share);
            loaded.part->points = std::move(points);
            loaded.share = *share;
        }
    }
    return {};
}

Result<LoadedVolume> loadPaperVolume(const PaperSettings& settings, const PaperVolume& volume) {
    const std::optional<fs::path> file = fileOf(settings, volume.file);
    const std::string source =
        file ? file->string() : volume.builtin + (":" + std::to_string(volume.voxels[0] / settings.scale));
    Result<VolumeData> data = settings.load.volume(source);
    VOXTACT_TRY(data);
    if (file && (data->grid.size != volume.voxels || data->type != ScalarType::UInt8)) {
        return Error{ErrorCode::Format, 0,
                     "'" + source + "' has " + sizeText(data->grid.size) + " voxels of " + toString(data->type) +
                         "; the paper's scenes need " + sizeText(volume.voxels) + " of uint8"};
    }
    LoadedVolume loaded;
    loaded.part->name = file ? file->filename().string() : source;
    loaded.part->data = std::move(*data);
    loaded.part->domain = TransferFunctionDesc{}.domain;
    VOXTACT_TRY(placeRamp(volume, !file, loaded));
    return loaded;
}

Result<std::shared_ptr<MeshPart>> loadPaperMesh(const PaperSettings& settings, const PaperMesh& mesh) {
    const std::optional<fs::path> file = fileOf(settings, mesh.file);
    const std::string source = file ? file->string() : mesh.builtin;
    Result<MeshData> data = settings.load.mesh(source);
    VOXTACT_TRY(data);
    if (data->indices.size() != std::size_t{3} * mesh.triangles) {
        return Error{ErrorCode::Format, 0,
                     "'" + source + "' has " + std::to_string(data->indices.size() / 3) +
                         " triangles; the paper's scenes need " + std::to_string(mesh.triangles)};
    }
    return std::make_shared<MeshPart>(
        MeshPart{.name = file ? file->filename().string() : source, .data = std::move(*data)});
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

Result<PaperInput> makeInput(const PaperSettings& settings, std::string name, const LoadedVolume& volume,
                             const std::shared_ptr<MeshPart>& mesh) {
    const VolumePart& part = *volume.part;
    PaperInput input;
    input.scene.volume = volume.part;
    input.scene.mesh = mesh;
    input.facts = {.name = std::move(name),
                   .volume = part.name,
                   .mesh = mesh->name,
                   .voxels = part.data.grid.size,
                   .voxelType = toString(part.data.type),
                   .triangles = mesh->triangles(),
                   .opaqueShare = volume.share,
                   .opacity = opacityText(part.points),
                   .poses = settings.poses,
                   .step = *std::ranges::min_element(part.data.grid.spacing) / 2};
    Result<View> view = cameraOf(settings, part.data.grid, mesh->data);
    VOXTACT_TRY(view);
    input.scene.view = *view;
    VOXTACT_TRY(chooseTouching(settings.poses, settings.seed, input.facts.name, input.scene));
    return input;
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
            return refuse("--number: of " + std::to_string(tried) + " random poses of " + name + " only " +
                          std::to_string(scene.poses.size()) + " touch in a view of " +
                          std::to_string(scene.view.width) + "x" + std::to_string(scene.view.height) +
                          " pixels (--size)");
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
    std::vector<std::shared_ptr<MeshPart>> meshes;
    for (const PaperMesh& mesh : kMeshes) {
        Result<std::shared_ptr<MeshPart>> loaded = loadPaperMesh(settings, mesh);
        VOXTACT_TRY(loaded);
        meshes.push_back(std::move(*loaded));
    }
    std::vector<PaperInput> inputs;
    for (const PaperVolume& volume : kVolumes) {
        const Result<LoadedVolume> loaded = loadPaperVolume(settings, volume);
        VOXTACT_TRY(loaded);
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            Result<PaperInput> input =
                makeInput(settings, std::string(volume.name) + kMeshes[i].name, *loaded, meshes[i]);
            VOXTACT_TRY(input);
            inputs.push_back(std::move(*input));
        }
    }
    return inputs;
}

} // namespace voxtact::lab
