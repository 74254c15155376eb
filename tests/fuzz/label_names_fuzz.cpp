// SPDX-License-Identifier: MIT
// Names of labels.
#include "memory_file.h"
#include "voxtact/io.h"

#include <set>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace voxtact;
    const auto names = io::readLabelNames(fuzz::fileOf(data, size));
    if (!names) {
        fuzz::requireOneLine(names.error().text);
        return 0;
    }
    fuzz::require(!names->empty(), "a file that is read names a label");
    std::set<std::int32_t> seen;
    for (const io::LabelName& label : *names) {
        fuzz::require(!label.name.empty(), "a name is not empty");
        fuzz::require(seen.insert(label.label).second, "a label has one name");
    }
    return 0;
}
