// SPDX-License-Identifier: MIT
#include "cli/pairs/fit_notes.h"

#include "cli/options/placement.h"
#include "cli/output/size_note.h"
#include "core/base/text.h"
#include "voxtact/data.h"

#include <algorithm>

namespace voxtact::app {

namespace {

/// Maximum notes of a kind.
constexpr std::size_t kMaxNotes = 5;
/// Sampled poses: enough to find the likely space.
constexpr std::size_t kSomePoses = 16;

void addSome(const std::vector<std::string>& some, std::vector<std::string>& notes) {
    for (std::size_t i = 0; i < some.size() && i < kMaxNotes; ++i) {
        notes.push_back(some[i]);
    }
    if (some.size() > kMaxNotes) {
        notes.push_back("and " + std::to_string(some.size() - kMaxNotes) + " more notes of this kind");
    }
}

} // namespace

FitNotes::FitNotes(const PairOptions& options, const PairInputs& inputs)
    : options_(options), inputs_(inputs), near_(options.jobs.jobs.size()), poses_(options.jobs.jobs.size()),
      sizes_(options.jobs.jobs.size()), first_(options.jobs.jobs.size()) {}

void FitNotes::look(const Window& window, const Grid& grid, const OpaqueVoxels& opaque) {
    for (const WindowItem& item : window.items) {
        if (poses_[item.job] == 0) {
            const Box& object = inputs_.bounds[options_.jobs.jobs[item.job].mesh];
            sizes_[item.job] = sizeNote(object, item.poses.front(), grid);
            const std::size_t step = (item.poses.size() + kSomePoses - 1) / kSomePoses;
            First& first = first_[item.job];
            first = {{}, grid, opaque};
            for (std::size_t pose = 0; pose < item.poses.size(); pose += step) {
                first.poses.push_back(item.poses[pose]);
            }
        }
        poses_[item.job] += item.poses.size();
    }
}

void FitNotes::lookAtAnswers(std::span<const Row> rows) {
    for (const Row& row : rows) {
        if (row.timed.answer.hit || row.timed.answer.possible) {
            ++near_[row.job];
            first_[row.job].opaque.reset();
        }
    }
}

void FitNotes::addTo(std::vector<std::string>& notes) const {
    std::vector<std::string> sizes;
    std::vector<std::string> places;
    std::vector<std::string> enclosing;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
        const PairJobs& jobs = options_.jobs;
        const std::string& mesh = jobs.meshes[jobs.jobs[i].mesh];
        const std::string& volume = jobs.volumes[jobs.jobs[i].volume];
        const bool isFar = poses_[i] > 0 && near_[i] == 0 && options_.method.boundary != Boundary::Clamp;
        if (!sizes_[i].empty() && !isFar) {
            sizes.push_back(mesh + " against " + volume + ": the mesh " + sizes_[i]);
        }
        const MeshView shape = inputs_.meshes[jobs.jobs[i].mesh].view();
        if (const std::optional<Vec3> inside =
                first_[i].opaque ? enclosedVoxel(shape, first_[i].poses.front(), *first_[i].opaque) : std::nullopt) {
            enclosing.push_back(mesh + " encloses but does not touch an opaque region of " + volume + ", at (" +
                                number((*inside)[0]) + ", " + number((*inside)[1]) + ", " + number((*inside)[2]) + ")");
        }
        if (isFar) {
            places.push_back(farNote({mesh, options_.meshes, inputs_.bounds[jobs.jobs[i].mesh], first_[i].poses,
                                      options_.view.poses.empty() ? "" : options_.view.posesSpace},
                                     volume, first_[i].grid, poses_[i]));
        }
    }
    addSome(sizes, notes);
    addSome(places, notes);
    addSome(enclosing, notes);
}

} // namespace voxtact::app
