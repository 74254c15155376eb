// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/answers/comparison.h"
#include "viewer/model/answers/live_answer.h"
#include "viewer/model/answers/live_measures.h"
#include "viewer/model/document/carving.h"
#include "viewer/model/document/document.h"
#include "viewer/model/document/history.h"
#include "viewer/model/document/labels.h"
#include "viewer/model/document/pose.h"
#include "viewer/model/document/question.h"
#include "viewer/model/files/loading.h"
#include "viewer/model/shown/gizmo.h"
#include "viewer/model/shown/histogram.h"
#include "viewer/model/shown/keystrokes.h"
#include "viewer/model/shown/pointer.h"
#include "viewer/model/shown/slice.h"
#include "viewer/model/shown/view_cube.h"

#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// State of the panels and frames. No Vulkan or Dear ImGui.
namespace voxtact::view {

/// Initial contents of the window.
struct Given {
    VolumeData volume;
    std::vector<MeshData> meshes; ///< of Sources::meshes
    std::optional<Labels> labels;
    ValueRange values; ///< smallest and largest voxel
    Document document;
    std::uint32_t coarserBy = 1;   ///< Sources::coarser of the volume that is here
    std::vector<std::string> read; ///< paths of poses and transfer functions, which no Sources have
    std::string deviceOption;      ///< as --device was given; for copied commands
    std::string deviceName;        ///< that draws
};

/// Kind of a file for the window.
enum class FileKind { Volume, Mesh, Poses, Function, Session };

/// A document to show next, whose files are not read yet.
struct Wanted {
    FileKind kind = FileKind::Session; ///< Volume: the transfer function is the volume's default
    Document document;
    std::string path; ///< the file that was opened
};

/// A part of the window that shows a picture, in pixels.
struct Pane {
    Extent extent;
    void* texture = nullptr; ///< of the picture that is there
    Point2 corner{0, 0};     ///< upper left, points of the window
    Point2 size{0, 0};       ///< points of the window
};

/// Minimum size of the window, in points.
inline constexpr Extent kLeastWindow{640, 480};

/// A requested picture for a file.
struct Shot {
    std::string path;
    Extent extent; ///< pixels
};

/// Progress of a picture for a file.
struct Saving {
    double share = 0;     ///< of the rows, 0..1
    bool writing = false; ///< completely drawn, being written
};

/// A message to the user: a dialog for errors, the status line for actions.
struct Message {
    std::string text;
    bool error = false;
};

/// A pressed or repeated key, by GLFW's number. A frame may have any number of keys.
struct KeyPress {
    int key = 0;
    bool shift = false;
    bool control = false;
    bool held = false; ///< it repeats
};

/// Refuses an output that is one of these files under any name.
using MayWrite =
    std::function<Result<void>(const std::filesystem::path& output, const std::vector<std::string>& inputs)>;

struct State;
/// Notes on the contents, a sentence each.
using NotesOf = std::function<std::vector<std::string>(const State&)>;

/// A note with a button that shows another document instead: the same files, read in another way.
struct Offer {
    std::string text;
    std::string button;
    Wanted wanted;
};
using OffersOf = std::function<std::vector<Offer>(const State&)>;

/// A held handle, with the state at the time of the press.
struct GizmoDrag {
    Handle handle;
    Gizmo gizmo;
    Mat4 world_from_object{};
    Ray from;
};

struct State {
    using Clock = std::chrono::steady_clock;

    /// No contents yet: no volume, no mesh.
    State() = default;
    explicit State(Given opened);

    /// Passes the window's own state to a State that replaces this one and, for an added mesh or volume, the edits made
    /// meanwhile. New meshes become instruments, by a command; the last of them is chosen.
    void passOn(State& next, std::optional<FileKind> opened);
    /// Returns the initial contents with all edits, to be opened again. Leaves nothing to show.
    [[nodiscard]] Given giveBack();

    /// Call once per frame, after the panels: records changes and their times.
    void update();
    /// Executes a command that undo reverts: `change` gets the edit. `merge`: see History.
    void command(const std::function<void(Edit&)>& change, const std::string& merge = {});
    /// Executes a step of a key or button. Close or `held` steps with the same `merge` are one command.
    void step(const std::function<void(Edit&)>& change, const std::string& merge, bool held = false);
    void undo();
    void redo();
    /// Drills a hole of drillRadius with the image's minimum, as a command. Reports errors.
    void drill(const Vec3& centre);
    /// Takes a pose of the list for the chosen instrument. `held`: see step().
    void takePose(std::size_t number, bool held = false);
    /// Chooses an instrument; ignores an invalid index. This is no command, but moving afterwards is a separate
    /// command.
    void choose(std::size_t number);
    /// Removes an instrument, as a command. Ignores the last one.
    void remove(std::size_t number);
    /// Answer about the chosen instrument; null without one.
    [[nodiscard]] const MeshAnswer* chosenAnswer() const;
    [[nodiscard]] const MeshMeasures* chosenDistance() const;
    /// Since it was made.
    [[nodiscard]] double seconds() const;
    /// True if nothing changed for a moment.
    [[nodiscard]] bool atRest() const;
    /// True if the answer matches the contents, and the fine picture is complete.
    [[nodiscard]] bool settled() const { return answer && answer->revision == revision && fineShare >= 1; }
    /// Returns true if answers of the comparison are pending.
    [[nodiscard]] bool compares() const {
        return comparing && !(comparison.isOf(document.edit) && comparison.complete());
    }
    void say(std::string text) { status = std::move(text); }
    void complain(std::string text) { error = std::move(text); }
    /// Returns the visible values of the curve's chart: a part of the domain.
    [[nodiscard]] ValueRange chartRange() const { return zoomedRange.value_or(document.domain); }
    /// Adds paths dropped on the window, from GLFW.
    void drop(int count, const char* const* paths) { dropped.insert(dropped.end(), paths, paths + count); }
    /// Null where there is no label map.
    [[nodiscard]] const Labels* labelsOrNull() const { return labels ? &*labels : nullptr; }
    /// Refuses the path of a shown file or its source.
    [[nodiscard]] Result<void> checkOutput(const std::filesystem::path& path) const;
    /// Returns the document with the window's own state: camera, method, cursor, holes, and visible parts.
    [[nodiscard]] Document saved() const;

    bool blank = true; ///< nothing to show yet: only the window's own parts count

    // Initial contents
    VolumeData volume;
    std::vector<MeshData> meshes; ///< of Sources::meshes, also those that were removed
    std::optional<Labels> labels;
    ValueRange values;
    std::uint32_t coarserBy = 1;
    std::string deviceOption;
    std::string deviceName;
    std::vector<Box> bounds; ///< of `meshes`, object space
    Mat4 texture_from_world{};
    Histogram histogram;               ///< over the transfer function's domain
    std::vector<MethodChoice> methods; ///< that this machine can do

    // Edited state
    Document document;
    History<Edit> history;
    MethodChoice method;
    Camera camera;
    Vec3 cursor{};
    ValueRange window; ///< of the slices: black and white

    HoleWrites writes; ///< changes of the volume since it was read, for its copies

    // Contents
    std::uint64_t revision = 1;        ///< changes with inputs of the answer
    std::uint64_t pictureRevision = 1; ///< changes with inputs of the large picture
    std::optional<LiveAnswer> answer;
    std::optional<LiveMeasures> distances; ///< of this question or one before
    Comparison comparison;                 ///< of the methods, while `comparing`
    Times times;
    Strip strip; ///< by seconds()
    std::string answeredBy;
    Pane picture;
    std::array<Pane, 3> slices;
    double fineShare = 0; ///< of the fine picture that is there
    Times frameTimes;
    std::uint64_t frame = 0;
    std::string status;
    std::string error;
    NotesOf notesOf;                  ///< empty: no warnings
    std::vector<std::string> notes;   ///< of the current document; while `itemHeld`, of the previous one
    OffersOf offersOf;                ///< empty: none
    std::vector<Offer> offers;        ///< made once for what was opened; none once an instrument moved
    std::optional<Question> question; ///< a dialog, until it is answered
    std::optional<std::string> field; ///< text of the focused path field; null: none
    std::vector<std::string> recent;  ///< files that were opened, the last first
    std::vector<std::string> read;    ///< poses and transfer functions, of all that was opened
    MayWrite mayWrite;                ///< empty: everything may be written

    // State of the panels
    std::vector<KeyPress> keys; ///< since the last frame
    Keystrokes keystrokes;      ///< of texts, that no frame had yet
    Pointer pointer;            ///< pending pointer events
    bool itemHeld = false;      ///< by the mouse or the keyboard, as of the last frame
    bool entered = false;       ///< Enter was pressed since the last frame
    bool escaped = false;       ///< Escape, too
    Maximised maximised = Maximised::None;
    Theme theme = Theme::Dark;
    std::optional<Theme> themeSet; ///< that the panels have; nothing: not known
    bool playing = false;
    bool showContacts = true;
    bool showGizmo = true;
    GizmoAxes gizmoAxes = GizmoAxes::World;
    Handle gizmoHandle; ///< under the pointer, or held
    std::optional<GizmoDrag> gizmoDrag;
    std::optional<ViewCube> cube;           ///< where it is; nothing: the picture is too small
    std::optional<std::size_t> cubeSide;    ///< of kPatientSides, under the pointer
    std::optional<std::size_t> cubePressed; ///< that the left button was pressed on
    std::optional<std::size_t> listedMesh;  ///< the chosen one that the list of meshes was scrolled to
    std::optional<TypedAngles> typedAngles; ///< of the chosen instrument, or one before
    bool helpOpen = false;
    bool comparing = false; ///< the counts of all methods are shown
    bool quit = false;
    double stepMillimetres = 1;
    double stepDegrees = 5;
    double drillRadius = 5;                ///< mm
    std::optional<std::size_t> curvePoint; ///< that is dragged or typed
    bool logHistogram = true;
    std::optional<ValueRange> zoomedRange; ///< of the curve's chart; nothing: all of the domain
    Pane chart;                            ///< where the curve is in the window
    std::optional<Wanted> wanted;          ///< until the window has examined it
    std::vector<std::string> dropped;      ///< paths, since the last frame
    std::vector<std::string> taken; ///< paths of poses and transfer functions that were opened, since the last frame
    std::optional<Shot> shot;       ///< until the window has examined it
    std::optional<Saving> saving;   ///< while a picture for a file is made
    bool cancelSaving = false;      ///< asked for
    std::optional<Loading> loading; ///< while something is
    std::optional<Loading> loaded;  ///< statistics of the last loading
    bool cancelLoading = false;     ///< asked for

  private:
    struct Seen {
        Edit edit;
        MethodChoice method;
        Camera camera;
        Extent extent;
        std::uint64_t answer = 0;
    };
    [[nodiscard]] Shown shown() const;
    void show(const Shown& what);
    void drillAndFill();
    void bringHoles(std::size_t number);
    void addHole(Hole hole, const Ball& ball);
    void placeNewMeshes(std::size_t known);
    void drillAll(const std::vector<Ball>& balls);
    void drillAnew(const std::vector<Ball>& balls);

    Holes holes_;
    std::vector<Ball> balls_; ///< of holes_
    Seen seen_;
    std::uint64_t noted_ = 0; ///< the revision that `notes` are of; 0: of none yet
    Clock::time_point changed_ = Clock::now();
    Clock::time_point begun_ = Clock::now();
    Clock::time_point stepped_; ///< the last step()
};

} // namespace voxtact::view
