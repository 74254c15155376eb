// SPDX-License-Identifier: MIT
// glTF 2 as its specification says; each expected position is worked out by hand.
#include "io_test_support.h"

#include <nlohmann/json.hpp>

namespace voxtact::test {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;

constexpr int kUnsignedByte = 5121;
constexpr int kShort = 5122;
constexpr int kUnsignedShort = 5123;
constexpr int kFloat = 5126;

std::string base64(const std::string& bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned bits = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            bits = bits << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63U];
        }
    }
    return text;
}

/// A file that is put together from accessors; the first mesh is one primitive.
class Gltf {
  public:
    Json json = {{"asset", {{"version", "2.0"}}},
                 {"scene", 0},
                 {"scenes", {{{"nodes", {0}}}}},
                 {"nodes", {{{"mesh", 0}}}},
                 {"meshes", {{{"primitives", {{{"attributes", Json::object()}}}}}}},
                 {"accessors", Json::array()},
                 {"bufferViews", Json::array()}};

    template <class Number> std::size_t view(const std::vector<Number>& numbers) {
        const std::size_t offset = bytes_.size();
        for (const Number number : numbers) {
            append(bytes_, number);
        }
        json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes_.size() - offset}});
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
        return json["bufferViews"].size() - 1;
    }
    template <class Number>
    std::size_t accessor(int component, const std::string& type, std::size_t count,
                         const std::vector<Number>& numbers) {
        json["accessors"].push_back(
            {{"bufferView", view(numbers)}, {"componentType", component}, {"type", type}, {"count", count}});
        return json["accessors"].size() - 1;
    }
    /// The triangle (0,0,0), (1,0,0), (0,1,0).
    Gltf& withTriangle() {
        primitive()["attributes"]["POSITION"] = accessor<float>(kFloat, "VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
        return *this;
    }
    Gltf& withIndices(const std::vector<std::uint8_t>& indices) {
        primitive()["indices"] = accessor(kUnsignedByte, "SCALAR", indices.size(), indices);
        return *this;
    }
    Json& primitive() { return json["meshes"][0]["primitives"][0]; }

    [[nodiscard]] std::string text() const {
        Json whole = json;
        whole["buffers"] = {
            {{"byteLength", bytes_.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes_)}}};
        return whole.dump();
    }
    [[nodiscard]] std::string glb() const {
        Json whole = json;
        whole["buffers"] = {{{"byteLength", bytes_.size()}}};
        std::string text = whole.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string file = "glTF";
        append(file, std::uint32_t{2});
        append(file, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bytes_.size()));
        append(file, static_cast<std::uint32_t>(text.size()));
        append(file, std::uint32_t{0x4E4F534A});
        file += text;
        append(file, static_cast<std::uint32_t>(bytes_.size()));
        append(file, std::uint32_t{0x004E4942});
        return file + bytes_;
    }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

Result<MeshData> read(const std::string& content, const std::string& name = "m.gltf") {
    return io::readMesh(std::as_bytes(std::span(content)), name);
}

/// The corners of all triangles, or nothing where the file is refused.
std::vector<double> cornersOf(const Gltf& file) {
    const auto mesh = read(file.text());
    EXPECT_TRUE(isOk(mesh));
    std::vector<double> list;
    if (mesh.ok()) {
        for (const std::uint32_t index : mesh->indices) {
            list.insert(list.end(), mesh->positions.begin() + std::ptrdiff_t{3} * index,
                        mesh->positions.begin() + std::ptrdiff_t{3} * index + 3);
        }
    }
    return list;
}

TEST(Gltf, NodesAreApplied) {
    Gltf file = Gltf().withTriangle().withIndices({0, 1, 2});
    file.json["nodes"] = Json::parse(R"([{"translation": [10, 0, 0], "children": [1, 2]}, {"mesh": 0},
        {"mesh": 0, "scale": [-1, 1, 1], "translation": [0, 0, 5]}])");
    EXPECT_THAT(cornersOf(file),
                ElementsAre(10, 0, 0, 11, 0, 0, 10, 1, 0, /* mirrored and turned */ 10, 0, 5, 10, 1, 5, 9, 0, 5));
    // A quarter turn about z, then twice the size along x, then moved.
    file.json["nodes"] = Json::parse(
        R"([{"mesh": 0, "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476], "scale": [2, 1, 1], "translation": [1, 2, 3]}])");
    EXPECT_THAT(cornersOf(file),
                testing::Pointwise(testing::DoubleNear(1e-6), std::vector<double>{1, 2, 3, 1, 4, 3, 0, 2, 3}));
    file.json["nodes"] = Json::parse(R"([{"mesh": 0, "matrix": [0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1]}])");
    EXPECT_THAT(cornersOf(file), ElementsAre(1, 2, 3, 1, 4, 3, 0, 2, 3));
}

TEST(Gltf, ScenesAreChosenAndSaid) {
    Gltf file = Gltf().withTriangle();
    const auto notes = [&] {
        const auto mesh = read(file.text());
        EXPECT_TRUE(isOk(mesh));
        return mesh.ok() ? mesh->notes : std::vector<std::string>();
    };
    EXPECT_THAT(notes(), ElementsAre());
    file.json["nodes"] = Json::parse(R"([{"mesh": 0}, {"children": [2]}, {"mesh": 0, "translation": [5, 0, 0]}])");
    file.json["scenes"] = Json::parse(R"([{"nodes": [0]}, {"nodes": [1]}])");
    file.json["scene"] = 1;
    EXPECT_THAT(notes(), ElementsAre("scene 1 of 2 is taken, counted from 0"));
    EXPECT_THAT(cornersOf(file), ElementsAre(5, 0, 0, 6, 0, 0, 5, 1, 0));
    file.json.erase("scene");
    EXPECT_THAT(cornersOf(file), ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0));
    file.json.erase("scenes");
    EXPECT_THAT(notes(), ElementsAre("the file has no scene: all its nodes are taken"));
    EXPECT_EQ(cornersOf(file).size(), 18U);
    file.json.erase("nodes");
    EXPECT_THAT(notes(), ElementsAre("the file has no scene and no nodes: all its meshes are taken as they are"));
    EXPECT_EQ(cornersOf(file).size(), 9U);
    file.json["nodes"] = Json::parse(R"([{"mesh": 0}])");
    file.json["scenes"] = Json::parse(R"([{"nodes": [0]}])");
    file.json["meshes"].push_back(file.json["meshes"][0]);
    file.json["animations"] = Json::parse(R"([{}])");
    EXPECT_THAT(notes(), ElementsAre("1 meshes that are not in the scene left out",
                                     "animations are left out: the mesh is as it stands before them"));
}

TEST(Gltf, StripsFansPointsAndLines) {
    Gltf file;
    file.primitive()["attributes"]["POSITION"] =
        file.accessor<float>(kFloat, "VEC3", 4, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    file.primitive()["mode"] = 5;
    EXPECT_THAT(cornersOf(file), ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0, /**/ 1, 0, 0, 1, 1, 0, 0, 1, 0));
    file.primitive()["mode"] = 6;
    EXPECT_THAT(cornersOf(file), ElementsAre(1, 0, 0, 0, 1, 0, 0, 0, 0, /**/ 0, 1, 0, 1, 1, 0, 0, 0, 0));
    file.primitive()["mode"] = 4;
    expectRefused(read(file.text()), "a primitive has 4 corners, not three a triangle");
    file.primitive()["mode"] = 7;
    expectRefused(read(file.text()), "a primitive has the unknown mode 7");
    Json triangle = file.primitive();
    triangle["mode"] = 5;
    file.primitive()["mode"] = 3;
    expectRefused(read(file.text()), "it holds no triangle");
    file.json["meshes"][0]["primitives"].push_back(triangle);
    EXPECT_THAT(read(file.text())->notes, ElementsAre("3 points or lines left out"));
}

TEST(Gltf, SparseAccessors) {
    Gltf file = Gltf().withTriangle();
    Json& accessor = file.json["accessors"][0];
    const std::size_t indices = file.view<std::uint8_t>({1, 2});
    const std::size_t values = file.view<float>({7, 8, 9, 4, 5, 6});
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
                          {"values", {{"bufferView", values}}}};
    EXPECT_THAT(cornersOf(file), ElementsAre(0, 0, 0, 7, 8, 9, 4, 5, 6));
    Gltf zeros = file;
    zeros.json["accessors"][0].erase("bufferView");
    EXPECT_THAT(cornersOf(zeros), ElementsAre(0, 0, 0, 7, 8, 9, 4, 5, 6));
    zeros.json["accessors"][0]["count"] = 3000000U;
    expectRefused(read(zeros.text()), "a sparse accessor states 3000000 positions without data");
    Gltf bad = file;
    bad.json["accessors"][0]["sparse"]["count"] = 3;
    expectRefused(read(bad.text()), "accessor 0 reaches beyond its buffer");
    bad = file;
    bad.json["accessors"][0]["count"] = 2;
    expectRefused(read(bad.text()), "indices do not ascend, or are out of range");
    bad = file;
    bad.json["accessors"][0]["sparse"]["indices"]["componentType"] = kFloat;
    expectRefused(read(bad.text()), "its indices are not whole numbers");
    bad.json["accessors"][0].erase("sparse");
    bad.json["accessors"][0].erase("bufferView");
    expectRefused(read(bad.text()), "accessor 0 has no data");
}

/// Two joints: one 2 along x, below a node that is 10 along y; one at the origin.
Gltf skinned() {
    Gltf file = Gltf().withTriangle();
    file.primitive()["attributes"]["JOINTS_0"] =
        file.accessor<std::uint8_t>(kUnsignedByte, "VEC4", 3, {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0});
    file.primitive()["attributes"]["WEIGHTS_0"] =
        file.accessor<float>(kFloat, "VEC4", 3, {1, 0, 0, 0, 1, 0, 0, 0, 0.25F, 0.75F, 0, 0});
    // The place of the skinned node itself means nothing.
    file.json["nodes"] = Json::parse(R"([{"mesh": 0, "skin": 0, "translation": [100, 100, 100]},
        {"translation": [0, 10, 0], "children": [2]}, {"translation": [2, 0, 0]}, {}])");
    file.json["scenes"] = Json::parse(R"([{"nodes": [0, 1, 3]}])");
    file.json["skins"] = Json::parse(R"([{"joints": [2, 3]}])");
    return file;
}

TEST(Gltf, SkinsWithoutInverseBindMatricesHaveTheIdentity) {
    // (0,0,0) + (2,10,0); (1,0,0); a quarter of (2,11,0) and three of (0,1,0).
    EXPECT_THAT(cornersOf(skinned()), ElementsAre(2, 10, 0, 1, 0, 0, 0.5F, 3.5F, 0));
}

TEST(Gltf, InverseBindMatricesAreApplied) {
    Gltf file = skinned();
    std::vector<float> matrices;
    for (const float x : {-2.F, -1.F}) {
        matrices.insert(matrices.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1});
    }
    file.json["skins"][0]["inverseBindMatrices"] = file.accessor(kFloat, "MAT4", 2, matrices);
    EXPECT_THAT(cornersOf(file), ElementsAre(0, 10, 0, 0, 0, 0, -0.75F, 3.5F, 0));
    file.json["accessors"].back()["count"] = 1;
    expectRefused(read(file.text()), "skin 0 has 2 joints and only 1 inverse bind matrices");
}

TEST(Gltf, SkinsThatCannotBe) {
    Gltf file = skinned();
    file.primitive()["attributes"].erase("JOINTS_0");
    expectRefused(read(file.text()), "a node has a skin, but its mesh has no joints or weights (JOINTS_0");
    file = skinned();
    file.json["skins"][0]["joints"] = {2};
    expectRefused(read(file.text()), "vertex 1 of a skinned mesh has joint 1, its skin has 1");
    file.json["skins"][0]["joints"] = {2, 9};
    expectRefused(read(file.text()), "it refers to node 9, which does not exist");
    file = skinned();
    file.json["nodes"][0]["skin"] = 3;
    expectRefused(read(file.text()), "number 3 of its 'skins', which does not exist");
    file = skinned();
    file.json["accessors"][2]["byteOffset"] = 4; // the weights one along
    file.json["accessors"][2]["count"] = 2;
    expectRefused(read(file.text()), "another number of joints or weights");
    file = skinned();
    file.primitive()["attributes"]["WEIGHTS_0"] = file.accessor<float>(kFloat, "VEC4", 3, std::vector<float>(12, 0));
    expectRefused(read(file.text()), "the weights of vertex 0 of a skinned mesh do not sum to 1");
}

TEST(Gltf, MorphTargetsAtTheWeightsOfTheFile) {
    Gltf file = Gltf().withTriangle();
    const std::size_t moved = file.accessor<float>(kFloat, "VEC3", 3, {0, 0, 4, 0, 0, 8, 0, 0, 0});
    file.primitive()["targets"] = {{{"POSITION", moved}}};
    EXPECT_THAT(cornersOf(file), ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0));
    file.json["meshes"][0]["weights"] = {0.5};
    EXPECT_THAT(cornersOf(file), ElementsAre(0, 0, 2, 1, 0, 4, 0, 1, 0));
    file.json["nodes"][0]["weights"] = {0.25};
    EXPECT_THAT(cornersOf(file), ElementsAre(0, 0, 1, 1, 0, 2, 0, 1, 0));
}

TEST(Gltf, QuantisedPositions) {
    Gltf file;
    file.primitive()["attributes"]["POSITION"] =
        file.accessor<std::int16_t>(kShort, "VEC3", 3, {0, 0, 0, 0, 32767, 0, 0, 0, -32768, -32767, 0, 0});
    file.json["bufferViews"][0]["byteStride"] = 8;
    expectRefused(read(file.text()), "accessor 0 is of a type that what it is used for cannot have");
    file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    EXPECT_THAT(cornersOf(file), ElementsAre(0, 0, 0, 32767, 0, 0, -32768, -32767, 0));
    file.json["accessors"][0]["normalized"] = true;
    EXPECT_THAT(cornersOf(file), ElementsAre(0, 0, 0, 1, 0, 0, -1, -1, 0));
}

TEST(Gltf, Extensions) {
    Gltf file = Gltf().withTriangle();
    for (const char* harmless : {"KHR_materials_unlit", "KHR_texture_transform", "KHR_lights_punctual"}) {
        file.json["extensionsRequired"] = {harmless};
        EXPECT_TRUE(isOk(read(file.text()))) << harmless;
    }
    for (const char* unknown : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "ACME_something"}) {
        file.json["extensionsRequired"] = {unknown};
        expectRefused(read(file.text()),
                      "it requires the extension '" + std::string(unknown) + "', which is not supported");
    }
    file.json.erase("extensionsRequired");
    file.json["extensionsUsed"] = {"KHR_draco_mesh_compression", "EXT_mesh_gpu_instancing"};
    EXPECT_TRUE(isOk(read(file.text())));
    file.json["nodes"][0]["extensions"] = {{"EXT_mesh_gpu_instancing", Json::object()}};
    expectRefused(read(file.text()), "node 0 is repeated by EXT_mesh_gpu_instancing");
    file.json["nodes"][0].erase("extensions");
    file.json["accessors"][0].erase("bufferView");
    expectRefused(read(file.text()), "accessor 0 has no data (compressed by an extension?)");
}

TEST(Gltf, NodesThatCannotBe) {
    const auto refused = [](const char* nodes, const char* reason) {
        Gltf file = Gltf().withTriangle();
        file.json["nodes"] = Json::parse(nodes);
        expectRefused(read(file.text()), reason);
    };
    refused(R"([{"mesh": 0, "translation": {"x": 1}}])", "'translation' is not a list of numbers");
    refused(R"([{"mesh": 0, "translation": ["1", 0, 0]}])", "'translation' is not a list of numbers");
    refused(R"([{"mesh": 0, "translation": [1, 0]}])", "'translation' has 2 numbers, not 3");
    refused(R"([{"mesh": 0, "rotation": [0, 0, 0, 2]}])", "node 0 has a rotation whose length is not 1");
    refused(R"([{"mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1], "scale": [1, 1, 1]}])",
            "node 0 has a matrix and");
    refused(R"([{"mesh": 0, "matrix": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]}])", "whose last row is not 0 0 0 1");
    refused(R"([{"mesh": 0}, {"children": [1]}])", "some of its nodes are below themselves");
    refused(R"([{"mesh": 0}, {"children": [2]}, {"children": [1]}])", "some of its nodes are below themselves");
    refused(R"([{"children": [1, 1]}, {"mesh": 0}])", "node 1 is below two nodes");
    refused(R"([{"children": [7]}])", "it refers to node 7, which does not exist");
    refused(R"([{"mesh": -1}])", "'mesh' is not a natural number");
    refused(R"([{"mesh": 1.5}])", "'mesh' is not a natural number");
    refused(R"([{"mesh": 1}])", "number 1 of its 'meshes', which does not exist");
    refused(R"([7])", "number 0 of its 'nodes', which does not exist");
    refused(R"([{"children": [1]}, {}])", "it holds no triangle");
    Gltf file = Gltf().withTriangle();
    file.json["scenes"][0]["nodes"] = {0, 0};
    expectRefused(read(file.text()), "scene 0 has node 0, which does not exist, is below another, or is there twice");
    file.json["scene"] = 4;
    expectRefused(read(file.text()), "number 4 of its 'scenes', which does not exist");
}

TEST(Gltf, RepetitionEndsBeforeMemoryDoes) {
    Gltf file = Gltf().withTriangle().withIndices(std::vector<std::uint8_t>(30000, 0));
    file.json["nodes"] = Json::array();
    file.json["scenes"][0]["nodes"] = Json::array();
    for (int i = 0; i < 2000; ++i) {
        file.json["nodes"].push_back({{"mesh", 0}});
        file.json["scenes"][0]["nodes"].push_back(i);
    }
    expectRefused(read(file.text()), "it repeats its meshes to 20000000 triangles");
}

TEST(Gltf, MalformedFiles) {
    const Gltf good = Gltf().withTriangle().withIndices({0, 1, 2});
    expectRefused(read("{\"asset\": {\"version\": \"1.0\"}}"), "it is glTF '1.0'; glTF 2 is needed");
    expectRefused(read("{\"asset\": {\"version\": \"2.1\", \"minVersion\": \"2.1\"}}"),
                  "it needs a reader of glTF '2.1'");
    expectRefused(read("{\"asset\": {\"version\": 2}}"), "'version' is not a text");
    expectRefused(read("{}"), "no 'asset'");
    expectRefused(read("[]"), "no 'asset'");
    expectRefused(read("{\"asset\":"), "it is not a proper glTF file");
    expectRefused(read("{\"asset\": {\"version\": \"2.0\"}}"), "it holds no triangle");
    expectRefused(read(std::string(100000, '[')), "it is not a proper glTF file");
    // The text of a buffer that never ends: not all of it is told.
    const std::string text = read("{\"buffers\": [{\"uri\": \"data:;base64," + std::string(100000, 'A')).error().text;
    EXPECT_LT(text.size(), 500U);
    EXPECT_THAT(text, testing::AllOf(testing::HasSubstr("parse error at line 1"),
                                     testing::HasSubstr("data:;base64,AAA"), testing::EndsWith("AAA'")));
    const auto refused = [&](const char* patch, const char* reason) {
        Gltf file = good;
        Json whole = Json::parse(file.text()).patch(Json::parse(patch));
        expectRefused(read(whole.dump()), reason);
    };
    refused(R"([{"op": "replace", "path": "/accessors/0/count", "value": 4}])", "accessor 0 reaches beyond its buffer");
    refused(R"([{"op": "replace", "path": "/accessors/0/count", "value": 0}])", "accessor 0 has no elements");
    refused(R"([{"op": "replace", "path": "/accessors/0/count", "value": 18446744073709551615}])", "beyond its buffer");
    refused(R"([{"op": "add", "path": "/accessors/0/byteOffset", "value": -12}])",
            "'byteOffset' is not a natural number");
    refused(R"([{"op": "add", "path": "/accessors/0/byteOffset", "value": 18446744073709551615}])",
            "beyond its buffer");
    refused(R"([{"op": "add", "path": "/bufferViews/0/byteStride", "value": 4}])",
            "accessor 0 has elements that overlap");
    refused(R"([{"op": "add", "path": "/bufferViews/0/byteLength", "value": 1000}])", "buffer view 0 reaches beyond");
    refused(R"([{"op": "replace", "path": "/buffers/0/byteLength", "value": 41}])",
            "buffer 0 has 40 bytes, 41 are stated");
    refused(R"([{"op": "replace", "path": "/buffers/0/uri", "value": "data:application/octet-stream;base64,AA*A"}])",
            "a buffer's base64 is damaged");
    refused(R"([{"op": "replace", "path": "/buffers/0/uri", "value": "other.bin"}])",
            "its buffer 'other.bin' is another file");
    refused(R"([{"op": "replace", "path": "/buffers/0/uri", "value": "https://a/b.bin"}])",
            "is not in a file in its folder");
    refused(R"([{"op": "remove", "path": "/buffers/0/uri"}])", "buffer 0 has no data");
    refused(R"([{"op": "replace", "path": "/accessors/0/componentType", "value": 5122}])", "accessor 0 is of a type");
    refused(R"([{"op": "replace", "path": "/meshes/0/primitives/0/attributes", "value": {}}])", "has no positions");
    refused(R"([{"op": "replace", "path": "/meshes/0/primitives/0/attributes/POSITION", "value": 9}])",
            "number 9 of its 'accessors', which does not exist");
    expectRefused(read(Gltf().withTriangle().withIndices({0, 1, 2, 0, 1, 7}).text()),
                  "a triangle uses vertex 7, its primitive has 3");
}

TEST(Gltf, BinaryContainer) {
    const std::string glb = Gltf().withTriangle().withIndices({2, 1, 0}).glb();
    for (const char* name : {"m.glb", "m.gltf"}) {
        const auto mesh = read(glb, name);
        ASSERT_TRUE(isOk(mesh));
        EXPECT_THAT(mesh->positions, ElementsAre(0, 1, 0, 1, 0, 0, 0, 0, 0));
    }
    for (std::size_t length = 1; length < glb.size(); ++length) {
        expectRefused(read(glb.substr(0, length), "m.glb"), "m.glb");
    }
    expectRefused(read("glTF", "m.glb"), "it is not a GLB file");
    std::string other = glb;
    other[4] = 1;
    expectRefused(read(other, "m.glb"), "it is glTF 1; glTF 2 is needed");
    other = glb;
    other[16] = 'X';
    expectRefused(read(other, "m.glb"), "its first chunk is not JSON");
}

TEST(Gltf, BuffersInOtherFiles) {
    const TemporaryFolder folder;
    Gltf file = Gltf().withTriangle();
    file.json["buffers"] = {{{"byteLength", file.bytes().size()}, {"uri", "a%20b%2.bin"}}};
    const auto path = folder.write("m.gltf", file.json.dump());
    expectRefused(io::readMesh(path), "a b%2.bin': there is no such file");
    folder.write("a b%2.bin", file.bytes());
    const auto mesh = io::readMesh(path);
    ASSERT_TRUE(isOk(mesh));
    EXPECT_EQ(mesh->indices.size(), 3U);
}

} // namespace
} // namespace voxtact::test
