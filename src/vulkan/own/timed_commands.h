// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/own/session.h"

#include <memory>
#include <optional>

namespace voxtact::device {

/// A function of the instance's: the one that it gives for a name is the one of that name.
template <class Function> Function instanceFunction(const Session& session, const char* name) {
    return reinterpret_cast<Function>(session.instance.getInstanceProcAddr()(session.instance.handle(), name));
}

/// A command buffer of the session's queue, with a fence and timestamps: recorded again each time, or once and
/// submitted again. Thread-safety: none; one thread at a time.
class TimedCommands {
  public:
    /// With `stamps` timestamps, where the queue has any; 0: none. The device must outlive it.
    [[nodiscard]] static Result<TimedCommands> create(const Session& session, std::uint32_t stamps);
    TimedCommands(TimedCommands&&) noexcept;
    TimedCommands& operator=(TimedCommands&&) noexcept;
    /// Waits for what is in flight.
    ~TimedCommands();

    /// Null where the queue has none.
    [[nodiscard]] VkQueryPool timestamps() const noexcept;

    enum class Use {
        Once,  ///< submitted once, and recorded again
        Again, ///< submitted again and again, when what was submitted before is done
    };
    /// Begins the command buffer again, with no timestamp written.
    [[nodiscard]] Result<VkCommandBuffer> begin(Use use = Use::Once);
    /// Writes a timestamp when all that was recorded before is done.
    void cmdStamp(std::uint32_t number) const;
    [[nodiscard]] Result<void> end();
    [[nodiscard]] Result<void> submit();
    [[nodiscard]] Result<void> wait();
    /// The same, asking again and again instead of sleeping: sooner back, and a core is busy until then.
    [[nodiscard]] Result<void> poll();
    /// Waits for everything on the device, after an error.
    void waitForAll() const;
    /// Time between two timestamps of a completed submission, ms. Nothing where the queue has none, or its
    /// clock went backwards.
    [[nodiscard]] Result<std::optional<double>> between(std::uint32_t from, std::uint32_t to) const;

  private:
    struct State;
    explicit TimedCommands(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

} // namespace voxtact::device
