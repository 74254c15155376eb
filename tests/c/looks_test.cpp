// SPDX-License-Identifier: MIT
// Pictures through the C interface as far as they need no device: looks, views, creases, and null for every argument.
#include "null_calls.h"
#include "support/c_calls.h"
#include "support/scenes.h"
#include "voxtact/looks.h"
#include "voxtact/render.h"
#include "voxtact/voxtact_vulkan.h"

#include <gmock/gmock.h>

#include <cmath>

namespace voxtact::test {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;

std::string text(vxt_result result) {
    EXPECT_EQ(result, VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(std::string(vxt_last_error(nullptr)).find('\n'), std::string::npos);
    return vxt_last_error(nullptr);
}

TEST(CLooks, AreTheCppInterfaces) {
    const vxt_range values{-500, 1500};
    for (std::size_t i = 0; i < lookPresets().size(); ++i) {
        ASSERT_STREQ(vxt_look_name(i), lookPresets()[i].name);
        const auto look = made(vxt_look_destroy, vxt_look_create, vxt_look_name(i), &values);
        const Result<Look> cpp = lookNamed(vxt_look_name(i), {values.lo, values.hi});
        ASSERT_TRUE(cpp.ok());
        std::size_t count = 0;
        const vxt_control_point* opacity = vxt_look_opacity(look.get(), &count);
        ASSERT_EQ(count, cpp->opacity.size());
        for (std::size_t point = 0; point < count; ++point) {
            EXPECT_EQ(opacity[point].value, cpp->opacity[point].value);
            EXPECT_EQ(opacity[point].opacity, cpp->opacity[point].opacity);
        }
        const vxt_colour_point* colours = vxt_look_colours(look.get(), &count);
        ASSERT_EQ(count, cpp->colours.size());
        for (std::size_t point = 0; point < count; ++point) {
            EXPECT_EQ(colours[point].value, cpp->colours[point].value);
            EXPECT_THAT(colours[point].colour, ElementsAreArray(cpp->colours[point].colour));
        }
    }
    EXPECT_EQ(vxt_look_name(lookPresets().size()), nullptr);
    vxt_look* none = nullptr;
    EXPECT_THAT(text(vxt_look_create("nothing", &values, &none)), HasSubstr("nothing"));
    EXPECT_EQ(text(vxt_look_create(nullptr, &values, &none)), "name is null");
    EXPECT_EQ(text(vxt_look_create("mr", nullptr, &none)), "values is null");
    const vxt_range nan{std::nan(""), 1};
    EXPECT_THAT(text(vxt_look_create(vxt_look_name(0), &nan, &none)), HasSubstr("values"));
    EXPECT_EQ(none, nullptr);
    std::size_t count = 7;
    EXPECT_EQ(vxt_look_opacity(nullptr, &count), nullptr);
    EXPECT_EQ(count, 0U);
    EXPECT_EQ(vxt_look_colours(nullptr, nullptr), nullptr);
}

TEST(CLooks, ViewsAreTheCppInterfaces) {
    const Grid grid = unitGrid(4, 5, 6);
    const vxt_grid cGridOf = cGrid(grid);
    const vxt_box also{{-3, -2, -1}, {4, 5, 6}};
    for (const char* name : {"front", "back", "left", "right", "top", "bottom"}) {
        vxt_view_direction direction{};
        need(vxt_direction_named(name, &direction));
        EXPECT_EQ(direction.azimuth, directionNamed(name)->azimuth);
        EXPECT_EQ(direction.elevation, directionNamed(name)->elevation);
        vxt_view view{};
        need(vxt_view_from(&direction, &cGridOf, nullptr, 30, 20, &view));
        EXPECT_THAT(view.clip_from_world, ElementsAreArray(viewFrom(*directionNamed(name), grid, {}, 30, 20)));
        EXPECT_EQ(view.width, 30U);
        EXPECT_EQ(view.height, 20U);
        need(vxt_view_from(&direction, &cGridOf, &also, 30, 20, &view));
        EXPECT_THAT(view.clip_from_world,
                    ElementsAreArray(viewFrom(*directionNamed(name), grid, Box{{-3, -2, -1}, {4, 5, 6}}, 30, 20)));
    }
    vxt_view_direction direction{};
    vxt_view view{};
    EXPECT_THAT(text(vxt_direction_named("above", &direction)), HasSubstr("'above'; there are front, back"));
    EXPECT_EQ(text(vxt_direction_named(nullptr, &direction)), "name is null");
    EXPECT_EQ(text(vxt_direction_named("left", nullptr)), "direction is null");
    EXPECT_EQ(text(vxt_view_from(nullptr, &cGridOf, nullptr, 1, 1, &view)), "direction is null");
    EXPECT_EQ(text(vxt_view_from(&direction, nullptr, nullptr, 1, 1, &view)), "grid is null");
    EXPECT_EQ(text(vxt_view_from(&direction, &cGridOf, nullptr, 1, 1, nullptr)), "view is null");
    EXPECT_THAT(text(vxt_view_from(&direction, &cGridOf, nullptr, 0, 1, &view)), HasSubstr("pixel"));
    direction.azimuth = std::nan("");
    EXPECT_THAT(text(vxt_view_from(&direction, &cGridOf, nullptr, 1, 1, &view)), HasSubstr("not finite"));
}

TEST(CLooks, CutsAreTheCppInterfaces) {
    const Grid grid = unitGrid(4, 5, 6);
    const vxt_grid cGridOf = cGrid(grid);
    const double at = 1.25;
    const vxt_view_direction direction{30, 20};
    for (const char* side : {"left", "right", "back", "front", "top", "bottom", "near"}) {
        for (const double* where : {static_cast<const double*>(nullptr), &at}) {
            const auto expected =
                clipSide(side, where == nullptr ? std::nullopt : std::optional<double>(at), grid, towardsEye({30, 20}));
            vxt_clip_plane plane{};
            need(vxt_clip_side(side, where, &cGridOf, &direction, &plane));
            EXPECT_THAT(plane.normal, ElementsAreArray(expected.value().normal)) << side;
            EXPECT_EQ(plane.offset, expected.value().offset) << side;
        }
    }
    // The grid's box is the unit cube.
    vxt_clip_plane plane{};
    need(vxt_clip_side("right", nullptr, &cGridOf, nullptr, &plane));
    EXPECT_THAT(plane.normal, testing::ElementsAre(-1, 0, 0));
    EXPECT_EQ(plane.offset, -0.5);
    EXPECT_THAT(text(vxt_clip_side("behind", nullptr, &cGridOf, nullptr, &plane)),
                HasSubstr("'behind'; there are left"));
    EXPECT_EQ(text(vxt_clip_side("near", nullptr, &cGridOf, nullptr, &plane)), "direction is null");
    EXPECT_EQ(text(vxt_clip_side(nullptr, nullptr, &cGridOf, nullptr, &plane)), "side is null");
    EXPECT_EQ(text(vxt_clip_side("left", nullptr, nullptr, nullptr, &plane)), "grid is null");
    EXPECT_EQ(text(vxt_clip_side("left", nullptr, &cGridOf, nullptr, nullptr)), "plane is null");
    const double nan = std::nan("");
    EXPECT_EQ(text(vxt_clip_side("left", &nan, &cGridOf, nullptr, &plane)), "at is not finite");
}

TEST(CLooks, LightsAndColoursAreTheCppInterfaces) {
    const Grid grid = unitGrid(4, 5, 6);
    const vxt_grid cGridOf = cGrid(grid);
    for (const char* name : {"soft", "eye", "none"}) {
        const Lighting expected = lightingNamed(name, grid).value();
        vxt_lighting light = sized<vxt_lighting>();
        need(vxt_lighting_named(name, &cGridOf, &light));
        EXPECT_EQ(light.ambient, expected.ambient) << name;
        EXPECT_EQ(light.diffuse, expected.diffuse) << name;
        EXPECT_EQ(light.specular, expected.specular) << name;
        EXPECT_EQ(light.shininess, expected.shininess) << name;
        EXPECT_EQ(light.side, expected.side) << name;
        EXPECT_THAT(light.side_from, ElementsAreArray(expected.sideFrom)) << name;
        EXPECT_EQ(light.occlusion, expected.occlusion) << name;
        EXPECT_EQ(light.reach, expected.reach) << name;
        EXPECT_EQ(light.plain_volume == 0, expected.volume) << name;
        EXPECT_EQ(light.plain_mesh == 0, expected.mesh) << name;
        EXPECT_EQ(light.gradient_faces == 0, expected.faces) << name;
        for (const double number : {light.ambient, light.diffuse, light.specular, light.shininess}) {
            EXPECT_TRUE(number != 0 || std::signbit(number)) << name << ": 0 stands for the default";
        }
    }
    vxt_lighting soft = sized<vxt_lighting>();
    need(vxt_lighting_named("soft", &cGridOf, &soft));
    EXPECT_GT(soft.occlusion, 0) << "not that of the eye";
    vxt_lighting unset{};
    EXPECT_THAT(text(vxt_lighting_named("soft", &cGridOf, &unset)), HasSubstr("struct_size"));
    EXPECT_THAT(text(vxt_lighting_named("hard", &cGridOf, &soft)), HasSubstr("'hard'; there are soft"));
    EXPECT_EQ(text(vxt_lighting_named(nullptr, &cGridOf, &soft)), "name is null");
    EXPECT_EQ(text(vxt_lighting_named("soft", nullptr, &soft)), "grid is null");
    EXPECT_EQ(text(vxt_lighting_named("soft", &cGridOf, nullptr)), "lighting is null");
    for (std::size_t number = 0; number < 7; ++number) {
        double colour[3] = {};
        vxt_mesh_colour(number, colour);
        EXPECT_THAT(colour, ElementsAreArray(meshColour(number))) << number;
        vxt_mesh_colour(number, nullptr);
    }
    EXPECT_NE(meshColour(0), meshColour(1));
    EXPECT_EQ(meshColour(0), meshColour(6));
    EXPECT_EQ(vxt_paint_through(VXT_PAINT_PLAIN), 0);
    EXPECT_EQ(vxt_paint_through(VXT_PAINT_CONTACTS), throughFor(Paint::Contacts));
    EXPECT_EQ(vxt_paint_through(VXT_PAINT_DISCARDED), 1);
}

TEST(CLooks, CreasesAreTheCppInterfaces) {
    // Two triangles at a right angle, which share an edge.
    MeshData roof;
    roof.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    roof.indices = {0, 1, 2, 0, 3, 1};
    const vxt_mesh_view view = cMesh(roof);
    const auto split = made(vxt_mesh_data_destroy, vxt_split_at_creases, &view, 40);
    const MeshData expected = *splitAtCreases(roof.view(), 40);
    const vxt_mesh_view found = dataView(split);
    EXPECT_GT(found.vertex_count, view.vertex_count);
    EXPECT_EQ(std::vector(found.positions, found.positions + 3 * found.vertex_count), expected.positions);
    EXPECT_EQ(std::vector(found.indices, found.indices + 3 * found.triangle_count), expected.indices);
    vxt_mesh_data* none = nullptr;
    EXPECT_NE(text(vxt_split_at_creases(&view, std::nan(""), &none)), "");
    EXPECT_EQ(text(vxt_split_at_creases(nullptr, 40, &none)), "mesh is null");
    EXPECT_EQ(none, nullptr);
}

TEST(CLooks, NothingIsRefusedAndEnded) {
    expectAllNullRefused(vxt_renderer_create, vxt_render_function_create, vxt_render_function_upload,
                         vxt_render_function_cmd_upload, vxt_render_function_cmd_update, vxt_mesh_normals_create,
                         vxt_mesh_normals_upload, vxt_mesh_normals_cmd_upload, vxt_mesh_normals_cmd_update,
                         vxt_render_bricks_create, vxt_painted_triangles_create, vxt_painted_triangles_upload,
                         vxt_painted_triangles_wrap, vxt_painted_triangles_cmd_upload, vxt_painted_vertices_create,
                         vxt_painted_vertices_upload, vxt_painted_vertices_wrap, vxt_painted_vertices_cmd_upload,
                         vxt_render_targets_create, vxt_renderer_cmd_render, vxt_blocking_renderer_create,
                         vxt_blocking_renderer_render);
    EXPECT_EQ(vxt_render_function_visible(nullptr), 0U);
    EXPECT_EQ(vxt_blocking_renderer_renderer(nullptr), nullptr);
    EXPECT_EQ(text(vxt_picture_create(nullptr)), "the place for the new object is null");
    EXPECT_EQ(text(vxt_picture_get(nullptr, nullptr)), "picture is null");
    const auto picture = made(vxt_picture_destroy, vxt_picture_create);
    EXPECT_EQ(text(vxt_picture_get(picture.get(), nullptr)), "view is null");
    endNothing(vxt_look_destroy, vxt_renderer_destroy, vxt_render_function_destroy, vxt_mesh_normals_release_staging,
               vxt_mesh_normals_destroy, vxt_render_bricks_destroy, vxt_painted_triangles_release_staging,
               vxt_painted_triangles_destroy, vxt_painted_vertices_release_staging, vxt_painted_vertices_destroy,
               vxt_render_targets_destroy, vxt_picture_destroy, vxt_blocking_renderer_destroy);
}

} // namespace
} // namespace voxtact::test
