// SPDX-License-Identifier: MIT
#pragma once

#include "lab/engines/engine.h"
#include "voxtact/render.h"

#include <memory>

namespace voxtact::lab {

/// What an embedder's frame does.
enum class FramePart {
    Rendering, ///< a picture of the volume and of the mesh in it
    Detection, ///< one pair, by one method
    Both,      ///< in one submission; the method `cpu` works while the picture is made
};

/// A frame that is done. Times in ms; nothing where the clock cannot tell, or the part is not in the frame.
struct FrameSample {
    double wall = 0;             ///< from the submission to the end of the wait
    std::optional<double> gpu{}; ///< of the detection where there is nothing else; around everything that was submitted
    std::optional<double> mesh{};
    std::optional<double> volume{};
    std::optional<std::uint64_t> count{};
};

/// Frames as an embedder makes them: a picture and the detection in one command buffer, with the same camera, volume
/// and mesh, recorded anew for each, submitted and waited for. Recording is in none of the times.
/// Copies share it. Thread-safety: none; one thread at a time.
class FrameLoop {
  public:
    /// The parts must be ready, the volume with bricks. `colours` are those of the picture. What it is given must
    /// outlive it.
    [[nodiscard]] static Result<FrameLoop> create(const device::Session& session, const Scene& scene,
                                                  const std::vector<ColourPoint>& colours);

    /// Makes what a method needs; frames with it may then be made.
    [[nodiscard]] Result<void> add(CountingMethod method);
    /// One frame, with the mesh at a pose. The method is not looked at where nothing is detected.
    [[nodiscard]] Result<FrameSample> run(FramePart part, CountingMethod method, const Mat4& world_from_object);

  private:
    struct State;
    explicit FrameLoop(std::shared_ptr<State> state) noexcept : state_(std::move(state)) {}
    std::shared_ptr<State> state_;
};

} // namespace voxtact::lab
