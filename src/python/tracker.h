// SPDX-License-Identifier: MIT
#pragma once

#include "scene.h"

#include <memory>

namespace voxtact::python {

/// A mesh that moves in a scene. Calls wait for each other, as those of the scene do.
class Tracker {
  public:
    Tracker(std::shared_ptr<Scene> scene, std::shared_ptr<const Shape> mesh, const cpu::TrackerDesc& desc);
    /// The interpreter's lock must not be held.
    [[nodiscard]] TrackedClearance update(const Mat4& world_from_object);

  private:
    std::shared_ptr<Scene> scene_;
    std::shared_ptr<const Shape> mesh_;
    cpu::ClearanceTracker tracker_; ///< used in the scene's turn alone
};

void defineTracker(py::module_& module);

} // namespace voxtact::python
