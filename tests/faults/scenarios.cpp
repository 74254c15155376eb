// SPDX-License-Identifier: MIT
#include "scenarios.h"
#include "vulkan/context_impl.h"

#include <sstream>

namespace voxtact::test {

VolumeData someVoxels(ScalarType type) {
    const auto value = [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        const bool face = x % 7 == 0 || y % 7 == 0 || z % 7 == 0;
        return face ? 0.0 : 60.0 + 20 * x + 3 * y + z;
    };
    return type == ScalarType::Int16 ? makeVolume<std::int16_t>(unitGrid(8), type, value)
                                     : makeBytes(unitGrid(8), value);
}

std::vector<Mat4> somePoses(std::uint32_t count, double first) {
    std::vector<Mat4> poses;
    for (std::uint32_t i = 0; i < count; ++i) {
        poses.push_back(translation({first + 0.003 * i, 0.02, -0.01}));
    }
    return poses;
}

View someView() {
    return flatView(-0.1, 1.1, 16, 12);
}

TransferFunctionDesc ramp(double top) {
    return {byteRamp(), {0, top}, 32};
}

namespace {

Context makeContext(Play& play) {
    return play.quietly([&] { return Context::create(play.stage().context); });
}

Mesh makeMesh(Play& play, const Context& context, const MeshData& data) {
    return play.quietly(
        [&] { return Mesh::upload(context, play.stage().queue, data.view(), {.clusters = true, .editable = true}); });
}

LabelMap makeLabelMap(Play& play, const Context& context, const VolumeData& like) {
    return play.quietly([&]() -> Result<LabelMap> {
        const Result<LabelData> data = makeLabels(like.view());
        return data.ok() ? LabelMap::upload(context, play.stage().queue, *data) : data.error();
    });
}

} // namespace

Setting::Setting(Play& play)
    : volumeData(someVoxels()), meshData(makeCube(0.2, 0.75)), context(makeContext(play)), volume(play.quietly([&] {
          return Volume::upload(context, play.stage().queue, volumeData.view(), {.bricks = true, .editable = true});
      })),
      function(play.quietly([&] { return TransferFunction::upload(context, play.stage().queue, ramp()); })),
      mesh(makeMesh(play, context, meshData)), labels(makeLabelMap(play, context, volumeData)) {}

BatchItem Setting::item(std::span<const Mat4> poses) const {
    return {&mesh, &volume, &function, poses, &labels};
}

std::string textOf(const BatchAnswer& answer) {
    std::ostringstream out;
    for (const PairAnswer& pair : answer.pairs) {
        out << pair.pair << ' ' << pair.item << ' ' << pair.pose << ' ' << pair.hit << pair.possible << ' '
            << pair.count << '\n';
    }
    for (const TouchedTriangle& triangle : answer.triangles) {
        out << "triangle " << triangle.pair << ' ' << triangle.triangle << ' ' << triangle.count << '\n';
    }
    out << answer.contactsFound << " contacts\n";
    for (const Contact& contact : answer.contacts) {
        out << contact.pair << ' ' << contact.triangle << ' ' << contact.position[0] << ' ' << contact.label << '\n';
    }
    for (const std::optional<Box>& box : answer.bounds) {
        out << "box " << (box ? box->hi[0] : 0) << '\n';
    }
    for (const LabelCount& label : answer.labels) {
        out << "label " << label.pair << ' ' << label.label << ' ' << label.count << '\n';
    }
    out << (answer.gpuMilliseconds > 0 ? "timed\n" : "not timed\n");
    return out.str();
}

std::string textOf(std::span<const PairResult> results) {
    BatchAnswer answer;
    for (const PairResult& result : results) {
        answer.pairs.push_back(unpack(result));
    }
    return textOf(answer);
}

std::string textOf(std::span<const std::uint8_t> bytes) {
    return {bytes.begin(), bytes.end()};
}

} // namespace voxtact::test
