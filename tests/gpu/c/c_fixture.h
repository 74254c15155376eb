// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/random_scene.h"
#include "gpu_fixture.h"
#include "support/c_calls.h"
#include "support/scenes.h"
#include "voxtact/voxtact_vulkan.h"

#include <memory>

/// The Vulkan half of the C interface as its tests want it.
namespace voxtact::test {

inline constexpr std::uint32_t kMany = 1U << 19U;

inline vxt_context_desc cDesc(const ContextDesc& desc) {
    vxt_context_desc out = sized<vxt_context_desc>();
    out.get_instance_proc_addr = desc.getInstanceProcAddr;
    out.instance = desc.instance;
    out.physical_device = desc.physicalDevice;
    out.device = desc.device;
    out.api_version = desc.apiVersion;
    out.enabled_features = desc.enabledFeatures;
    out.enabled_instance_extensions = desc.enabledInstanceExtensions.data();
    out.enabled_instance_extension_count = desc.enabledInstanceExtensions.size();
    out.enabled_device_extensions = desc.enabledDeviceExtensions.data();
    out.enabled_device_extension_count = desc.enabledDeviceExtensions.size();
    out.pipeline_cache = desc.pipelineCache;
    return out;
}

/// A scene on the device through the C interface, uploaded in one go.
struct CScene {
    Owned<vxt_volume> volume;
    Owned<vxt_transfer_function> function;
    Owned<vxt_mesh> mesh;
    Owned<vxt_labels> labels;
    Owned<vxt_label_map> labelMap;

    CScene(const vxt_context* context, const vxt_queue& queue, const RandomScene& scene, const VolumeData& labelImage)
        : volume(made(vxt_volume_destroy, vxt_volume_upload, context, &queue, at(cVolume(scene.volume)),
                      at(vxt_volume_options{sizeof(vxt_volume_options), nullptr, 1, 1}))), // bricks, editable
          function(made(vxt_transfer_function_destroy, vxt_transfer_function_upload, context, &queue,
                        at(cFunction(cPoints(scene.points), scene.domain, scene.tableSize)), "table")),
          mesh(made(vxt_mesh_destroy, vxt_mesh_upload, context, &queue, at(cMesh(scene.mesh)),
                    at(vxt_mesh_options{sizeof(vxt_mesh_options), nullptr, 1, 0, 0}))), // clusters
          labels(made(vxt_labels_destroy, vxt_labels_create, at(cVolume(labelImage)))),
          labelMap(made(vxt_label_map_destroy, vxt_label_map_upload, context, &queue, labels.get(), nullptr)) {}
};

/// A batch of one item, with all that it looks at. Stays where it is.
struct COneItem {
    vxt_item item;
    vxt_view view;
    vxt_batch batch;

    COneItem(const vxt_mesh* mesh, const vxt_volume* volume, const vxt_transfer_function* function,
             const vxt_label_map* labels, const RandomScene& of)
        : item{sizeof item, mesh, volume, function, of.poses.data()->data(), of.poses.size(), labels, nullptr},
          view(cView(of.view)), batch{sizeof batch, &item, 1, &view, of.threshold} {}
    COneItem(const CScene& scene, const RandomScene& of)
        : COneItem(scene.mesh.get(), scene.volume.get(), scene.function.get(), scene.labelMap.get(), of) {}
    COneItem(const COneItem&) = delete;
    COneItem& operator=(const COneItem&) = delete;
};

class CGpuTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        const QueueAccess& of = queue();
        queue_ = {sizeof queue_, of.queue, of.lock, of.unlock, of.user, of.family};
        // One for all tests of a run: so they share its pipelines, which take most of the time on lavapipe.
        static const std::shared_ptr<vxt_context> shared = newContext();
        context_ = shared;
    }
    [[nodiscard]] Owned<vxt_context> newContext() const {
        const ContextDesc cpp = gpu().device.contextDesc();
        const vxt_context_desc desc = cDesc(cpp);
        return made(vxt_context_destroy, vxt_context_create, &desc);
    }
    [[nodiscard]] Owned<vxt_detector> newDetector(const vxt_certified_desc& desc) const {
        return made(vxt_detector_destroy, vxt_detector_create_certified, context_.get(), &desc);
    }
    [[nodiscard]] Owned<vxt_detector> newDetector(const vxt_raster_desc& desc) const {
        return made(vxt_detector_destroy, vxt_detector_create_raster, context_.get(), &desc);
    }
    [[nodiscard]] static Owned<vxt_results> newResults(const vxt_detector& detector, const vxt_results_desc& desc) {
        return made(vxt_results_destroy, vxt_results_create, &detector, &desc);
    }
    [[nodiscard]] Owned<vxt_blocking_detector> newBlocking(const vxt_certified_desc& desc) const {
        return made(vxt_blocking_detector_destroy, vxt_blocking_detector_create_certified, context_.get(), &desc,
                    &queue_, kMany);
    }
    [[nodiscard]] Owned<vxt_blocking_detector> newBlocking(const vxt_raster_desc& desc) const {
        return made(vxt_blocking_detector_destroy, vxt_blocking_detector_create_raster, context_.get(), &desc, &queue_,
                    kMany);
    }
    [[nodiscard]] static BatchAnswer ask(vxt_blocking_detector& detector, const COneItem& of) {
        const Owned<vxt_answer> answer = newAnswer();
        need(vxt_blocking_detector_detect(&detector, &of.batch, answer.get()));
        return answerOf(*answer);
    }

    /// 6x6x6 voxels over the unit cube, opaque where x < 0.5, and a square across it on 16x16 pixels.
    [[nodiscard]] static RandomScene halfOpaque() {
        RandomScene scene;
        scene.volume = makeBytes(unitGrid(6), [](std::uint32_t x, auto, auto) { return x < 3 ? 255.0 : 0.0; });
        scene.points = {{0, 0}, {255, 1}};
        scene.domain = {0, 255};
        scene.mesh = makeFlat(0, 1, 0, 1, 0.5);
        scene.view = flatView(0, 1, 16, 16);
        scene.poses = {identity()};
        scene.threshold = 0.5;
        return scene;
    }
    [[nodiscard]] static VolumeData twoLabels() {
        return makeBytes(unitGrid(6), [](std::uint32_t x, auto, auto) { return x < 3 ? 0.0 : 3.0; });
    }

    vxt_queue queue_ = sized<vxt_queue>();
    std::shared_ptr<vxt_context> context_;
};

} // namespace voxtact::test
