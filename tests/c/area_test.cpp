// SPDX-License-Identifier: MIT
// Contact areas through the C interface: the C++ interface's answers, every member of them.
#include "both_interfaces.h"
#include "support/contact_scenes.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <iostream>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

Owned<vxt_areas> newAreas() {
    return made<vxt_areas>(vxt_areas_destroy, [](auto out) { return vxt_areas_create(out); });
}

vxt_area_view viewOf(const vxt_areas& areas) {
    vxt_area_view view = vxt_area_view_init();
    need(vxt_areas_get(&areas, &view));
    return view;
}

Owned<vxt_host_area_meter> newMeter(const vxt_host_area_desc* desc) {
    return made<vxt_host_area_meter>(vxt_host_area_meter_destroy,
                                     [&](auto out) { return vxt_host_area_meter_create(desc, out); });
}

/// What areas of pairs, labels and triangles have in common.
template <class C, class Cpp> void expectSame(const C& c, const Cpp& cpp) {
    EXPECT_EQ(c.lo, cpp.bounds.lo);
    EXPECT_EQ(c.hi, cpp.bounds.hi);
    EXPECT_EQ(c.pair, cpp.pair);
    EXPECT_EQ(c.item, cpp.item);
    EXPECT_EQ(c.pose, cpp.pose);
}
template <class C, class Cpp> void expectSameEnd(const C& c, const Cpp& cpp) {
    expectSame(c, cpp);
    EXPECT_STREQ(vxt_area_end_name(c.end), toString(cpp.end));
}

TEST(CArea, IsWhatTheCppInterfaceSays) {
    std::mt19937_64 random(testSeed());
    vxt_host_area_desc desc = vxt_host_area_desc_init();
    desc.tolerance = 1e-3;
    desc.resolution = 1.0 / 8;
    desc.most_steps = 100;
    desc.threads = 1;
    const Owned<vxt_host_area_meter> meter = newMeter(&desc);
    EXPECT_EQ(vxt_host_area_meter_threads(meter.get()), 1U);
    cpu::AreaMeter cpp =
        take(cpu::AreaMeter::create({.threads = 1, .tolerance = 1e-3, .resolution = 1.0 / 8, .mostSteps = 100}));
    const Owned<vxt_areas> areas = newAreas();
    std::size_t touching = 0;
    std::size_t labelled = 0;
    std::size_t budget = 0;
    for (int round = 0; round < 10 || (round < 300 && (touching == 0 || labelled == 0 || budget == 0)); ++round) {
        const RandomScene scene = makeRandomScene(random, 4);
        const VolumeData map =
            makeBytes(scene.volume.grid, [](auto x, auto y, auto z) { return (x / 3 + y / 3 + z / 3) % 3; });
        const BothInterfaces both(scene, map);
        const cpu::BatchItem item{&both.mesh, &both.volume, &both.function, scene.poses, &both.labels};
        const cpu::Batch batch{std::span(&item, 1), scene.view, scene.threshold};
        BothInterfaces::CBatch c;
        both.fill(c, scene);

        need(vxt_host_area_meter_measure(meter.get(), &c.batch, areas.get()));
        const std::vector<PairArea> pairs = take(cpp.measure(batch)).pairs;
        vxt_area_view view = viewOf(*areas);
        ASSERT_EQ(view.pair_count, pairs.size());
        EXPECT_EQ(view.label_count, 0U);
        EXPECT_GE(view.wall_milliseconds, 0);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            expectSameEnd(view.pairs[i], pairs[i]);
            touching += pairs[i].bounds.lo > 0 ? 1 : 0;
            budget += pairs[i].end == AreaEnd::Budget ? 1 : 0;
        }

        need(vxt_host_area_meter_measure_triangles(meter.get(), &c.batch, areas.get()));
        const std::vector<TriangleArea> triangles = take(cpp.measureTriangles(batch)).triangles;
        view = viewOf(*areas);
        ASSERT_EQ(view.triangle_count, triangles.size());
        ASSERT_EQ(view.pair_count, pairs.size());
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            expectSameEnd(view.pairs[i], pairs[i]);
        }
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            expectSame(view.triangles[i], triangles[i]);
            EXPECT_EQ(view.triangles[i].triangle, triangles[i].triangle);
            EXPECT_EQ(view.triangles[i].whole, triangles[i].whole);
        }

        const std::vector<std::int32_t> asked{2, 0, 12345};
        need(vxt_host_area_meter_measure_labels(meter.get(), &c.batch, asked.data(), asked.size(), areas.get()));
        const std::vector<LabelArea> labels = take(cpp.measureLabels(batch, asked)).labels;
        view = viewOf(*areas);
        ASSERT_EQ(view.label_count, labels.size());
        EXPECT_EQ(view.pair_count, 0U);
        EXPECT_EQ(view.triangle_count, 0U);
        for (std::size_t i = 0; i < labels.size(); ++i) {
            expectSameEnd(view.labels[i], labels[i]);
            EXPECT_EQ(view.labels[i].label, labels[i].label);
            EXPECT_EQ(view.labels[i].reserved, 0U);
            labelled += labels[i].bounds.lo > 0 ? 1 : 0;
        }
    }
    std::cout << touching << " have an area, " << labelled << " with a label, " << budget << " took too many steps\n";
    EXPECT_GT(touching, 0U);
    EXPECT_GT(labelled, 0U);
    EXPECT_GT(budget, 0U);
}

TEST(CArea, HasTheCppInterfacesDefaults) {
    const vxt_host_area_desc c = vxt_host_area_desc_init();
    const cpu::AreaDesc cpp;
    EXPECT_EQ(c.tolerance, cpp.tolerance);
    EXPECT_EQ(c.resolution, cpp.resolution);
    EXPECT_EQ(c.most_steps, cpp.mostSteps);
    EXPECT_EQ(c.threads, cpp.threads);
    EXPECT_EQ(c.reserved, 0U);
}

TEST(CArea, RefusesNullAndWhatTheCppInterfaceRefuses) {
    const auto text = [](vxt_result result) {
        EXPECT_EQ(result, VXT_ERROR_INVALID_ARGUMENT);
        return std::string(vxt_last_error(nullptr));
    };
    vxt_host_area_desc desc = vxt_host_area_desc_init();
    desc.tolerance = 0;
    vxt_host_area_meter* none = nullptr;
    EXPECT_THAT(text(vxt_host_area_meter_create(&desc, &none)), HasSubstr("the tolerance 0 mm^2"));
    EXPECT_EQ(none, nullptr);
    desc = vxt_host_area_desc_init();
    desc.most_steps = 0;
    EXPECT_THAT(text(vxt_host_area_meter_create(&desc, &none)), HasSubstr("0 steps"));
    EXPECT_EQ(text(vxt_host_area_meter_create(nullptr, nullptr)).find('\n'), std::string::npos);
    EXPECT_EQ(vxt_host_area_meter_threads(nullptr), 0U);

    const Owned<vxt_host_area_meter> meter = newMeter(nullptr);
    const Owned<vxt_areas> areas = newAreas();
    const vxt_host_batch batch = vxt_host_batch_init();
    EXPECT_EQ(text(vxt_host_area_meter_measure(nullptr, &batch, areas.get())), "meter is null");
    EXPECT_EQ(text(vxt_host_area_meter_measure(meter.get(), nullptr, areas.get())), "batch is null");
    EXPECT_EQ(text(vxt_host_area_meter_measure(meter.get(), &batch, nullptr)), "areas is null");
    EXPECT_EQ(text(vxt_host_area_meter_measure_labels(meter.get(), &batch, nullptr, 1, areas.get())), "labels is null");
    EXPECT_EQ(text(vxt_host_area_meter_measure_labels(nullptr, &batch, nullptr, 0, areas.get())), "meter is null");
    EXPECT_EQ(text(vxt_host_area_meter_measure_labels(meter.get(), &batch, nullptr, 0, nullptr)), "areas is null");
    EXPECT_EQ(text(vxt_host_area_meter_measure_triangles(nullptr, &batch, areas.get())), "meter is null");
    EXPECT_EQ(text(vxt_host_area_meter_measure_triangles(meter.get(), nullptr, areas.get())), "batch is null");
    EXPECT_EQ(text(vxt_host_area_meter_measure_triangles(meter.get(), &batch, nullptr)), "areas is null");
    vxt_area_view view = vxt_area_view_init();
    EXPECT_EQ(text(vxt_areas_get(nullptr, &view)), "areas is null");
    EXPECT_EQ(text(vxt_areas_get(areas.get(), nullptr)), "view is null");
    need(vxt_host_area_meter_measure(meter.get(), &batch, areas.get()));
    need(vxt_areas_get(areas.get(), &view));
    EXPECT_EQ(view.pair_count, 0U);
    EXPECT_EQ(vxt_areas_create(nullptr), VXT_ERROR_INVALID_ARGUMENT);
}

} // namespace
} // namespace voxtact::test
