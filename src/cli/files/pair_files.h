// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_run.h"

#include <filesystem>
#include <iosfwd>
#include <span>
#include <string>

/// Files of the pair subcommands in addition to the table.
namespace voxtact::app {

/// An additional file of rows: count --triangles, distance --witness, area --triangles.
struct SideFile {
    const char* option = "";
    std::filesystem::path path; ///< empty: not requested
    void (*header)(std::ostream& out, const PairOptions& options, const PairInputs& inputs) = nullptr;
    bool comesLast = false; ///< written once all rows are known
};
[[nodiscard]] SideFile sideFile(const PairOptions& options);

/// pose,triangle,count; with several meshes or volumes also mesh,volume.
void writeTriangle(std::ostream& out, const PairOptions& options, const Row& row, const TouchedTriangle& touched);

/// Contents of a file of contacts; `bounds` only with --bounds.
struct ContactList {
    std::span<const KeptContact> contacts;
    std::span<const KeptBounds> bounds;
};

/// Returns the endings of contact files for a message: ".csv, .ply or ...".
[[nodiscard]] std::string contactEndings();
[[nodiscard]] bool isContactEnding(const std::filesystem::path& path);
/// Returns true for .csv and .ply.
[[nodiscard]] bool isWitnessEnding(const std::filesystem::path& path);
/// Writes witness points in the format that the ending of --witness selects. CSV:
/// pose,mesh,volume,triangle,mesh_x,...,volume_z,label, then the gradient of the distance, per_x,...,per_rz; with names
/// of labels also label_name. PLY, ASCII: two vertices per pair, on the mesh and in the volume, and an edge between
/// them. World mm.
void writeWitnesses(std::ostream& out, const PairOptions& options, const PairInputs& inputs,
                    std::span<const KeptClosest> kept);
/// pose,mesh,volume,triangle,triangle_area,lower,upper: a row of the table "triangles" of a question that measures.
void writeTriangle(std::ostream& out, const PairOptions& options, const Row& row, const AnswerTable& triangles,
                   std::size_t number);
/// Returns true if the answers of a question have witness points.
[[nodiscard]] bool hasWitness(const NamedQuestion& question) noexcept;
/// Rounds outward to a millionth of a unit, or to a hundredth of a small tolerance.
[[nodiscard]] Bounds roundedOutward(const Bounds& bounds, const PairOptions& options);

/// Writes contacts in the format that the ending of --contacts selects.
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
