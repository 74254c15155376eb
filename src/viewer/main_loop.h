// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/frame/frame.h"
#include "viewer/frame/loader.h"
#include "viewer/model/files/state_folder.h"
#include "viewer/panels/marks.h"
#include "viewer/reporter.h"
#include "viewer/window.h"

#include <atomic>

struct GLFWwindow;

namespace voxtact::view {

/// The window, from the creation of its device until it is closed or the device is lost.
class MainLoop {
  public:
    /// Arguments outlive this.
    MainLoop(GLFWwindow* window, const device::Session& session, State& state, const WindowDesc& desc);

    MainLoop(const MainLoop&) = delete;
    MainLoop& operator=(const MainLoop&) = delete;
    /// Cancels loading and saving.
    ~MainLoop();

    /// Shows the data of `first`. Returns DeviceLost if the device is lost; the state then still has its contents.
    [[nodiscard]] Result<void> run(std::function<Result<Given>(Progress&)> first);

  private:
    using Clock = State::Clock;

    /// A pending picture for a file.
    struct Shooting {
        [[nodiscard]] Result<void> make();
        /// Returns true to continue.
        [[nodiscard]] bool tell(bool writing, std::uint32_t rowsDone, std::uint32_t rows);

        Shot shot;
        Marks marks;
        ShownScene shown;
        BlockingRenderer* renderer = nullptr;
        std::atomic<bool> cancel{false};
        std::mutex mutex; ///< protects the members below
        Saving done;
        std::optional<Result<void>> written; ///< when it is done
    };

    [[nodiscard]] bool ended() const;
    /// Sleeps if idle; returns false if no frame can be drawn yet.
    [[nodiscard]] bool waitForFrame();
    [[nodiscard]] Result<void> turn();
    [[nodiscard]] Result<void> show();
    void tellNotes();
    void play();
    void takeScreenshot();
    void tellOfPicture(const Result<void>& written, const std::string& path);

    void load(std::function<Result<Given>(Progress&)> read, std::optional<FileKind> opened);
    void open(Wanted wanted);
    [[nodiscard]] Result<void> takeLoaded();
    [[nodiscard]] Result<void> put(Loaded loaded);
    [[nodiscard]] Result<void> refuse(LoadFailure failure);
    void followLoading();
    void takeChoice();
    void keepRecent();

    GLFWwindow* window_;
    const device::Session* session_;
    State* state_;
    const WindowDesc* desc_;
    std::unique_ptr<Frames> frames_;
    Reporter reporter_;
    RecentFiles recent_;

    Clock::time_point played_ = Clock::now();
    Clock::time_point shown_ = Clock::now();
    Clock::time_point began_{}; ///< the loading
    bool idle_ = false;
    bool untold_ = false;             ///< notes of loaded data are pending
    bool settling_ = false;           ///< loaded data are not completely drawn yet
    std::string opening_;             ///< the file that is being loaded
    std::unique_ptr<Given> tooLarge_; ///< document of a question about a coarser copy
    std::optional<FileKind> tooLargeOpened_;
    std::uint32_t coarser_ = 1;
    std::optional<Wanted> missing_; ///< document of a question about missing files
    std::shared_ptr<Shooting> shooting_;
    std::unique_ptr<Loader> loader_; ///< ends first
};

} // namespace voxtact::view
