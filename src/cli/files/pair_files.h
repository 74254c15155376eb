// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_run.h"

#include <filesystem>
#include <iosfwd>
#include <span>
#include <string>

/// The files of the subcommands about pairs, other than their table.
namespace voxtact::app {

/// The file of rows in addition to the table of a question: count --triangles, distance --witness, area --triangles.
struct SideFile {
    const char* option = "";
    std::filesystem::path path; ///< empty: not asked for
    void (*header)(std::ostream& out, const PairOptions& options, const PairInputs& inputs) = nullptr;
    bool comesLast = false; ///< written once all rows are known
};
[[nodiscard]] SideFile sideFile(const PairOptions& options);

/// pose,triangle,count; with several meshes or volumes also mesh,volume.
void writeTriangle(std::ostream& out, const PairOptions& options, const Row& row, const TouchedTriangle& touched);

/// Inputs of a file of contacts; `bounds` with --bounds only.
struct ContactList {
    std::span<const KeptContact> contacts;
    std::span<const KeptBounds> bounds;
};

/// The endings of a file of contacts, as a message names them.
[[nodiscard]] std::string contactEndings();
[[nodiscard]] bool isContactEnding(const std::filesystem::path& path);
/// Returns true for .csv and .ply.
[[nodiscard]] bool isWitnessEnding(const std::filesystem::path& path);
/// Writes witness points, in the format of the ending of --witness. CSV:
/// pose,mesh,volume,triangle,mesh_x,...,volume_z,label, then the gradient of the distance, per_x,...,per_rz; with names
/// of labels also label_name. PLY, ASCII: two vertices per pair, on the mesh and in the volume, and an edge between
/// them. World mm.
void writeWitnesses(std::ostream& out, const PairOptions& options, const PairInputs& inputs,
                    std::span<const KeptClosest> kept);
/// pose,mesh,volume,triangle,triangle_area,lower,upper.
void writeTriangleArea(std::ostream& out, const PairOptions& options, const Row& row, const TriangleArea& area);
/// Rounds outward to a millionth of a mm.
[[nodiscard]] Bounds roundedOutward(const Bounds& bounds);
/// Rounds outward to a millionth of a mm^2, or to a hundredth of a small tolerance.
[[nodiscard]] Bounds roundedOutward(const Bounds& bounds, double tolerance);

/// Writes contacts, in the format of the ending of --contacts.
void writeContacts(std::ostream& out, const PairOptions& options, const PairInputs& inputs, const ContactList& list);

/// pose,triangle,x,y,z,nx,ny,nz,depth,value,opacity,label; with names of labels also label_name, with several
/// meshes or volumes also mesh,volume. World mm.
void writeContactsCsv(std::ostream& out, const PairOptions& options, const PairInputs& inputs, const ContactList& list);
/// Writes contacts as points with normals and colours: binary little-endian PLY, in the order of the CSV. mesh and
/// volume are indices, named in comments.
void writeContactsPly(std::ostream& out, const PairOptions& options, const PairInputs& inputs, const ContactList& list);
/// Writes contacts as points with normals for VTK and ParaView, with the boxes of `bounds` as lines: XML PolyData with
/// appended raw arrays. mesh and volume are indices, named in a comment.
void writeContactsVtp(std::ostream& out, const PairOptions& options, const PairInputs& inputs, const ContactList& list);
/// Writes contacts as markups for 3D Slicer: a list of points, and a region of interest per box of `bounds`. LPS.
void writeContactsMarkups(std::ostream& out, const PairOptions& options, const PairInputs& inputs,
                          const ContactList& list);

} // namespace voxtact::app
