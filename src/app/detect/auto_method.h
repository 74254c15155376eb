// SPDX-License-Identifier: MIT
#pragma once

#include "app/options/open_session.h"
#include "voxtact/detector.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

/// `--count auto`: the fastest way to count on this machine, measured once and remembered.
namespace voxtact::app {

/// Every method of a device, and the host engine (cpu) as the last, with how fast it was on the same scene.
struct MeasuredMethods {
    std::vector<MethodSpeed> speeds;
    bool fresh = false; ///< measured just now, not remembered
};

/// In the view. From the cache folder of `choice`, or measured and, unless Vulkan is validated, put there. `filter`:
/// nothing is each method's own; the host engine is not measured for hardware.
[[nodiscard]] Result<MeasuredMethods> measuredMethods(const device::Session& session, std::optional<Filter> filter,
                                                      const DeviceChoice& choice);

/// What a method must be able to do to be chosen.
struct AutoLimits {
    std::optional<Filter> filter;
    VkExtent2D size{1, 1};
    bool host = true; ///< the host engine may be chosen
};

/// The fastest trusted method that counts exactly; query-any where there is no other; nothing where there is none.
[[nodiscard]] std::optional<CountingMethod> fastest(std::span<const MethodSpeed> speeds, const AutoLimits& limits,
                                                    const VkExtent2D& maxViewport);

struct AutoChoice {
    CountingMethod method;
    std::string note; ///< what was measured; empty when that was remembered
};

/// fastest() of measuredMethods().
[[nodiscard]] Result<AutoChoice> autoMethod(const device::Session& session, const AutoLimits& limits,
                                            const DeviceChoice& choice);

/// A question in the projection conservative, as far as the choice depends on it.
struct CertifiedAsk {
    bool yesNo = false;
    std::optional<std::uint64_t> pairs{}; ///< nothing: not known, many
    std::uint32_t threads = 0;            ///< of the host; 0: one for each processor
    /// false: compute is taken on a GPU unmeasured, so that processes that share a run choose alike.
    bool measure = true;

    /// Then it is the host's, and no device is opened for it: mostly the host has answered by the time that one is.
    [[nodiscard]] bool isSmall() const { return pairs && *pairs < kManyPairs; }
    static constexpr std::uint64_t kManyPairs = 1024; ///< as many as a submission has
};

/// Whether the device is a GPU that answers in the projection conservative.
[[nodiscard]] bool isCertifyingGpu(const device::Session& session);

/// For the projection conservative, which only compute and cpu do, with the same answers. compute where the host may
/// not be chosen, the host where the device is no such GPU; else whichever answers more pairs per second, measured and
/// remembered as above. The host, with a note, where a GPU cannot be measured or answers otherwise than the host.
[[nodiscard]] Result<AutoChoice> certifiedMethod(const device::Session& session, const AutoLimits& limits,
                                                 const CertifiedAsk& ask, const DeviceChoice& choice);

/// What to say when the host stands in because no device can be used.
[[nodiscard]] std::string noDeviceNote(const Error& reason);

} // namespace voxtact::app
