// SPDX-License-Identifier: MIT
#include "viewer/main_loop.h"

#include "core/base/guard.h"
#include "core/base/try.h"
#include "viewer/glfw_panels.h"
#include "voxtact/io.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <tuple>

namespace voxtact::view {

namespace {

constexpr double kIdle = 0.15;    // s; answers of the host wake it earlier
constexpr double kLoading = 0.03; // s
constexpr double kBusy = 0.002;   // s

double millisecondsSince(State::Clock::time_point begun) {
    return std::chrono::duration<double, std::milli>(State::Clock::now() - begun).count();
}

VkExtent2D pixelsOf(GLFWwindow* window) {
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

Question coarserQuestion(const Error& error, const Given& given, std::uint32_t factor) {
    Question question;
    question.kind = Question::Kind::Coarser;
    question.title = "The volume is too large";
    const double voxel = *std::ranges::max_element(given.volume.grid.spacing) * factor / given.coarserBy;
    char text[160];
    std::snprintf(text, sizeof text,
                  "A copy that is coarser by %u can be shown instead. It may lose structures thinner than %.3g mm, and "
                  "answers refer to the copy.",
                  factor, voxel);
    question.text = error.text + ".\n\n" + text;
    question.buttons = {"show the coarser copy", "cancel"};
    return question;
}

Question missingQuestion(const std::vector<MissingFile>& files, const std::string& session) {
    Question question;
    question.kind = Question::Kind::Missing;
    question.title = "Files of the session are missing";
    question.text = "'" + session + "' refers to files that do not exist. Enter their new paths.";
    question.files = files;
    question.buttons = {"open", "cancel"};
    return question;
}

} // namespace

MainLoop::MainLoop(GLFWwindow* window, const device::Session& session, State& state, const WindowDesc& desc)
    : window_(window), session_(&session), state_(&state), desc_(&desc), reporter_(desc.reportState),
      recent_(stateFolder().empty() ? std::filesystem::path() : stateFolder() / "recent.json") {}

MainLoop::~MainLoop() {
    if (shooting_) {
        shooting_->cancel = true;
    }
}

Result<void> MainLoop::run(std::function<Result<Given>(Progress&)> first) {
    const Result<VkSurfaceKHR> surface = makeSurface(*session_, window_);
    VOXTACT_TRY(surface);
    Result<std::unique_ptr<Frames>> frames = Frames::create(*session_, *surface);
    VOXTACT_TRY(frames);
    frames_ = std::move(*frames);
    loader_ = std::make_unique<Loader>(*session_, [] { glfwPostEmptyEvent(); });
    state_->recent = recent_.paths();
    state_->mayWrite = desc_->mayWrite;
    state_->notesOf = desc_->notes;
    state_->offersOf = desc_->offers;
    if (first) {
        load(std::move(first), std::nullopt);
    }
    while (!ended()) {
        if (waitForFrame()) {
            VOXTACT_TRY(turn());
        }
    }
    return {};
}

bool MainLoop::ended() const {
    return glfwWindowShouldClose(window_) == GLFW_TRUE || state_->quit ||
           (desc_->frames && state_->frame >= *desc_->frames);
}

bool MainLoop::waitForFrame() {
    const bool still =
        state_->blank || (state_->settled() && !state_->compares() && !state_->playing && !desc_->frames);
    idle_ = still && !state_->loading && !state_->saving;
    if (still) {
        glfwWaitEventsTimeout(idle_ ? kIdle : kLoading);
    } else {
        glfwPollEvents();
    }
    const VkExtent2D pixels = pixelsOf(window_);
    if (pixels.width == 0 || pixels.height == 0) {
        glfwWaitEvents(); // it is not to be seen
        return false;
    }
    if (!frames_->ready()) {
        glfwWaitEventsTimeout(kBusy);
        return false;
    }
    return true;
}

Result<void> MainLoop::turn() {
    State& state = *state_;
    VOXTACT_TRY(takeLoaded());
    VOXTACT_TRY(frames_->collect(state));
    followLoading();
    play();
    VOXTACT_TRY(show());
    tellNotes();
    takeScreenshot();
    VOXTACT_TRY(reporter_.write(state));
    takeChoice();
    keepRecent();
    if (std::exchange(state.cancelLoading, false) && state.loading) {
        loader_->cancel();
        state.loading.reset();
        opening_.clear();
        state.say("cancelled");
    }
    if (state.wanted) {
        open(*std::exchange(state.wanted, std::nullopt));
    }
    return {};
}

/// A lost surface is recreated; the contents stay.
Result<void> MainLoop::show() {
    State& state = *state_;
    const ImDrawData& panels = drawAllPanels(state);
    Result<void> shown = frames_->show(state, panels, pixelsOf(window_));
    if (!shown.ok()) {
        if (shown.error().vkResult != VK_ERROR_SURFACE_LOST_KHR) {
            return shown;
        }
        VOXTACT_TRY(frames_->renewSurface([this] { return makeSurface(*session_, window_); }));
        state.say("the surface of the window was lost and created again");
    }
    const double milliseconds = millisecondsSince(shown_);
    shown_ = Clock::now();
    if (state.blank) {
        return {};
    }
    ++state.frame;
    if (!idle_) {
        state.frameTimes.add(milliseconds);
    }
    return {};
}

/// After loaded data are shown, so that notes refer to all of the window's contents.
void MainLoop::tellNotes() {
    if (std::exchange(untold_, false) && desc_->tell) {
        for (const std::string& note : state_->notes) {
            desc_->tell(note);
        }
    }
}

/// Updates the progress and, until everything is drawn, the frame times.
void MainLoop::followLoading() {
    State& state = *state_;
    if (state.loading && loader_->progress() != nullptr) {
        const Progress::Now now = loader_->progress()->now();
        state.loading->step = now.step;
        state.loading->share = now.share;
    }
    std::optional<Loading>& measured = state.loading ? state.loading : state.loaded;
    if (measured && (state.loading || settling_)) {
        measured->seconds = millisecondsSince(began_) / 1000;
        measured->longestFrame = std::max(measured->longestFrame, millisecondsSince(shown_));
        ++measured->frames;
        settling_ = settling_ && !state.settled();
    }
}

/// The next pose of the list, some a second; the last one ends it.
void MainLoop::play() {
    constexpr double kMilliseconds = 100;
    State& state = *state_;
    if (!state.playing || millisecondsSince(played_) < kMilliseconds) {
        return;
    }
    played_ = Clock::now();
    if (state.document.pose + 1 >= state.document.poses.size()) {
        state.playing = false;
        state.history.end();
        return;
    }
    state.takePose(state.document.pose + 1);
}

/// A picture is rendered between frames, in bands of rows: a large one takes long.
void MainLoop::takeScreenshot() {
    State& state = *state_;
    if (shooting_) {
        shooting_->cancel = shooting_->cancel || std::exchange(state.cancelSaving, false);
        const std::lock_guard lock(shooting_->mutex);
        state.saving = shooting_->done;
        if (!shooting_->written) {
            return;
        }
        tellOfPicture(*shooting_->written, shooting_->shot.path);
        state.saving.reset();
    }
    shooting_.reset();
    state.cancelSaving = false;
    if (!state.shot || state.blank) {
        return;
    }
    shooting_ = std::make_shared<Shooting>();
    shooting_->shot = *std::exchange(state.shot, std::nullopt);
    shooting_->marks = marksOf(state, shooting_->shot.extent);
    std::tie(shooting_->shown, shooting_->renderer) = frames_->screenshot(state, shooting_->shot.extent);
    state.saving = Saving{};
    loader_->run([shooting = shooting_] {
        Result<void> written = shooting->make();
        const std::lock_guard lock(shooting->mutex);
        shooting->written = std::move(written);
        glfwPostEmptyEvent();
    });
}

void MainLoop::tellOfPicture(const Result<void>& written, const std::string& path) {
    if (written.ok()) {
        state_->say("saved the picture as " + path);
    } else if (written.error().code == ErrorCode::Cancelled) {
        state_->say("cancelled; no picture was written");
    } else {
        state_->complain(written.error().text);
    }
}

bool MainLoop::Shooting::tell(bool writing, std::uint32_t rowsDone, std::uint32_t rows) {
    const std::lock_guard lock(mutex);
    done = {static_cast<double>(rowsDone) / rows, writing};
    return !cancel;
}

Result<void> MainLoop::Shooting::make() {
    return guard([this]() -> Result<void> {
        const auto telling = [this](bool writing) {
            return
                [this, writing](std::uint32_t rowsDone, std::uint32_t rows) { return tell(writing, rowsDone, rows); };
        };
        Result<Picture> picture =
            renderer->render(shown.scene, {shot.extent.width, shot.extent.height}, telling(false));
        VOXTACT_TRY(picture);
        paint(marks, *picture);
        return io::writePng(shot.path, picture->width, picture->height, picture->rgba, telling(true));
    });
}

void MainLoop::load(std::function<Result<Given>(Progress&)> read, std::optional<FileKind> opened) {
    State& state = *state_;
    LoadTask task;
    task.read = std::move(read);
    task.opened = opened;
    task.maxSide = desc_->maxSide;
    task.stage.light = desc_->light;
    task.stage.wake = [] { glfwPostEmptyEvent(); };
    if (!state.blank) {
        task.stage.picture = state.picture.extent;
        task.stage.slices = {state.slices[0].extent, state.slices[1].extent, state.slices[2].extent};
    }
    loader_->start(std::move(task));
    state.loading = Loading{};
    state.loaded.reset();
    settling_ = false;
    began_ = Clock::now();
}

/// First asks about a session whose files are missing.
void MainLoop::open(Wanted wanted) {
    if (wanted.kind == FileKind::Session && !(state_->blank && desc_->frames)) {
        const std::vector<MissingFile> files = missingFiles(wanted.document.sources, wanted.path);
        if (!files.empty()) {
            state_->question = missingQuestion(files, wanted.path);
            missing_ = std::move(wanted);
            return;
        }
    }
    opening_ = wanted.path;
    const std::optional<FileKind> kind = wanted.kind;
    load([wanted = std::move(wanted), session = session_,
          read = desc_->open](Progress& progress) { return read(wanted, *session, progress); },
         kind);
}

Result<void> MainLoop::takeLoaded() {
    std::optional<std::variant<Loaded, LoadFailure>> outcome = loader_->take();
    if (!outcome) {
        return {};
    }
    if (auto* const failure = std::get_if<LoadFailure>(&*outcome)) {
        return refuse(std::move(*failure));
    }
    return put(std::get<Loaded>(std::move(*outcome)));
}

Result<void> MainLoop::put(Loaded loaded) {
    State& state = *state_;
    const std::optional<Loading> loading = state.loading;
    const std::optional<Question> question = state.question;
    state.passOn(*loaded.state, loaded.opened);
    Result<std::unique_ptr<Stage>> before = frames_->put(std::move(loaded.stage), *loaded.state);
    VOXTACT_TRY(before);
    if (*before) {
        loader_->discard(std::move(*before));
    }
    // Destroys the old state, which may take long for many voxels.
    auto old = std::make_shared<State>(std::move(state));
    state = std::move(*loaded.state);
    loader_->run([old]() mutable { old.reset(); });
    state.question = question;
    state.loaded = loading;
    settling_ = untold_ = true;
    if (!loaded.opened) { // sources of the command line
        for (const MeshSource& mesh : state.document.sources.meshes) {
            recent_.add(mesh.path);
        }
        recent_.add(state.document.sources.volume);
    }
    recent_.add(std::exchange(opening_, {}));
    state.recent = recent_.paths();
    return {};
}

/// The old contents stay. Without contents, only a choice keeps the window open.
Result<void> MainLoop::refuse(LoadFailure failure) {
    State& state = *state_;
    state.loading.reset();
    if (failure.error.code == ErrorCode::Cancelled) {
        return {};
    }
    // With --frames, there may be no user to choose.
    const bool ends = state.blank && (desc_->frames || (!failure.opened && !failure.tooLarge));
    if (ends || failure.error.code == ErrorCode::DeviceLost) {
        return failure.error;
    }
    if (failure.tooLarge) {
        state.question = coarserQuestion(failure.error, *failure.tooLarge, failure.coarser);
        tooLarge_ = std::move(failure.tooLarge);
        tooLargeOpened_ = failure.opened;
        coarser_ = failure.coarser;
        return {};
    }
    opening_.clear();
    state.say({}); // that it is opened
    state.complain(failure.error.text);
    return {};
}

/// Takes the choice in a question.
void MainLoop::takeChoice() {
    State& state = *state_;
    if (!state.question || !state.question->chosen) {
        return;
    }
    const Question question = *std::exchange(state.question, std::nullopt);
    const bool first = *question.chosen == 0;
    std::unique_ptr<Given> given = std::exchange(tooLarge_, nullptr);
    std::optional<Wanted> wanted = std::exchange(missing_, std::nullopt);
    if (question.kind == Question::Kind::Coarser && first && given) {
        given->document.sources.coarser = coarser_;
        // std::function copies what it holds.
        load([kept = std::shared_ptr<Given>(std::move(given))](Progress&) -> Result<Given> { return std::move(*kept); },
             tooLargeOpened_);
    } else if (question.kind == Question::Kind::Missing && first && wanted) {
        wanted->document.sources = found(wanted->document.sources, question.files);
        open(std::move(*wanted));
    } else if (question.kind == Question::Kind::Lost && !first) {
        state.method = desc_->method(*session_);
    } else if (question.kind == Question::Kind::Coarser) {
        opening_.clear();
    }
}

void MainLoop::keepRecent() {
    State& state = *state_;
    for (const std::string& path : std::exchange(state.taken, {})) {
        recent_.add(path);
        state.recent = recent_.paths();
    }
}

} // namespace voxtact::view
