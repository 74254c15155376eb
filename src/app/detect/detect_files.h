// SPDX-License-Identifier: MIT
#pragma once

#include "app/detect/detect_run.h"

#include <filesystem>
#include <iosfwd>
#include <span>
#include <string>

/// The files of `voxtact detect` beside its table.
namespace voxtact::app {

/// pose,triangle,count; with several jobs also mesh,volume, and with --jobs also job.
void writeTriangleHeader(std::ostream& out, const DetectOptions& options);
void writeTriangle(std::ostream& out, const DetectOptions& options, const Row& row, const TouchedTriangle& touched);

/// What there is for a file of contacts; `bounds` with --bounds only.
struct ContactList {
    std::span<const KeptContact> contacts;
    std::span<const KeptBounds> bounds;
};

/// The endings of a file of contacts, as a message names them.
[[nodiscard]] std::string contactEndings();
[[nodiscard]] bool isContactEnding(const std::filesystem::path& path);
/// What a file of closest points says of a pair.
struct KeptClosest {
    ClosestPoints closest;
    ClearanceBounds bounds;
    std::uint32_t job = 0;
    std::uint64_t pose = 0;
};

/// .csv or .ply.
[[nodiscard]] bool isClosestEnding(const std::filesystem::path& path);
/// By the ending of --closest. CSV: pose,mesh,volume,triangle,mesh_x,...,volume_z,label, then how the clearance changes
/// with the pose, per_x,...,per_rz; with names of labels also label_name, and with --jobs also job. PLY, ASCII: two
/// vertices per pair, on the mesh and in the volume, and an edge between them. World, mm.
void writeClosest(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
                  std::span<const KeptClosest> kept);

/// The two parts of the CSV.
void writeClosestHeader(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs);
void writeClosestRows(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
                      std::span<const KeptClosest> kept);

/// pose,mesh,volume,label,name,clearance_lo,clearance_hi; with --jobs also job.
void writeLabelClearanceHeader(std::ostream& out, const DetectOptions& options);
void writeLabelClearance(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs, const Row& row,
                         const LabelClearance& clearance);
/// pose,mesh,volume,label,name,area_lo,area_hi; with --jobs also job.
void writeLabelAreaHeader(std::ostream& out, const DetectOptions& options);
void writeLabelArea(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs, const Row& row,
                    const LabelArea& area);
/// pose,mesh,volume,triangle,triangle_area,area_lo,area_hi; with --jobs also job.
void writeTriangleAreaHeader(std::ostream& out, const DetectOptions& options);
void writeTriangleArea(std::ostream& out, const DetectOptions& options, const Row& row, const TriangleArea& area);
/// Rounded to a millionth of a mm, down or up, so that they stay bounds.
[[nodiscard]] ClearanceBounds roundedOutward(const ClearanceBounds& bounds);
/// Rounded in the same way to a millionth of a mm^2, or to a hundredth of a small tolerance.
[[nodiscard]] AreaBounds roundedOutward(const AreaBounds& bounds, double tolerance);

/// By the ending of --contacts.
void writeContacts(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
                   const ContactList& list);

/// pose,triangle,x,y,z,nx,ny,nz,depth,value,opacity,label; with names of labels also label_name, with several jobs also
/// mesh,volume, and with --jobs also job. World, mm.
void writeContactsCsv(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
                      const ContactList& list);
/// The same as points with normals and colours: binary little-endian PLY, in the order of the CSV. mesh and volume are
/// numbers, which comments name.
void writeContactsPly(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
                      const ContactList& list);
/// As points with their normals for VTK and ParaView, with the boxes of `bounds` as lines: XML PolyData with appended
/// raw arrays. mesh and volume are numbers, which a comment names.
void writeContactsVtp(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
                      const ContactList& list);
/// As markups for 3D Slicer: a list of points, and a box of interest for each of `bounds`. LPS.
void writeContactsMarkups(std::ostream& out, const DetectOptions& options, const DetectInputs& inputs,
                          const ContactList& list);

} // namespace voxtact::app
