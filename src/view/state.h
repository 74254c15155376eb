// SPDX-License-Identifier: MIT
#pragma once

#include "view/model/carving.h"
#include "view/model/document.h"
#include "view/model/gizmo.h"
#include "view/model/history.h"
#include "view/model/labels.h"
#include "view/model/live_answer.h"
#include "view/model/live_clearance.h"
#include "view/model/slice.h"

#include <array>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// What the panels read and write, and the frames show. Neither Vulkan nor Dear ImGui.
namespace voxtact::view {

/// What the window is opened with.
struct Given {
    VolumeData volume;
    MeshData mesh;
    std::optional<Labels> labels;
    ValueRange values; ///< smallest and largest voxel
    Document document;
    std::string deviceOption; ///< as --device was given; for copied commands
    std::string deviceName;   ///< that draws
};

/// What a file can be to the window.
enum class FileKind { Volume, Mesh, Poses, Function, Session };

/// A document that is to be shown instead, whose files are not read yet.
struct Wanted {
    FileKind kind = FileKind::Session; ///< Volume: the transfer function is that which the volume has by itself
    Document document;
};

/// A part of the window that shows a picture, in pixels.
struct Pane {
    Extent extent;
    void* texture = nullptr; ///< of the picture that is there
    Point2 corner{0, 0};     ///< upper left, points of the window
    Point2 size{0, 0};       ///< points of the window
    Point2 used{1, 1};       ///< the part of the texture that it takes up
};

/// Panes that can have the whole middle of the window.
enum class Maximised { None, Picture, Slice0, Slice1, Slice2 };

/// A line for the person who looks: a dialog for errors, the status line for what was done.
struct Message {
    std::string text;
    bool error = false;
};

/// A key that was pressed, or repeats, as GLFW numbers it. However many there are in a frame, none is lost.
struct KeyPress {
    int key = 0;
    bool shift = false;
    bool control = false;
};

/// A handle that is held, and what was there when it was taken.
struct GizmoDrag {
    Handle handle;
    Gizmo gizmo;
    Mat4 world_from_object{};
    Ray from;
};

struct State {
    using Clock = std::chrono::steady_clock;

    explicit State(Given opened);

    /// Once a frame, after the panels: whether something changed, and when.
    void update();
    /// A command that undo takes back: `change` gets the edit. `merge`: see History.
    void command(const std::function<void(Edit&)>& change, const std::string& merge = {});
    void undo();
    void redo();
    /// Drills a hole of drillRadius, with the image's smallest value. A command; what cannot be is complained of.
    void drill(const Vec3& centre);
    /// Takes a pose of the list.
    void takePose(std::size_t number);
    /// Nothing was changed for a moment.
    [[nodiscard]] bool atRest() const;
    /// The answer is of what is shown, and the fine picture is there.
    [[nodiscard]] bool settled() const { return answer && answer->revision == revision && fineShare >= 1; }
    void say(std::string text) { status = std::move(text); }
    void complain(std::string text) { error = std::move(text); }
    /// Null where there is no label map.
    [[nodiscard]] const Labels* labelsOrNull() const { return labels ? &*labels : nullptr; }
    /// The document with what the window has of its own: camera, method and cursor.
    [[nodiscard]] Document saved() const;

    // What it was opened with.
    VolumeData volume;
    MeshData mesh;
    std::optional<Labels> labels;
    ValueRange values;
    std::string deviceOption;
    std::string deviceName;
    Mat4 texture_from_world{};
    std::vector<std::uint64_t> histogram; ///< over the transfer function's domain
    std::vector<MethodChoice> methods;    ///< that this machine can do

    // What is edited.
    Document document;
    History<Edit> history;
    MethodChoice method;
    Camera camera;
    Vec3 cursor{};
    ValueRange window; ///< of the slices: black and white

    std::vector<HoleWrite> writes; ///< to the volume, all since it was read, for those who have copies of it

    // What is shown.
    std::uint64_t revision = 1;        ///< of what an answer depends on
    std::uint64_t pictureRevision = 1; ///< of what the large picture depends on
    std::optional<LiveAnswer> answer;
    std::optional<LiveClearance> clearance; ///< of this question or one before
    Times times;
    std::string answeredBy;
    Pane picture;
    std::array<Pane, 3> slices;
    double fineShare = 0; ///< of the fine picture that is there
    Times frameTimes;
    std::uint64_t frame = 0;
    std::string status;
    std::string error;

    // What the panels have of their own.
    std::vector<KeyPress> keys; ///< since the last frame
    Maximised maximised = Maximised::None;
    bool playing = false;
    bool showContacts = true;
    bool showGizmo = true;
    GizmoAxes gizmoAxes = GizmoAxes::World;
    Handle gizmoHandle; ///< under the pointer, or held
    std::optional<GizmoDrag> gizmoDrag;
    bool helpOpen = false;
    bool quit = false;
    double stepMillimetres = 1;
    double stepDegrees = 5;
    double drillRadius = 5;                ///< mm
    std::optional<std::size_t> curvePoint; ///< that is dragged or typed
    bool logHistogram = true;
    std::optional<Wanted> wanted;     ///< until the window has looked at it
    std::vector<std::string> dropped; ///< paths, since the last frame
    std::string screenshot;           ///< a path, while one is asked for

  private:
    struct Seen {
        Edit edit;
        MethodChoice method;
        Camera camera;
        Extent extent;
        std::uint64_t answer = 0;
    };
    void drillAndFill();

    Holes holes_;
    Seen seen_;
    Clock::time_point changed_ = Clock::now();
};

} // namespace voxtact::view
