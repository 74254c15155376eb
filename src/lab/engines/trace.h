// SPDX-License-Identifier: MIT
#pragma once

#include "shared.h"
#include "voxtact/detector.h"

#include <memory>
#include <vector>

namespace voxtact {

/// Lists the surviving fragments of a pair, as the device's rasteriser makes them: what a count is checked with,
/// fragment by fragment, against another rasteriser. Blocks. Needs geometryShader and fragmentStoresAndAtomics.
/// Copies share it. Thread-safety: none; one thread at a time.
class FragmentTrace {
  public:
    [[nodiscard]] static Result<FragmentTrace> create(const Context& context, Filter filter, const QueueAccess& queue);

    /// The survivors of a batch of one pair, sorted by triangle, y and x. OutOfMemory when there are more than the
    /// device can list.
    [[nodiscard]] Result<std::vector<shader::TracedFragment>> survivors(const Batch& batch);

    struct State;

  private:
    explicit FragmentTrace(std::shared_ptr<State> state) noexcept : state_(std::move(state)) {}
    std::shared_ptr<State> state_;
};

} // namespace voxtact
