// SPDX-License-Identifier: MIT
// voxtact._core: what the package voxtact, in voxtact/, is thin on.
#include "failure.h"
#include "geometry.h"
#include "lock.h"
#include "motions.h"
#include "pictures.h"
#include "plans.h"
#include "process.h"
#include "scene.h"
#include "tracker.h"
#include "voxtact/io.h"

#include <pybind11/pybind11.h>

PYBIND11_MODULE(_core, module) {
    using namespace voxtact;
    module.doc() = "The compiled part of voxtact. Import voxtact instead: this has neither checks nor promises.";
    module.attr("__version__") = VOXTACT_VERSION;
    module.attr("MOST_SHEAR") = io::kMostShear;
    module.attr("DEFAULT_THRESHOLD") = kDefaultThreshold;
    module.attr("DEFAULT_TOLERANCE") = kDefaultTolerance;
    module.attr("DEFAULT_AREA_TOLERANCE") = kDefaultAreaTolerance;
    module.attr("DEFAULT_AREA_STEPS") = cpu::AreaDesc().mostSteps;
    module.attr("DEFAULT_TABLE_SIZE") = kDefaultTableSize;
    module.attr("DEFAULT_MOST_STEPS") = cpu::ClearanceDesc().mostSteps;
    module.attr("DEFAULT_MOTION_RESOLUTION") = kDefaultMotionResolution;
    module.attr("DEFAULT_MOTION_STEPS") = cpu::MotionDesc().mostSteps;
    module.attr("DEFAULT_TRACKER_STEPS") = cpu::TrackerDesc().mostSteps;
    module.attr("MOST_TABLE_SIZE") = kMostTableSize;
    module.attr("MOST_THREADS") = cpu::kMostThreads;
    module.attr("MOST_SAMPLES_PER_VOXEL") = kMostSamplesPerVoxel;
    module.attr("MOST_ENTRIES") = kMostEntries;
    module.attr("DEFAULT_PLAN_ENTRIES") = cpu::EntrySurface().entries;
    module.attr("DEFAULT_PLAN_TOLERANCE") = kDefaultPlanTolerance;
    module.attr("DEFAULT_PLAN_MAXIMUM") = kDefaultPlanMaximum;
    module.attr("DEFAULT_PLAN_STEPS") = cpu::PlannerDesc().mostSteps;
    python::watchForks();
    python::watchEnd();
    python::registerFailures();
    python::defineData(module);
    python::defineGeometry(module);
    python::defineDevice(module);
    python::defineAnswers(module);
    python::defineMotions(module);
    python::definePictures(module);
    python::definePlans(module);
    python::defineScene(module);
    python::defineTracker(module);
}
