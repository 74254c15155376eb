// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/files/progress.h"
#include "viewer/state.h"
#include "voxtact/render.h"
#include "vulkan/own/session.h"

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
    /// Returns Unsupported, with the window system's reason, without a display.
    [[nodiscard]] static Result<std::unique_ptr<Display>> open();
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;
    ~Display();

    /// Returns the instance extensions for a window. Valid as long as this.
    [[nodiscard]] std::vector<const char*> instanceExtensions() const;
    /// Returns the device extensions for a window.
    [[nodiscard]] std::vector<const char*> deviceExtensions() const;

  private:
    Display() = default;
};

struct WindowDesc {
    Extent size{1280, 800};
    std::span<const unsigned char> font;        ///< a TrueType file; outlives the window
    std::function<Lighting(const Grid&)> light; ///< of the fine picture of a volume
    MayWrite mayWrite;                          ///< of all that is saved
    NotesOf notes;                              ///< notes on the contents; may be empty
    OffersOf offers;                            ///< buttons below the notes; may be empty
    /// Also receives the notes of opened files.
    std::function<void(const std::string& note)> tell;
    std::filesystem::path reportState;   ///< a file to write after each answer; empty: none
    std::optional<std::uint64_t> frames; ///< frames to show; empty: until it is closed
    std::uint32_t maxSide = 0;           ///< voxels along a side of a volume; 0: what the device takes

    /// Creates a drawing device with the display's extensions; called again after a loss.
    std::function<Result<std::unique_ptr<device::Session>>()> session;
    /// Initial contents; empty if `opened` is set. An error ends the window.
    std::function<Result<Given>(const device::Session&, Progress&)> first;
    /// Session to open at start, like from the menu.
    std::optional<Wanted> opened;
    /// Reads the files of a requested document.
    std::function<Result<Given>(const Wanted&, const device::Session&, Progress&)> open;
    /// Returns the default method of a device.
    std::function<MethodChoice(const device::Session&)> method;
};

/// Shows the window until it is closed.
[[nodiscard]] Result<void> runWindow(const Display& display, const WindowDesc& desc);

} // namespace voxtact::view
