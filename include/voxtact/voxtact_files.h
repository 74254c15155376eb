/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VOXTACT_FILES_H
#define VOXTACT_VOXTACT_FILES_H

#include "voxtact/voxtact_data.h"

/// @file
/// Files, in C: voxtact::io. A library that was built without it returns UNSUPPORTED. The conventions of voxtact.h
/// apply.

#ifdef __cplusplus
extern "C" {
#endif

/// Selects an image of a file or folder that holds several.
typedef struct vxt_volume_read_options {
    size_t struct_size;    ///< sizeof this struct
    const char* series;    ///< SeriesInstanceUID in a DICOM folder; null: the only series
    uint32_t choose_frame; ///< 1: uses `frame`; 0: the only image
    uint32_t frame;        ///< index in a 4D NIfTI file, from 0
    uint32_t resample;     ///< 1: DICOM slices that make no regular grid are resampled, with a note; 0: refused
} vxt_volume_read_options;

/// Unit and space of a mesh file.
typedef struct vxt_mesh_read_options {
    size_t struct_size; ///< sizeof this struct
    double scale;       ///< millimetres per unit of the file; 0: 1
    uint32_t ras;       ///< 1: RAS coordinates: x and y are negated; 0: as the file states, else LPS
    double deflection;  ///< of the triangulation of STEP and IGES, mm; 0: 0.01
} vxt_mesh_read_options;

/// Reads a volume from a file or a DICOM folder: voxtact::io::readVolume(). Null options are the defaults.
VXT_CHECKED vxt_result vxt_read_volume(const char* path, const vxt_volume_read_options* options,
                                       vxt_volume_data** data);
/// Like vxt_read_volume(), from the bytes of one file; the ending of `name` selects the format.
VXT_CHECKED vxt_result vxt_read_volume_bytes(const char* name, const void* content, size_t bytes,
                                             const vxt_volume_read_options* options, vxt_volume_data** data);
/// Writes a volume: voxtact::io::writeVolume().
VXT_CHECKED vxt_result vxt_write_volume(const char* path, const vxt_volume_view* volume);
/// Reads a mesh from a file: voxtact::io::readMesh(). Null options are the defaults.
VXT_CHECKED vxt_result vxt_read_mesh(const char* path, const vxt_mesh_read_options* options, vxt_mesh_data** data);
/// Like vxt_read_mesh(), from the bytes of one file; the ending of `name` selects the format.
VXT_CHECKED vxt_result vxt_read_mesh_bytes(const char* name, const void* content, size_t bytes,
                                           const vxt_mesh_read_options* options, vxt_mesh_data** data);
/// Writes a mesh: voxtact::io::writeMesh().
VXT_CHECKED vxt_result vxt_write_mesh(const char* path, const vxt_mesh_view* mesh);
/// Returns the largest deviation of a grid's axes from right angles, degrees: voxtact::io::shearDegrees().
/// `max_degrees` returns the maximum for a NIfTI sform; may be null.
VXT_CHECKED vxt_result vxt_grid_shear(const vxt_grid* grid, double* degrees, double* max_degrees);
/// Return the readers' note on a sheared grid, or on vertices that single precision rounds; otherwise "". Valid until
/// the same thread calls again.
/// @{
VXT_API const char* vxt_grid_note(const vxt_grid* grid);
VXT_API const char* vxt_mesh_note(const vxt_mesh_facts* facts);
/// @}
/// Reads one `clip_from_world` matrix: voxtact::io::readCamera().
VXT_CHECKED vxt_result vxt_read_camera(const char* path, double clip_from_world[16]);

/// Poses read from a file.
typedef struct vxt_poses vxt_poses;
/// Reads poses: voxtact::io::readPoses(). `format`: "matrix", "t-xyzw", "t-wxyz", "xyzw-t" or "wxyz-t"; null: "matrix".
VXT_CHECKED vxt_result vxt_read_poses(const char* path, const char* format, vxt_poses** poses);
/// Returns 16 doubles per pose, column-major, as items take them; valid as long as the object. `count`: number of
/// poses.
VXT_API const double* vxt_poses_get(const vxt_poses* poses, size_t* count);
/// Destroys the object.
VXT_API void vxt_poses_destroy(vxt_poses* poses);

/// Reads poses in parts, in constant memory, like vxt_read_poses(): voxtact::io::PoseReader.
typedef struct vxt_pose_reader vxt_pose_reader;
/// Opens a file. Refuses a file that cannot be opened.
VXT_CHECKED vxt_result vxt_pose_reader_open(const char* path, const char* format, vxt_pose_reader** reader);
/// Reads the next poses, at most `most`, into `poses`, 16 doubles each, column-major. `count` is their number: 0 at the
/// end.
VXT_CHECKED vxt_result vxt_pose_reader_read(vxt_pose_reader* reader, double* poses, size_t most, size_t* count);
/// Destroys the object.
VXT_API void vxt_pose_reader_destroy(vxt_pose_reader* reader);

/// Control points read from a file.
typedef struct vxt_control_points vxt_control_points;
/// Reads a transfer function: voxtact::io::readTransferFunction().
VXT_CHECKED vxt_result vxt_read_transfer_function(const char* path, vxt_control_points** points);
/// Parses control points from "v:a,v:a,...".
VXT_CHECKED vxt_result vxt_parse_opacity(const char* text, vxt_control_points** points);
/// Returns the points, valid as long as the object.
VXT_API const vxt_control_point* vxt_control_points_get(const vxt_control_points* points, size_t* count);
/// Destroys the object.
VXT_API void vxt_control_points_destroy(vxt_control_points* points);

/// A corner of the piecewise linear colours of pictures.
typedef struct vxt_colour_point {
    double value;     ///< in the image's own units
    double colour[3]; ///< red, green, blue; 0..1
} vxt_colour_point;
/// Colours read from a file.
typedef struct vxt_colour_points vxt_colour_points;
/// Reads the colours of a transfer function's JSON file; none if it has none: voxtact::io::readColours().
VXT_CHECKED vxt_result vxt_read_colours(const char* path, vxt_colour_points** points);
/// Returns the points, valid as long as the object.
VXT_API const vxt_colour_point* vxt_colour_points_get(const vxt_colour_points* points, size_t* count);
/// Destroys the object.
VXT_API void vxt_colour_points_destroy(vxt_colour_points* points);

/// Writes a PNG file of 8 bits per channel, red, green, blue and alpha of each pixel, the uppermost row first:
/// voxtact::io::writePng().
VXT_CHECKED vxt_result vxt_write_png(const char* path, uint32_t width, uint32_t height, const void* rgba, size_t bytes);

/// Label names read from a file.
typedef struct vxt_label_names vxt_label_names;
/// Reads lines `number name`: voxtact::io::readLabelNames().
VXT_CHECKED vxt_result vxt_read_label_names(const char* path, vxt_label_names** names);
/// Returns the name at an index, in the file's order, and its label; null beyond the last one. `label` may be null.
VXT_API const char* vxt_label_names_get(const vxt_label_names* names, size_t index, int32_t* label);
/// Destroys the object.
VXT_API void vxt_label_names_destroy(vxt_label_names* names);

/// A list of points read from a file.
typedef struct vxt_points vxt_points;
/// Reads lines `x y z` or `x y z name`, or 3D Slicer's .fcsv or .mrk.json: voxtact::io::readPoints().
VXT_CHECKED vxt_result vxt_read_points(const char* path, vxt_points** points);
/// Returns the name of the point at an index, in the file's order, or "" without a name; null beyond the last one. Also
/// returns its position, mm in LPS, and its line, from 1; both may be null.
VXT_API const char* vxt_points_get(const vxt_points* points, size_t index, double position[3], uint64_t* line);
/// Destroys the object.
VXT_API void vxt_points_destroy(vxt_points* points);

#ifdef __cplusplus
}
#endif

#endif
