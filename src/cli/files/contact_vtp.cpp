// SPDX-License-Identifier: MIT
#include "cli/files/pair_files.h"
#include "cli/output/text_for_messages.h"
#include "core/base/escaped.h"

#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <ostream>

namespace voxtact::app {

namespace {

static_assert(std::endian::native == std::endian::little, "VTP is written as the bytes lie in memory");

constexpr std::size_t kCorners = 8;
/// Pairs of corners, whose bits are x, y and z.
constexpr std::array<std::array<std::int64_t, 2>, 12> kSides{
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

template <class Number> constexpr const char* kVtkType = "";
template <> constexpr const char* kVtkType<double> = "Float64";
template <> constexpr const char* kVtkType<std::int32_t> = "Int32";
template <> constexpr const char* kVtkType<std::int64_t> = "Int64";

/// Escapes text for attributes and content.
std::string inXml(const std::string& text) {
    std::string out;
    for (const char c : escaped(text)) {
        out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
    }
    return out;
}

/// Arrays of a file: first their tags, then their bytes. Callers add the arrays twice, so that a million contacts need
/// no second copy.
class VtpArrays {
  public:
    VtpArrays(std::ostream& out, bool tags) : out_(out), tags_(tags) {}

    void open(const char* element) {
        if (tags_) {
            out_ << "      <" << element << ">\n";
        }
    }
    void close(const char* element) {
        if (tags_) {
            out_ << "      </" << element << ">\n";
        }
    }
    /// `each` is called with a function that takes the numbers, `count` in all.
    template <class Number, class Each>
    void add(const char* name, std::uint64_t count, const Each& each, unsigned components = 1) {
        const std::uint64_t bytes = count * sizeof(Number);
        if (tags_) {
            out_ << "        <DataArray type=\"" << kVtkType<Number> << "\" Name=\"" << name
                 << "\" NumberOfComponents=\"" << components << "\" format=\"appended\" offset=\"" << offset_
                 << "\"/>\n";
        } else {
            put(bytes);
            each([this](Number number) { put(number); });
        }
        offset_ += sizeof bytes + bytes;
    }

  private:
    template <class Number> void put(Number number) {
        std::array<char, sizeof number> raw{};
        std::memcpy(raw.data(), &number, sizeof number);
        out_.write(raw.data(), raw.size());
    }

    std::ostream& out_;
    bool tags_;
    std::uint64_t offset_ = 0;
};

struct VtpContent {
    const PairOptions& options;
    const ContactList& list;

    [[nodiscard]] std::uint64_t corners() const { return list.bounds.size() * kCorners; }
    [[nodiscard]] std::uint64_t points() const { return list.contacts.size() + corners(); }
    [[nodiscard]] std::uint64_t lines() const { return list.bounds.size() * kSides.size(); }

    void addArrays(VtpArrays& arrays) const;

  private:
    /// Adds a number per contact; corners of boxes get a filler.
    template <class Number, class Get>
    void addOfContacts(VtpArrays& arrays, const char* name, Number none, const Get& get) const {
        arrays.add<Number>(name, points(), [&](const auto& put) {
            for (const KeptContact& kept : list.contacts) {
                put(static_cast<Number>(get(kept.contact)));
            }
            for (std::uint64_t corner = 0; corner < corners(); ++corner) {
                put(none);
            }
        });
    }
    /// Adds a number per cell: the point of a contact, or an edge of a box.
    template <class Get> void addOfCells(VtpArrays& arrays, const char* name, const Get& get) const {
        arrays.add<std::int64_t>(name, list.contacts.size() + lines(), [&](const auto& put) {
            for (const KeptContact& kept : list.contacts) {
                put(static_cast<std::int64_t>(get(kept.job, kept.pose)));
            }
            for (const KeptBounds& kept : list.bounds) {
                for (std::size_t side = 0; side < kSides.size(); ++side) {
                    put(static_cast<std::int64_t>(get(kept.job, kept.pose)));
                }
            }
        });
    }
    void addPoints(VtpArrays& arrays) const;
    void addCells(VtpArrays& arrays) const;
};

void VtpContent::addPoints(VtpArrays& arrays) const {
    arrays.open("Points");
    arrays.add<double>(
        "Points", 3 * points(),
        [&](const auto& put) {
            for (const KeptContact& kept : list.contacts) {
                for (const double coordinate : kept.contact.position) {
                    put(coordinate);
                }
            }
            for (const KeptBounds& kept : list.bounds) {
                for (unsigned corner = 0; corner < kCorners; ++corner) {
                    for (unsigned axis = 0; axis < 3; ++axis) {
                        put((corner >> axis & 1U) != 0 ? kept.box.hi[axis] : kept.box.lo[axis]);
                    }
                }
            }
        },
        3);
    arrays.close("Points");
}

void VtpContent::addCells(VtpArrays& arrays) const {
    const auto contacts = static_cast<std::int64_t>(list.contacts.size());
    const auto count = [](std::int64_t number, std::int64_t step) {
        return [number, step](const auto& put) {
            for (std::int64_t i = 0; i < number; ++i) {
                put(step == 0 ? i : (i + 1) * step);
            }
        };
    };
    arrays.open("Verts");
    arrays.add<std::int64_t>("connectivity", list.contacts.size(), count(contacts, 0));
    arrays.add<std::int64_t>("offsets", list.contacts.size(), count(contacts, 1));
    arrays.close("Verts");
    arrays.open("Lines");
    arrays.add<std::int64_t>("connectivity", 2 * lines(), [&](const auto& put) {
        for (std::size_t box = 0; box < list.bounds.size(); ++box) {
            for (const auto& side : kSides) {
                for (const std::int64_t corner : side) {
                    put(contacts + static_cast<std::int64_t>(box * kCorners) + corner);
                }
            }
        }
    });
    arrays.add<std::int64_t>("offsets", lines(), count(static_cast<std::int64_t>(lines()), 2));
    arrays.close("Lines");
}

void VtpContent::addArrays(VtpArrays& arrays) const {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const PairJobs& jobs = options.jobs;
    arrays.open("PointData");
    arrays.add<double>(
        "normal", 3 * points(),
        [&](const auto& put) {
            for (const KeptContact& kept : list.contacts) {
                for (const double component : kept.contact.normal) {
                    put(component);
                }
            }
            for (std::uint64_t i = 0; i < 3 * corners(); ++i) {
                put(0.0);
            }
        },
        3);
    addOfContacts<double>(arrays, "depth", kNone, [](const Contact& contact) { return contact.depth; });
    addOfContacts<double>(arrays, "value", kNone, [](const Contact& contact) { return contact.value; });
    addOfContacts<double>(arrays, "opacity", kNone, [](const Contact& contact) { return contact.opacity; });
    addOfContacts<std::int32_t>(arrays, "label", 0, [](const Contact& contact) { return contact.label; });
    addOfContacts<std::int64_t>(arrays, "triangle", -1, [](const Contact& contact) { return contact.triangle; });
    arrays.close("PointData");
    arrays.open("CellData");
    addOfCells(arrays, "pose", [](std::uint32_t /*job*/, std::uint64_t pose) { return pose; });
    addOfCells(arrays, "mesh", [&](std::uint32_t job, std::uint64_t /*pose*/) { return jobs.jobs[job].mesh; });
    addOfCells(arrays, "volume", [&](std::uint32_t job, std::uint64_t /*pose*/) { return jobs.jobs[job].volume; });
    arrays.close("CellData");
    addPoints(arrays);
    addCells(arrays);
}

} // namespace

void writeContactsVtp(std::ostream& out, const PairOptions& options, const PairInputs& /*inputs*/,
                      const ContactList& list) {
    const VtpContent content{options, list};
    out << "<?xml version=\"1.0\"?>\n<!-- contacts by voxtact; world, mm, LPS (+x left, +y posterior, +z superior)\n";
    // Two hyphens would end the comment.
    const auto inComment = [](std::string text) {
        for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at)) {
            text.replace(at, 2, "- -");
        }
        return text;
    };
    for (std::size_t i = 0; i < options.jobs.meshes.size(); ++i) {
        out << "mesh " << i << ' ' << inComment(inXml(options.jobs.meshes[i])) << '\n';
    }
    for (std::size_t i = 0; i < options.jobs.volumes.size(); ++i) {
        out << "volume " << i << ' ' << inComment(inXml(options.jobs.volumes[i])) << '\n';
    }
    out << "-->\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        << "  <PolyData>\n    <Piece NumberOfPoints=\"" << content.points() << "\" NumberOfVerts=\""
        << list.contacts.size() << "\" NumberOfLines=\"" << content.lines()
        << "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n";
    VtpArrays tags(out, true);
    content.addArrays(tags);
    out << "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_";
    VtpArrays bytes(out, false);
    content.addArrays(bytes);
    out << "\n  </AppendedData>\n</VTKFile>\n";
}

} // namespace voxtact::app
