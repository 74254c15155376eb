// SPDX-License-Identifier: MIT
#pragma once

#include "io/volume/stored_image.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

namespace voxtact::io {

/// Why a .vtp file cannot be used. Thrown inside the reader; readVtp() makes an Error of it.
struct VtpRefusal {
    std::string reason;
};

/// The attribute as a natural number; 0 if there is none.
[[nodiscard]] std::uint64_t vtpNatural(pugi::xml_node node, const char* attribute);

/// The arrays of VTK's XML files: in text, in base64 or appended, plain or compressed by zlib.
class VtpData {
  public:
    /// `root`: VTKFile. `appended`: the data after the underscore of AppendedData, in base64 if `isBase64`.
    VtpData(pugi::xml_node root, std::string_view appended, bool isBase64);

    [[nodiscard]] std::vector<double> reals(pugi::xml_node array) const;
    [[nodiscard]] std::vector<std::uint64_t> naturals(pugi::xml_node array) const;
    /// The first text of an array of texts.
    [[nodiscard]] std::string text(pugi::xml_node array) const;

  private:
    /// Takes bytes from the front of a block.
    struct Block {
        std::string_view rest;
        bool isBase64 = false;
        [[nodiscard]] std::string take(std::uint64_t count);
    };

    [[nodiscard]] std::string bytesOf(pugi::xml_node array) const;
    [[nodiscard]] std::string plain(Block block) const;
    [[nodiscard]] std::string inflated(Block block) const;
    [[nodiscard]] std::uint64_t headerNumber(std::string_view header, std::size_t index) const;
    void checkByteOrder(StoredType type) const;

    std::string_view appended_;
    bool isBase64_;
    bool isSwapped_ = false;
    bool hasByteOrder_ = false;
    bool isCompressed_ = false;
    std::size_t headerBytes_ = 4; ///< of each number that precedes data
};

} // namespace voxtact::io
