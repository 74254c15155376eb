// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/context.h"

#include <memory>
#include <string>
#include <vector>

namespace voxtact::test {

struct PretendState;

/// A Vulkan driver without a device and without a compiler: objects are numbers, memory is the host's, and a submission
/// is executed as late as Vulkan allows, when it is waited for. Copies and fills do what they should. A draw or
/// dispatch adds a hash of all that it would read (pipeline, constants, the contents of what is bound) to what its
/// shader would write, so that an answer is the same exactly where everything behind it is.
///
/// Host-visible memory is not coherent, and what was not flushed or invalidated is not seen on the other side. Every
/// misuse that it notices is a complaint: objects that are ended, reset or written while a submission uses them,
/// handles that are nothing, fences that were signalled before they are submitted, waits that would never end, memory
/// of two buffers at once.
///
/// It is the whole loader and driver: no layer, no vkCreateDevice. One at a time in a process.
class PretendDriver {
  public:
    /// What a draw or dispatch adds to the count of a pair.
    enum class Counting {
        Hash,         ///< of all that it reads
        OpaqueVoxels, ///< twice the bytes of the volume that are not 0: what selfTest() expects
    };

    PretendDriver();
    PretendDriver(const PretendDriver&) = delete;
    PretendDriver& operator=(const PretendDriver&) = delete;
    ~PretendDriver();

    [[nodiscard]] static PFN_vkGetInstanceProcAddr getInstanceProcAddr();
    /// With every feature that voxtact can use, and names for objects. Valid as long as the driver.
    [[nodiscard]] ContextDesc contextDesc() const;
    [[nodiscard]] static QueueAccess queueAccess();

    void count(Counting counting) noexcept;
    /// Fragments that a list of survivors has found; there are as many zeros in it as there is room for.
    void trace(std::uint32_t fragments) noexcept;
    /// The size of the heap, 0 at first: every allocation then serves one buffer or image.
    void heap(VkDeviceSize bytes) noexcept;
    /// The device is lost: nothing is in flight any more, and nothing will ever be.
    void lose();
    [[nodiscard]] std::vector<std::string> takeComplaints();

  private:
    std::unique_ptr<PretendState> state_;
};

} // namespace voxtact::test
