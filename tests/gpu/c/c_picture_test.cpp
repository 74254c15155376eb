// SPDX-License-Identifier: MIT
// Pictures through the C interface: the C++ interface's, to the last bit.
#include "c_fixture.h"

#include "own_image.h"
#include "voxtact/looks.h"
#include "voxtact/render.h"

#include <gmock/gmock.h>

#include <cmath>

namespace voxtact::test {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;

constexpr std::uint32_t kWidth = 48;
constexpr std::uint32_t kHeight = 40;
constexpr ColourPoint kColours[] = {{0, {0.2, 0.1, 0.9}}, {255, {0.9, 0.6, 0.1}}};
constexpr vxt_colour_point kCColours[] = {{0, {0.2, 0.1, 0.9}}, {255, {0.9, 0.6, 0.1}}};

/// The same scene in both interfaces: a half that is opaque, a square across it, lights, a plane that clips.
class CPictures : public CGpuTest {
  protected:
    void SetUp() override {
        CGpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        scene_ = halfOpaque();
        sides_.emplace(context_.get(), queue_, scene_, twoLabels());
        const Result<Mat4> look = lookFrom();
        blocking_ = made(vxt_blocking_renderer_destroy, vxt_blocking_renderer_create, context_.get(), &queue_);
        makeC(*look);
        makeCpp(*look);
    }
    void TearDown() override {
        cpp_ = {};
        cppParts_.reset();
        CGpuTest::TearDown();
    }

    [[nodiscard]] Result<Mat4> lookFrom() const {
        return viewFrom({30, 20}, scene_.volume.grid, std::nullopt, kWidth, kHeight);
    }
    [[nodiscard]] const vxt_renderer* renderer() const { return vxt_blocking_renderer_renderer(blocking_.get()); }

    void makeC(const Mat4& clip_from_world) {
        const std::vector<vxt_control_point> points = cPoints(scene_.points);
        vxt_render_function_desc desc = sized<vxt_render_function_desc>();
        desc.points = points.data();
        desc.point_count = points.size();
        desc.colours = kCColours;
        desc.colour_count = std::size(kCColours);
        desc.domain = {scene_.domain.lo, scene_.domain.hi};
        desc.opacity_unit = 0.4;
        desc.step = 0.05;
        function_ = made(vxt_render_function_destroy, vxt_render_function_upload, renderer(), &queue_, &desc);
        bricks_ = made(vxt_render_bricks_destroy, vxt_render_bricks_create, renderer(), sides_->volume.get());
        const vxt_mesh_view view = cMesh(scene_.mesh);
        normals_ = made(vxt_mesh_normals_destroy, vxt_mesh_normals_upload, renderer(), &queue_, &view);
        const std::uint32_t chosen = 1;
        painted_ =
            made(vxt_painted_triangles_destroy, vxt_painted_triangles_upload, renderer(), &queue_, 2, &chosen, 1);
        const std::vector<Colour> colours = vertexColours();
        vertices_ = made(vxt_painted_vertices_destroy, vxt_painted_vertices_upload, renderer(), &queue_,
                         colours.front().data(), colours.size());
        mesh_.mesh = sides_->mesh.get();
        mesh_.normals = normals_.get();
        mesh_.transfer_function = sides_->function.get();
        mesh_.threshold = 0.5;
        mesh_.through = 0.75;
        set(mesh_.contact_colour, {1, 0.23, 0.5});
        set(mesh_.colour, {0.3, 0.78, 0.82});
        std::ranges::copy(translation({0, 0, 0.125}), mesh_.world_from_object);
        lighting_.ambient = 0.4;
        lighting_.side = 0.3;
        lighting_.gradient_faces = 1;
        c_.volume = sides_->volume.get();
        c_.function = function_.get();
        c_.bricks = bricks_.get();
        c_.meshes = &mesh_;
        c_.mesh_count = 1;
        c_.clip_planes = &plane_;
        c_.clip_plane_count = 1;
        c_.lighting = &lighting_;
        std::ranges::copy(clip_from_world, c_.clip_from_world);
        c_.background[1] = 0.25;
        c_.no_jitter = 1;
    }
    static void set(double (&colour)[3], const Colour& to) { std::ranges::copy(to, colour); }

    [[nodiscard]] std::vector<Colour> vertexColours() const {
        std::vector<Colour> colours;
        for (std::size_t i = 0; i < scene_.mesh.positions.size() / 3; ++i) {
            colours.push_back({0.25 * static_cast<double>(i % 5), 0.5, 1 - 0.25 * static_cast<double>(i % 4)});
        }
        return colours;
    }

    /// What of the C++ interface the scene looks at.
    struct CppParts {
        BlockingRenderer blocking;
        Volume volume;
        TransferFunction function;
        Mesh mesh;
        RenderTransferFunction colours;
        RenderBricks bricks;
        MeshNormals normals;
        PaintedTriangles painted;
        PaintedVertices vertices;
        SceneMesh sceneMesh;
        ClipPlane plane;
    };
    void makeCpp(const Mat4& clip_from_world) {
        BlockingRenderer blocking = take(BlockingRenderer::create(context(), queue()));
        const Renderer& with = blocking.renderer();
        Volume volume = take(Volume::upload(context(), queue(), scene_.volume.view(), {.bricks = true}));
        RenderBricks bricks = take(RenderBricks::create(with, volume));
        const RenderTransferFunctionDesc desc{scene_.transferFunction(), kColours, 0.4, 0.05};
        const std::vector<std::uint32_t> chosen{1};
        cppParts_.reset(new CppParts{std::move(blocking),
                                     std::move(volume),
                                     upload(scene_.points, scene_.domain),
                                     upload(scene_.mesh),
                                     take(RenderTransferFunction::upload(with, queue(), desc)),
                                     std::move(bricks),
                                     take(MeshNormals::upload(with, queue(), scene_.mesh.view())),
                                     take(PaintedTriangles::upload(with, queue(), 2, chosen)),
                                     take(PaintedVertices::upload(with, queue(), vertexColours())),
                                     {},
                                     {{1, 1, 0}, 1.4}});
        CppParts& parts = *cppParts_;
        SceneMesh& one = parts.sceneMesh;
        one.mesh = &parts.mesh;
        one.normals = &parts.normals;
        one.world_from_object = translation({0, 0, 0.125});
        one.meshColour[0] = 0.3;
        one.paint.transferFunction = &parts.function;
        one.paint.threshold = 0.5;
        one.paint.through = 0.75;
        one.paint.contactColour[2] = 0.5;
        cpp_.volume = &parts.volume;
        cpp_.transferFunction = &parts.colours;
        cpp_.bricks = &parts.bricks;
        cpp_.others = std::span(&one, 1);
        cpp_.clipPlanes = std::span(&parts.plane, 1);
        cpp_.lighting.ambient = 0.4;
        cpp_.lighting.side = 0.3;
        cpp_.lighting.faces = false;
        cpp_.clip_from_world = clip_from_world;
        cpp_.background = {0, 0.25, 0};
        cpp_.jitter = false;
    }

    [[nodiscard]] static vxt_picture_view viewOf(const vxt_picture& picture) {
        vxt_picture_view view = sized<vxt_picture_view>();
        need(vxt_picture_get(&picture, &view));
        return view;
    }
    [[nodiscard]] std::vector<std::uint8_t> byC(vxt_picture_progress progress = nullptr, void* user = nullptr) const {
        need(vxt_blocking_renderer_render(blocking_.get(), &c_, kWidth, kHeight, progress, user, picture_.get()));
        const vxt_picture_view view = viewOf(*picture_);
        EXPECT_EQ(view.width, kWidth);
        EXPECT_EQ(view.height, kHeight);
        return {view.rgba, view.rgba + view.bytes};
    }
    [[nodiscard]] std::vector<std::uint8_t> byCpp() const {
        return take(cppParts_->blocking.render(cpp_, {kWidth, kHeight})).rgba;
    }
    std::string refused() const {
        EXPECT_EQ(vxt_blocking_renderer_render(blocking_.get(), &c_, kWidth, kHeight, nullptr, nullptr, picture_.get()),
                  VXT_ERROR_INVALID_ARGUMENT);
        return vxt_last_error(context_.get());
    }

    RandomScene scene_;
    std::optional<CScene> sides_;
    Owned<vxt_blocking_renderer> blocking_{nullptr, vxt_blocking_renderer_destroy};
    Owned<vxt_render_function> function_{nullptr, vxt_render_function_destroy};
    Owned<vxt_render_bricks> bricks_{nullptr, vxt_render_bricks_destroy};
    Owned<vxt_mesh_normals> normals_{nullptr, vxt_mesh_normals_destroy};
    Owned<vxt_painted_triangles> painted_{nullptr, vxt_painted_triangles_destroy};
    Owned<vxt_painted_vertices> vertices_{nullptr, vxt_painted_vertices_destroy};
    vxt_scene_mesh mesh_ = sized<vxt_scene_mesh>();
    vxt_clip_plane plane_{{1, 1, 0}, 1.4};
    vxt_lighting lighting_ = sized<vxt_lighting>();
    vxt_picture_scene c_ = sized<vxt_picture_scene>();
    Owned<vxt_picture> picture_ = made(vxt_picture_destroy, vxt_picture_create);
    std::unique_ptr<CppParts> cppParts_;
    Scene cpp_;
};

TEST_F(CPictures, AreTheCppInterfacesWithEveryPaint) {
    std::vector<std::vector<std::uint8_t>> all;
    for (const vxt_paint paint :
         {VXT_PAINT_PLAIN, VXT_PAINT_CONTACTS, VXT_PAINT_DISCARDED, VXT_PAINT_TRIANGLES, VXT_PAINT_VERTICES}) {
        mesh_.paint = paint;
        mesh_.triangles = paint == VXT_PAINT_TRIANGLES ? painted_.get() : nullptr;
        mesh_.vertices = paint == VXT_PAINT_VERTICES ? vertices_.get() : nullptr;
        cppParts_->sceneMesh.paint.what = static_cast<Paint>(paint);
        cppParts_->sceneMesh.paint.triangles = paint == VXT_PAINT_TRIANGLES ? &cppParts_->painted : nullptr;
        cppParts_->sceneMesh.paint.vertices = paint == VXT_PAINT_VERTICES ? &cppParts_->vertices : nullptr;
        all.push_back(byC());
        EXPECT_THAT(all.back(), ElementsAreArray(byCpp())) << "paint " << paint;
    }
    for (std::size_t i = 1; i < all.size(); ++i) {
        EXPECT_NE(all[i], all[0]) << "paint " << i << " paints nothing";
    }
}

TEST_F(CPictures, ShowEveryPartOfTheScene) {
    // What each member does is seen: without it the picture is another, in C as in C++.
    const auto expectSeen = [&](const char* what, auto changeC, auto changeCpp) {
        const vxt_picture_scene c = c_;
        const Scene cpp = cpp_;
        const vxt_scene_mesh mesh = mesh_;
        const SceneMesh sceneMesh = cppParts_->sceneMesh;
        const std::vector<std::uint8_t> before = byC();
        changeC();
        changeCpp();
        const std::vector<std::uint8_t> after = byC();
        EXPECT_NE(after, before) << what;
        EXPECT_EQ(after, byCpp()) << what;
        c_ = c;
        cpp_ = cpp;
        mesh_ = mesh;
        cppParts_->sceneMesh = sceneMesh;
    };
    expectSeen(
        "mesh", [&] { c_.mesh_count = 0; }, [&] { cpp_.others = {}; });
    expectSeen(
        "plane", [&] { c_.clip_plane_count = 0; }, [&] { cpp_.clipPlanes = {}; });
    expectSeen(
        "lighting", [&] { c_.lighting = nullptr; }, [&] { cpp_.lighting = {}; });
    expectSeen(
        "background", [&] { c_.background[2] = 1; }, [&] { cpp_.background[2] = 1; });
    expectSeen(
        "jitter", [&] { c_.no_jitter = 0; }, [&] { cpp_.jitter = true; });
    expectSeen(
        "clipped", [&] { mesh_.clipped = 1; }, [&] { cppParts_->sceneMesh.clipped = true; });
    expectSeen(
        "pose", [&] { mesh_.world_from_object[12] = 0.2; }, [&] { cppParts_->sceneMesh.world_from_object[12] = 0.2; });
    expectSeen(
        "colour", [&] { mesh_.colour[2] = 0.1; }, [&] { cppParts_->sceneMesh.meshColour[2] = 0.1; });
}

TEST_F(CPictures, ZerosAreTheDefaultsAndNegativeZerosAreZeros) {
    const vxt_mesh* const mesh = mesh_.mesh;
    mesh_ = sized<vxt_scene_mesh>();
    mesh_.mesh = mesh;
    lighting_ = sized<vxt_lighting>();
    c_.no_jitter = 0;
    cppParts_->sceneMesh = {.mesh = cppParts_->sceneMesh.mesh};
    cpp_.lighting = {};
    cpp_.jitter = true;
    const std::vector<std::uint8_t> defaults = byC();
    EXPECT_EQ(defaults, byCpp());
    mesh_.colour[1] = -0.0;
    cppParts_->sceneMesh.meshColour = {0, 0, 0};
    const std::vector<std::uint8_t> black = byC();
    EXPECT_EQ(black, byCpp());
    EXPECT_NE(black, defaults);
    mesh_.colour[1] = 0;
    cppParts_->sceneMesh.meshColour = SceneMesh{}.meshColour;
    lighting_.ambient = lighting_.diffuse = lighting_.specular = lighting_.shininess = -0.0;
    Lighting& lighting = cpp_.lighting;
    lighting.ambient = lighting.diffuse = lighting.specular = lighting.shininess = 0;
    const std::vector<std::uint8_t> dark = byC();
    EXPECT_EQ(dark, byCpp());
    EXPECT_NE(dark, defaults);
}

TEST_F(CPictures, TellHowFarTheyAre) {
    const std::vector<std::uint8_t> expected = byC();
    struct Heard {
        std::uint32_t done = 0;
        std::uint32_t calls = 0;
    } heard;
    const auto hear = [](void* user, std::uint32_t done, std::uint32_t rows) {
        auto& to = *static_cast<Heard*>(user);
        EXPECT_GT(done, to.done);
        EXPECT_EQ(rows, kHeight);
        to = {done, to.calls + 1};
    };
    EXPECT_EQ(byC(hear, &heard), expected);
    EXPECT_EQ(heard.done, kHeight);
    EXPECT_GE(heard.calls, 2U);
}

TEST_F(CPictures, EndWhereTheyAreTold) {
    const std::vector<std::uint8_t> expected = byC();
    const auto cancel = made(vxt_cancel_destroy, vxt_cancel_create);
    c_.cancel = cancel.get();
    EXPECT_EQ(byC(), expected); // it is not set
    struct Heard {
        vxt_cancel* cancel;
        std::uint32_t calls = 0;
    } heard{cancel.get()};
    const auto stop = [](void* user, std::uint32_t, std::uint32_t) {
        auto& to = *static_cast<Heard*>(user);
        ++to.calls;
        vxt_cancel_set(to.cancel, 1);
    };
    EXPECT_EQ(vxt_blocking_renderer_render(blocking_.get(), &c_, kWidth, kHeight, stop, &heard, picture_.get()),
              VXT_ERROR_CANCELLED);
    EXPECT_EQ(heard.calls, 1U);
    EXPECT_EQ(vxt_blocking_renderer_render(blocking_.get(), &c_, kWidth, kHeight, nullptr, nullptr, picture_.get()),
              VXT_ERROR_CANCELLED);
    // The picture holds what it held, and the next one may be asked for.
    const vxt_picture_view view = viewOf(*picture_);
    EXPECT_THAT(std::vector<std::uint8_t>(view.rgba, view.rgba + view.bytes), ElementsAreArray(expected));
    vxt_cancel_set(cancel.get(), 0);
    EXPECT_EQ(byC(), expected);
    const Result<Picture> cancelled =
        cppParts_->blocking.render(cpp_, {kWidth, kHeight}, [](std::uint32_t, std::uint32_t) { return false; });
    ASSERT_FALSE(cancelled.ok());
    EXPECT_EQ(cancelled.error().code, ErrorCode::Cancelled);
    EXPECT_EQ(byCpp(), expected);
}

TEST_F(CPictures, VerticesAreRecordedOrWrapped) {
    const std::vector<Colour> colours = vertexColours();
    mesh_.paint = VXT_PAINT_VERTICES;
    mesh_.vertices = vertices_.get();
    const std::vector<std::uint8_t> expected = byC();
    const auto recorded = made(vxt_painted_vertices_destroy, vxt_painted_vertices_create, renderer(),
                               colours.front().data(), colours.size());
    RawVulkan raw(gpu().device);
    const VkCommandBuffer commands = raw.begin();
    need(vxt_painted_vertices_cmd_upload(recorded.get(), commands));
    raw.submitAndWait(commands);
    vxt_painted_vertices_release_staging(recorded.get());
    mesh_.vertices = recorded.get();
    EXPECT_EQ(byC(), expected);
    std::vector<std::uint32_t> words;
    for (const Colour& colour : colours) {
        words.push_back(static_cast<std::uint32_t>(std::lround(255 * colour[0])) |
                        static_cast<std::uint32_t>(std::lround(255 * colour[1])) << 8U |
                        static_cast<std::uint32_t>(std::lround(255 * colour[2])) << 16U);
    }
    const RawVulkan::HostBuffer buffer =
        raw.makeBuffer(std::span<const std::uint32_t>(words), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const vxt_buffer_range range{buffer.buffer, 0, 4 * words.size()};
    const auto wrapped = made(vxt_painted_vertices_destroy, vxt_painted_vertices_wrap, renderer(), &range);
    mesh_.vertices = wrapped.get();
    EXPECT_EQ(byC(), expected);
    mesh_.vertices = nullptr;
    EXPECT_THAT(refused(), HasSubstr("no colours of vertices"));
}

TEST_F(CPictures, AreRecordedIntoTheCallersCommands) {
    // All that was made in one go above, by a renderer of the caller's and recorded uploads.
    const auto own = made(vxt_renderer_destroy, vxt_renderer_create, context_.get(), VK_FORMAT_R8G8B8A8_UNORM);
    const auto targets = made(vxt_render_targets_destroy, vxt_render_targets_create, own.get(), kWidth, kHeight);
    const std::vector<vxt_control_point> points = cPoints(scene_.points);
    vxt_render_function_desc desc = sized<vxt_render_function_desc>();
    desc.domain = {scene_.domain.lo, scene_.domain.hi};
    desc.points = points.data();
    desc.point_count = points.size();
    desc.opacity_unit = 0.4;
    desc.step = 0.05;
    const auto function = made(vxt_render_function_destroy, vxt_render_function_create, own.get(), &desc);
    EXPECT_EQ(vxt_render_function_visible(function.get()), 1U);
    const vxt_mesh_view view = cMesh(scene_.mesh);
    // Those of another shape, which are updated.
    MeshData bent = scene_.mesh;
    bent.positions[2] += 0.4F;
    const vxt_mesh_view bentView = cMesh(bent);
    const auto normals = made(vxt_mesh_normals_destroy, vxt_mesh_normals_create, own.get(), &bentView);
    const std::uint32_t chosen = 1;
    const auto painted = made(vxt_painted_triangles_destroy, vxt_painted_triangles_create, own.get(), 2, &chosen, 1);
    OwnImage image(gpu().device, {kWidth, kHeight});
    const VkCommandBuffer commands = image.raw.begin();
    need(vxt_render_function_cmd_upload(function.get(), commands));
    desc.colours = kCColours;
    desc.colour_count = std::size(kCColours);
    need(vxt_render_function_cmd_update(function.get(), commands, &desc));
    need(vxt_mesh_normals_cmd_upload(normals.get(), commands));
    need(vxt_mesh_normals_cmd_update(normals.get(), commands, &view));
    need(vxt_painted_triangles_cmd_upload(painted.get(), commands));
    const Target cppTarget = [&] {
        RenderTargets unused = take(RenderTargets::create(cppParts_->blocking.renderer(), {kWidth, kHeight}));
        return image.target(unused);
    }();
    vxt_picture_target target = sized<vxt_picture_target>();
    target.targets = targets.get();
    target.view = cppTarget.view;
    target.extent = cppTarget.extent;
    target.layout = cppTarget.layout;
    mesh_.paint = VXT_PAINT_TRIANGLES;
    mesh_.triangles = painted_.get();
    const std::vector<std::uint8_t> expected = byC();
    mesh_.triangles = painted.get();
    mesh_.normals = normals.get();
    c_.function = function.get();
    need(vxt_renderer_cmd_render(own.get(), commands, &c_, &target));
    const std::uint8_t* const pixels = image.cmdCopy(commands);
    image.raw.submitAndWait(commands);
    vxt_mesh_normals_release_staging(normals.get());
    vxt_painted_triangles_release_staging(painted.get());
    EXPECT_EQ(std::vector(pixels, pixels + image.bytes()), expected);

    const VkCommandBuffer unused = image.raw.begin();
    target.targets = nullptr;
    EXPECT_EQ(vxt_renderer_cmd_render(own.get(), unused, &c_, &target), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(context_.get()), HasSubstr("Target::view or targets is null"));
    image.raw.submitAndWait(unused);
}

TEST_F(CPictures, RefuseWhatTheCppInterfaceRefuses) {
    const std::vector<std::uint8_t> before = byC();
    mesh_.mesh = nullptr;
    EXPECT_EQ(refused(), "mesh: mesh is null");
    mesh_.mesh = sides_->mesh.get();
    mesh_.struct_size = 3;
    EXPECT_THAT(refused(), HasSubstr("mesh 0: struct_size is 3"));
    mesh_.struct_size = sizeof mesh_;
    mesh_.world_from_object[3] = std::nan("");
    EXPECT_THAT(refused(), HasSubstr("the mesh's pose"));
    mesh_.world_from_object[3] = 0;
    mesh_.paint = static_cast<vxt_paint>(17);
    EXPECT_THAT(refused(), HasSubstr("there is no paint number 17"));
    mesh_.paint = VXT_PAINT_TRIANGLES;
    EXPECT_THAT(refused(), HasSubstr("no triangles to paint"));
    mesh_.paint = VXT_PAINT_PLAIN;
    lighting_.ambient = std::nan("");
    EXPECT_THAT(refused(), HasSubstr("the lighting has a value of nan"));
    lighting_ = sized<vxt_lighting>();
    c_.clip_plane_count = 7;
    std::vector<vxt_clip_plane> planes(7, plane_);
    c_.clip_planes = planes.data();
    EXPECT_THAT(refused(), HasSubstr("7 clip planes"));
    c_.clip_plane_count = 1000;
    EXPECT_THAT(refused(), HasSubstr("1000 clip planes"));
    c_.clip_plane_count = SIZE_MAX;
    EXPECT_THAT(refused(), HasSubstr("clip_planes: 18446744073709551615 are too many"));
    c_.clip_plane_count = 0;
    c_.clip_from_world[15] = std::nan("");
    EXPECT_THAT(refused(), HasSubstr("clip_from_world"));
    c_.volume = nullptr;
    EXPECT_EQ(refused(), "scene: volume is null");
    const vxt_picture_view view = viewOf(*picture_);
    EXPECT_EQ(std::vector(view.rgba, view.rgba + view.bytes), before) << "a refusal changed the picture";
    vxt_renderer* none = nullptr;
    for (const int format : {0x7fffffff, -1, 185}) { // which no driver may be asked about
        EXPECT_EQ(vxt_renderer_create(context_.get(), static_cast<VkFormat>(format), &none), VXT_ERROR_UNSUPPORTED);
    }
    EXPECT_EQ(vxt_blocking_renderer_render(nullptr, &c_, 1, 1, nullptr, nullptr, picture_.get()),
              VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_blocking_renderer_render(blocking_.get(), nullptr, 1, 1, nullptr, nullptr, picture_.get()),
              VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_blocking_renderer_render(blocking_.get(), &c_, 1, 1, nullptr, nullptr, nullptr),
              VXT_ERROR_INVALID_ARGUMENT);
}

TEST_F(CPictures, WrapATriangleMaskOfADetector) {
    // The same mask as painted_ has, but where a detector left it: both triangles are touched.
    vxt_raster_desc desc = sized<vxt_raster_desc>();
    desc.method = VXT_METHOD_ATOMIC;
    desc.outputs = VXT_OUTPUT_TRIANGLES;
    vxt_results_desc resultsDesc = sized<vxt_results_desc>();
    resultsDesc.triangle_room = 2;
    const Owned<vxt_detector> detector = newDetector(desc);
    const Owned<vxt_results> results = newResults(*detector, resultsDesc);
    const COneItem of(*sides_, scene_);
    RawVulkan raw(gpu().device);
    const VkCommandBuffer commands = raw.begin();
    need(vxt_detector_cmd_detect(detector.get(), commands, &of.batch, results.get()));
    raw.submitAndWait(commands);
    vxt_buffer_range mask{};
    need(vxt_results_on_device(results.get(), VXT_DEVICE_TRIANGLE_MASK, &mask));
    const auto wrapped = made(vxt_painted_triangles_destroy, vxt_painted_triangles_wrap, renderer(), &mask);
    const std::uint32_t all[] = {0, 1};
    const auto both = made(vxt_painted_triangles_destroy, vxt_painted_triangles_upload, renderer(), &queue_, 2, all, 2);
    mesh_.paint = VXT_PAINT_TRIANGLES;
    mesh_.triangles = both.get();
    const std::vector<std::uint8_t> expected = byC();
    mesh_.triangles = wrapped.get();
    EXPECT_EQ(byC(), expected);
    vxt_painted_triangles* none = nullptr;
    mask.offset = 3;
    EXPECT_EQ(vxt_painted_triangles_wrap(renderer(), &mask, &none), VXT_ERROR_INVALID_ARGUMENT);
    const std::uint32_t beyond = 2;
    EXPECT_EQ(vxt_painted_triangles_create(renderer(), 2, &beyond, 1, &none), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(none, nullptr);
}

} // namespace
} // namespace voxtact::test
