// SPDX-License-Identifier: MIT
// The files of contacts for other programs say what the CSV says. No device is needed.
#include "cli_fixture.h"

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

namespace voxtact::test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

class ContactFormatsTest : public CliTest {
  protected:
    ContactFormatsTest() {
        output({"make", "poses", "--volume", "builtin:head:30", "--mesh", "builtin:scalpel:500", "--number", "30",
                "--seed", "7", "--output", path("poses.txt")});
    }
    /// The file, and the CSV of the same contacts (without its header).
    [[nodiscard]] std::vector<std::vector<std::string>> contacts(const std::string& file,
                                                                 const Arguments& more = {}) const {
        for (const std::string& to : {file, path("contacts.csv")}) {
            Arguments all{"count",   "--volume",        "builtin:head:30", "--mesh", "builtin:scalpel:500",
                          "--poses", path("poses.txt"), "--method",        "cpu",    "--contacts",
                          to,        "--output",        path("rows.csv")};
            all.insert(all.end(), more.begin(), more.end());
            output(all);
        }
        std::vector<std::vector<std::string>> rows;
        for (const std::string& line : linesOf(readText(path("contacts.csv")))) {
            rows.push_back(fieldsOf(line));
        }
        rows.erase(rows.begin());
        return rows;
    }
};

/// Reads what the specification of VTK's XML files says: arrays at offsets behind the underscore, each with its bytes
/// in front.
class Vtp {
  public:
    explicit Vtp(std::string text) : text_(std::move(text)), data_(text_.find("encoding=\"raw\">\n_") + 17) {}

    [[nodiscard]] std::size_t count(const std::string& attribute) const {
        const std::size_t at = text_.find(attribute + "=\"");
        return std::stoul(text_.substr(at + attribute.size() + 2));
    }
    template <class Number>
    [[nodiscard]] std::vector<Number> array(const std::string& name, std::size_t from = 0) const {
        const std::size_t tag = text_.find("Name=\"" + name + "\"", from);
        EXPECT_LT(tag, data_) << name;
        const std::size_t offset = text_.find("offset=\"", tag);
        const std::size_t at = data_ + std::stoul(text_.substr(offset + 8));
        std::uint64_t bytes = 0;
        std::memcpy(&bytes, text_.data() + at, sizeof bytes);
        std::vector<Number> numbers(bytes / sizeof(Number));
        EXPECT_LE(at + sizeof bytes + bytes, text_.size());
        std::memcpy(numbers.data(), text_.data() + at + sizeof bytes, bytes);
        return numbers;
    }
    [[nodiscard]] std::size_t find(const std::string& element) const { return text_.find("<" + element + ">"); }

  private:
    std::string text_;
    std::size_t data_;
};

TEST_F(ContactFormatsTest, VtpHasTheContacts) {
    const auto rows = contacts(path("c.vtp"));
    ASSERT_GT(rows.size(), 20U);
    const Vtp vtp(readText(path("c.vtp")));
    ASSERT_EQ(vtp.count("NumberOfPoints"), rows.size());
    ASSERT_EQ(vtp.count("NumberOfVerts"), rows.size());
    ASSERT_EQ(vtp.count("NumberOfLines"), 0U);
    const auto points = vtp.array<double>("Points");
    const auto normals = vtp.array<double>("normal");
    const auto depths = vtp.array<double>("depth");
    const auto triangles = vtp.array<std::int64_t>("triangle");
    const auto poses = vtp.array<std::int64_t>("pose");
    const auto vertices = vtp.array<std::int64_t>("connectivity", vtp.find("Verts"));
    const auto offsets = vtp.array<std::int64_t>("offsets", vtp.find("Verts"));
    ASSERT_EQ(points.size(), 3 * rows.size());
    ASSERT_EQ(normals.size(), 3 * rows.size());
    ASSERT_EQ(vertices.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(std::to_string(poses.at(i)), rows[i].at(0));
        EXPECT_EQ(std::to_string(triangles.at(i)), rows[i].at(1));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(points[3 * i + axis], std::stod(rows[i].at(2 + axis)), 1e-6);
            EXPECT_NEAR(normals[3 * i + axis], std::stod(rows[i].at(5 + axis)), 1e-6);
        }
        EXPECT_NEAR(depths.at(i), std::stod(rows[i].at(8)), 1e-6);
        EXPECT_EQ(vertices[i], static_cast<std::int64_t>(i));
        EXPECT_EQ(offsets[i], static_cast<std::int64_t>(i + 1));
    }
}

TEST_F(ContactFormatsTest, VtpHasTheBoxes) {
    const auto rows = contacts(path("c.vtp"), {"--bounds"});
    const Vtp vtp(readText(path("c.vtp")));
    std::size_t boxes = 0;
    std::vector<std::vector<std::string>> bounds;
    for (const std::string& line : linesOf(readText(path("rows.csv")))) {
        const auto fields = fieldsOf(line);
        if (fields.at(3) == "1") {
            bounds.push_back(fields);
            ++boxes;
        }
    }
    ASSERT_GT(boxes, 1U);
    ASSERT_EQ(vtp.count("NumberOfLines"), 12 * boxes);
    ASSERT_EQ(vtp.count("NumberOfPoints"), rows.size() + 8 * boxes);
    const auto points = vtp.array<double>("Points");
    const auto depths = vtp.array<double>("depth");
    const auto lines = vtp.array<std::int64_t>("connectivity", vtp.find("Lines"));
    ASSERT_EQ(lines.size(), 24 * boxes);
    EXPECT_TRUE(std::isnan(depths.back())) << "a corner has no depth";
    for (std::size_t box = 0; box < boxes; ++box) {
        // pose,mesh,volume,touch,count,count_exact,method,projection,contacts,depth,min_x,min_y,min_z,max_x,max_y,max_z
        const std::size_t first = 3 * (rows.size() + 8 * box);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(points[first + axis], std::stod(bounds[box].at(10 + axis)), 1e-5);
            EXPECT_NEAR(points[first + 21 + axis], std::stod(bounds[box].at(13 + axis)), 1e-5);
        }
        // A side runs along one axis.
        for (std::size_t side = 0; side < 12; ++side) {
            std::size_t different = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto coordinate = [&](std::size_t end) {
                    return points[3 * static_cast<std::size_t>(lines[24 * box + 2 * side + end]) + axis];
                };
                different += coordinate(0) != coordinate(1) ? 1 : 0;
            }
            EXPECT_EQ(different, 1U);
        }
    }
}

TEST_F(ContactFormatsTest, MarkupsHaveTheContactsAndTheBoxes) {
    const auto rows = contacts(path("c.mrk.json"), {"--bounds"});
    const Json json = Json::parse(readText(path("c.mrk.json")));
    EXPECT_THAT(json.at("@schema").get<std::string>(), HasSubstr("markups-schema-v1"));
    const Json& list = json.at("markups").at(0);
    EXPECT_EQ(list.at("type"), "Fiducial");
    EXPECT_EQ(list.at("coordinateSystem"), "LPS");
    ASSERT_EQ(list.at("controlPoints").size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Json& point = list["controlPoints"][i];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(point.at("position").at(axis).get<double>(), std::stod(rows[i].at(2 + axis)), 1e-6);
        }
        EXPECT_EQ(point.at("label"), rows[i].at(0) + "-" + rows[i].at(1));
    }
    ASSERT_GT(json.at("markups").size(), 2U);
    const Json& box = json["markups"][1];
    EXPECT_EQ(box.at("type"), "ROI");
    EXPECT_EQ(box.at("coordinateSystem"), "LPS");
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GE(box.at("size").at(axis).get<double>(), 0);
    }
}

TEST_F(ContactFormatsTest, NamesThatAreAwkwardInXml) {
    const std::string name = path("a--b <&> \"c\" \xEF\xBF\xBE\xEF\xBF\xBF.stl");
    output({"make", "mesh", "builtin:scalpel:500", name});
    output({"count", "--volume", "builtin:head:30", "--mesh", name, "--method", "cpu", "--contacts", path("c.vtp")});
    const std::string text = readText(path("c.vtp"));
    const std::string comment = text.substr(0, text.find("<VTKFile"));
    EXPECT_THAT(comment, HasSubstr("a- -b &lt;&amp;&gt; &quot;c&quot; \\xef\\xbf\\xbe\\xef\\xbf\\xbf.stl"));
    EXPECT_EQ(comment.find("--", comment.find("<!--") + 4), comment.rfind("-->"));
}

} // namespace
} // namespace voxtact::test
