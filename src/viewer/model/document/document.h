// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/document/curve.h"
#include "viewer/model/shown/camera.h"
#include "viewer/model/shown/gizmo.h"
#include "voxtact/methods.h"

#include <optional>
#include <string>
#include <vector>

/// Contents of the window as plain data, as in a session file.
namespace voxtact::view {

/// Source of a mesh, as on the command line.
struct MeshSource {
    std::string path;
    std::string space = "lps"; ///< space of its coordinates
    double scale = 1;          ///< mm of its unit
};

/// Sources of volume and meshes, as on the command line.
struct Sources {
    std::string volume;
    std::vector<MeshSource> meshes; ///< all opened meshes, including removed ones, for undo
    std::string labels;             ///< a label map; empty: none
    std::string labelNames;         ///< file of label names; empty: the file next to the label map, if it exists
    std::uint32_t coarser = 1;      ///< each voxel of the shown volume covers this number along each axis
};

/// A mesh and its pose.
struct Instrument {
    std::size_t mesh = 0; ///< number in Sources::meshes, unique
    Mat4 world_from_object = identity();
    bool shown = true; ///< visible in picture and slices; always answered

    [[nodiscard]] bool operator==(const Instrument&) const = default;
};

/// State that commands change, and undo restores.
struct Edit {
    Curve curve;
    std::vector<ColourPoint> colours; ///< of the picture
    double threshold = kDefaultThreshold;
    std::vector<Instrument> instruments{1}; ///< at least one
    std::size_t chosen = 0;                 ///< index of the instrument that moves. Undo restores it, but choosing is
                                            ///< no command
    std::size_t holes = 0;                  ///< number of holes that are drilled, of the known ones

    [[nodiscard]] const Instrument& instrument() const { return instruments[chosen]; }
    /// `world_from_object` of the chosen instrument.
    [[nodiscard]] const Mat4& pose() const { return instruments[chosen].world_from_object; }
    [[nodiscard]] Mat4& pose() { return instruments[chosen].world_from_object; }

    /// Compares edits, but not the chosen instrument.
    [[nodiscard]] bool operator==(const Edit& other) const {
        return threshold == other.threshold && holes == other.holes && instruments == other.instruments &&
               sameCurve(curve, other.curve) && sameColours(colours, other.colours);
    }
};

/// Method of the answer.
struct MethodChoice {
    CountingMethod count = CountingMethod::Cpu;
    Projection projection = Projection::Certified;

    [[nodiscard]] bool operator==(const MethodChoice&) const = default;
};

/// Panes that can have the whole middle of the window.
enum class Maximised { None, Picture, Slice0, Slice1, Slice2 };

/// Colours of the panels.
enum class Theme { Dark, Light };

/// Visible parts and step sizes.
struct Shown {
    GizmoAxes handleAxes = GizmoAxes::World;
    bool handles = true;
    bool contacts = true;
    bool logHistogram = true;
    Maximised maximised = Maximised::None;
    Theme theme = Theme::Dark;
    double stepMillimetres = 1;
    double stepDegrees = 5;
    double drillRadius = 5;                          ///< mm
    std::optional<ValueRange> window = std::nullopt; ///< of the slices: black and white; nothing: all values
};

struct Document {
    Sources sources;
    Edit edit;
    ValueRange domain{0, 255};
    std::uint32_t tableSize = kDefaultTableSize;
    std::vector<Mat4> poses;            ///< the list; may be empty
    std::size_t pose = 0;               ///< pose of the list that was taken last
    std::optional<MethodChoice> method; ///< empty: the machine's default
    std::optional<Camera> camera;       ///< nothing: framing the volume
    std::optional<Shown> shown;         ///< empty: the window's defaults
    std::vector<Ball> holes;            ///< in the order of drilling, at least edit.holes
    std::optional<Vec3> cursor;         ///< world, mm: where the slices are; nothing: the middle of the volume
};

} // namespace voxtact::view
