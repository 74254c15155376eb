// SPDX-License-Identifier: MIT
#pragma once

#include "fault_table.h"
#include "voxtact/context.h"
#include "vulkan/device_functions.h"

#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace voxtact::test {

/// Where a scenario is played: a driver, and the table above it.
struct Stage {
    FaultTable& faults;
    ContextDesc context; ///< of the table
    QueueAccess queue;
    const DeviceFunctions& below; ///< the driver's own functions, for what the embedder does
};

/// The scenario cannot go on: the device is lost, or what came is wrong and was complained of.
class PlayEnds : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// One pass through a scenario, during which a fault may come. Every call of the library goes through ask().
class Play {
  public:
    explicit Play(const Stage& stage) : stage_(stage) {}

    [[nodiscard]] const Stage& stage() const noexcept { return stage_; }

    /// The value of `ask()`, a Result. Where it fails, the error must be that of the fault and say something; then, of
    /// a lost device, every further call must say so, and of any other fault the same call must succeed.
    template <class Ask> auto ask(const char* what, Ask&& ask) { return askOf(true, what, ask); }
    /// The same of what makes the first thing on a device: nothing is there that could remember its loss.
    template <class Ask> auto askFirst(const char* what, Ask&& ask) { return askOf(false, what, ask); }

    /// The same while nothing fails: for what a scenario needs and another one is about.
    template <class Make> auto quietly(Make&& make) {
        stage_.faults.pause(true);
        auto made = make();
        stage_.faults.pause(false);
        if (!made.ok()) {
            complain("without a fault: " + made.error().text);
            throw PlayEnds(made.error().text);
        }
        if constexpr (!std::is_same_v<decltype(made), Result<void>>) {
            return std::move(*made);
        }
    }

    void complain(const std::string& what) { complaints_.push_back(what); }
    [[nodiscard]] const std::vector<std::string>& complaints() const noexcept { return complaints_; }
    /// The text of the error that the fault became; empty: none came.
    [[nodiscard]] const std::string& error() const noexcept { return error_; }
    [[nodiscard]] bool lost() const noexcept { return lost_; }

  private:
    template <class Ask> auto askOf(bool remembers, const char* what, Ask& ask) {
        auto first = ask();
        if (!first.ok()) {
            expectFault(what, first.error());
            if (lost_ && !remembers) {
                throw PlayEnds("the device is lost");
            }
            first = ask();
            expectAgain(what, first.ok() ? nullptr : &first.error());
        }
        if constexpr (!std::is_same_v<decltype(first), Result<void>>) {
            return std::move(*first);
        }
    }
    void expectFault(const char* what, const Error& error);
    void expectAgain(const char* what, const Error* error);

    const Stage& stage_;
    std::vector<std::string> complaints_;
    std::string error_;
    bool lost_ = false;
};

/// A story of calls, from the first object to the answers.
struct Scenario {
    std::string name;
    /// Returns what came out, as text that is equal where the answers are.
    std::function<std::string(Play&)> run;
    bool countsVoxels = false; ///< see PretendDriver::Counting
    std::uint32_t traced = 3;  ///< see PretendDriver::trace()
    bool keepsObjects = false; ///< that were there before, and those that it makes
};

/// For GoogleTest, which would print its bytes.
inline void PrintTo(const Scenario& scenario, std::ostream* out) {
    *out << scenario.name;
}

} // namespace voxtact::test
