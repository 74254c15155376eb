# SPDX-License-Identifier: MIT
"""Wraps the C interface with cffi. Internal: import voxtact instead.

Sizes and boxes are x, y, z; arrays of voxels are z, y, x.
"""
from __future__ import annotations

from ._engine import Scene, Tracker
from ._handles import Device, Labels, Mesh, Volume
from ._library import lib, standard, text_of
from ._tables import Tables

__version__: str = text_of(lib.vxt_version())
DEFAULT_THRESHOLD: float = standard("scene", "opacity_threshold")
DEFAULT_TOLERANCE: float = standard("distance", "tolerance")
DEFAULT_OVERLAP_TOLERANCE: float = standard("overlap", "tolerance")
DEFAULT_AREA_TOLERANCE: float = standard("area", "tolerance")
DEFAULT_AREA_STEPS: int = lib.VXT_DEFAULT_AREA_STEPS
DEFAULT_TOUCH_STEPS: int = lib.VXT_DEFAULT_TOUCH_STEPS
DEFAULT_TABLE_SIZE: int = lib.VXT_DEFAULT_TABLE_SIZE
DEFAULT_DISTANCE_STEPS: int = lib.VXT_DEFAULT_DISTANCE_STEPS
DEFAULT_MOTION_RESOLUTION: float = standard("motion", "resolution")
DEFAULT_MOTION_STEPS: int = lib.VXT_DEFAULT_MOTION_STEPS
DEFAULT_TRACKER_STEPS: int = lib.VXT_DEFAULT_TRACKER_STEPS
DEFAULT_PLAN_ENTRIES: int = lib.VXT_DEFAULT_ENTRIES
DEFAULT_PLAN_TOLERANCE: float = standard("plan", "tolerance")
DEFAULT_PLAN_MAX: float = lib.VXT_DEFAULT_PLAN_MAX
DEFAULT_PLAN_STEPS: int = lib.VXT_DEFAULT_PLAN_STEPS
MAX_TABLE_SIZE: int = lib.VXT_MAX_TABLE_SIZE
MAX_THREADS: int = lib.VXT_MAX_THREADS
MAX_SAMPLES_PER_VOXEL: int = lib.VXT_MAX_SAMPLES_PER_VOXEL
MAX_ENTRIES: int = lib.VXT_MAX_ENTRIES

__all__ = ["Device", "Labels", "Mesh", "Scene", "Tables", "Tracker", "Volume"]
