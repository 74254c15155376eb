// SPDX-License-Identifier: MIT
#pragma once

#include "device/session.h"
#include "view/state.h"
#include "voxtact/render.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace voxtact::view {

/// The connection to the display; one at a time in a process, and on its main thread.
class Display {
  public:
    /// Unsupported, with the window system's reason, where there is none.
    [[nodiscard]] static Result<std::unique_ptr<Display>> open();
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;
    ~Display();

    /// What an instance must have to show pictures in a window. Valid as long as this.
    [[nodiscard]] std::vector<const char*> instanceExtensions() const;
    /// The same of a device.
    [[nodiscard]] std::vector<const char*> deviceExtensions() const;

  private:
    Display() = default;
};

struct WindowDesc {
    Extent size{1280, 800};
    std::span<const unsigned char> font; ///< a TrueType file; outlives the window
    Lighting light{};                    ///< of the fine picture
    std::filesystem::path reportState;   ///< a file to write after each answer; empty: none
    std::optional<std::uint64_t> frames; ///< to show before it ends by itself; nothing: until it is closed
    /// Reads the files of a document that is wanted while the window is there.
    std::function<Result<Given>(const Wanted&)> open;
};

/// Shows the window until it is closed. The session was made with the display's extensions.
[[nodiscard]] Result<void> runWindow(const Display& display, const device::Session& session, State& state,
                                     const WindowDesc& desc);

} // namespace voxtact::view
