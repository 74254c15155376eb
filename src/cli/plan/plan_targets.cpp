// SPDX-License-Identifier: MIT
#include "cli/options/inputs.h"
#include "cli/output/text_for_messages.h"
#include "cli/plan/plan_run.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "voxtact/io.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace voxtact::app {

namespace {

/// Returns the centre of the label's voxel that is nearest to the mean of all its voxels, so that it lies in the label.
Vec3 centreOf(const LabelData& labels, std::int32_t label) {
    const auto& size = labels.grid.size;
    std::vector<Vec3> voxels;
    Vec3 sum{};
    std::size_t at = 0;
    for (std::uint32_t z = 0; z < size[2]; ++z) {
        for (std::uint32_t y = 0; y < size[1]; ++y) {
            for (std::uint32_t x = 0; x < size[0]; ++x, ++at) {
                if (labels.values[labels.indices[at]] == label) {
                    voxels.push_back(
                        transformPoint(worldFromIndex(labels.grid),
                                       {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        sum[axis] += voxels.back()[axis];
                    }
                }
            }
        }
    }
    for (double& component : sum) {
        component /= static_cast<double>(voxels.size());
    }
    const auto far = [&](const Vec3& voxel) {
        return std::hypot(voxel[0] - sum[0], voxel[1] - sum[1], voxel[2] - sum[2]);
    };
    return *std::min_element(voxels.begin(), voxels.end(),
                             [&](const Vec3& a, const Vec3& b) { return far(a) < far(b); });
}

bool isInside(const Grid& grid, const Vec3& world) {
    const Result<Mat4> texture = textureFromWorld(grid);
    const Vec3 at = texture.ok() ? transformPoint(*texture, world) : Vec3{-1, -1, -1};
    return std::all_of(at.begin(), at.end(), [](double one) { return one >= 0 && one <= 1; });
}

/// Collects targets and checks their names.
class TargetList {
  public:
    explicit TargetList(const PlanInputs& inputs) : inputs_(inputs) {}

    /// An empty name becomes the number of the target. `option`: for messages.
    [[nodiscard]] Result<void> add(const std::string& option, std::string name, const Vec3& at) {
        const Grid& grid = inputs_.head->volume.grid();
        if (!isInside(grid, at)) {
            const Mat4 box = worldFromTexture(grid);
            return badArgument(option + ": " + pointText(at) + " is outside the volume, whose opposite corners are " +
                               pointText(transformPoint(box, {0, 0, 0})) + " and " +
                               pointText(transformPoint(box, {1, 1, 1})));
        }
        if (name.empty()) {
            name = std::to_string(list_.size() + 1);
        }
        if (!names_.insert(name).second) {
            return badArgument(option + ": the target " + forMessage(name) +
                               " exists already; leave out or rename one of the two in a file of --targets");
        }
        list_.push_back({std::move(name), at});
        return {};
    }
    [[nodiscard]] Result<void> addLabel(const std::string& option, const LabelWord& word) {
        const Result<std::int32_t> label = labelOf(*inputs_.labels, word, option);
        VOXTACT_TRY(label);
        return add(option, labelName(inputs_.labels->names, *label), centreOf(inputs_.labels->labels, *label));
    }
    [[nodiscard]] std::vector<PlanTarget> list() && { return std::move(list_); }

  private:
    static std::string pointText(const Vec3& at) {
        return "(" + number(at[0]) + ", " + number(at[1]) + ", " + number(at[2]) + ")";
    }

    const PlanInputs& inputs_;
    std::vector<PlanTarget> list_;
    std::set<std::string> names_;
};

Result<void> readTargetFile(const PlanOptions& options, TargetList& targets) {
    const std::filesystem::path& path = options.targetFile;
    const std::optional<io::MeshSpace> space = options.space == "ras"   ? std::optional(io::MeshSpace::RAS)
                                               : options.space == "lps" ? std::optional(io::MeshSpace::LPS)
                                                                        : std::nullopt;
    const Result<std::vector<io::NamedPoint>> points = io::readPoints(path, space);
    VOXTACT_TRY(points);
    const std::string at = path.extension() == ".json" ? " point " : " line ";
    for (const io::NamedPoint& point : *points) {
        VOXTACT_TRY(targets.add("--targets: " + forMessage(path.string()) + at + std::to_string(point.line), point.name,
                                point.position));
    }
    return {};
}

} // namespace

std::optional<Vec3> parsePoint(const std::string& text) {
    Vec3 out{};
    std::size_t from = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t comma = text.find(',', from);
        if ((comma == std::string::npos) != (axis == 2)) {
            return {};
        }
        const std::optional<double> read = parseFinite(std::string_view(text).substr(from, comma - from));
        if (!read) {
            return {};
        }
        out[axis] = *read;
        from = comma + 1;
    }
    return out;
}

Result<void> readTargets(const PlanOptions& options, PlanInputs& inputs) {
    TargetList targets(inputs);
    for (const std::string& text : options.targets) {
        if (const std::optional<Vec3> given = parsePoint(text)) {
            VOXTACT_TRY(targets.add("--target", "", lpsFrom(options.space, *given)));
        } else if (!inputs.labels) {
            return badArgument("--target: " + forMessage(text) +
                               " is not a point x,y,z; add --labels to use label names");
        } else if (const Result<void> label = targets.addLabel("--target", text); !label.ok()) {
            return text.find(',') == std::string::npos
                       ? label.error()
                       : badArgument("--target: " + forMessage(text) + " is neither a point x,y,z nor a label");
        }
    }
    if (!options.targetLabels.empty() && !inputs.labels) {
        return badArgument("--target-label: it needs a label map; add --labels");
    }
    for (const LabelWord& word : options.targetLabels) {
        VOXTACT_TRY(targets.addLabel("--target-label", word));
    }
    if (!options.targetFile.empty()) {
        VOXTACT_TRY(readTargetFile(options, targets));
    }
    inputs.targets = std::move(targets).list();
    return {};
}

} // namespace voxtact::app
