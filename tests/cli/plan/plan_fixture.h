// SPDX-License-Identifier: MIT
#pragma once

#include "cli/cli_fixture.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace voxtact::test {

/// To a place beside the middle of the head; its voxels are its labels.
class PlanTest : public CliTest {
  protected:
    [[nodiscard]] static Arguments plan(const Arguments& more) {
        Arguments all{"plan", "--volume", "builtin:head:30", "--format", "csv"};
        if (std::find(more.begin(), more.end(), "--entries") == more.end()) {
            all.insert(all.end(), {"--entries", "100"});
        }
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    [[nodiscard]] std::vector<std::map<std::string, std::string>> rows(const Arguments& more) const {
        const std::vector<std::string> lines = linesOf(output(plan(more)));
        const std::vector<std::string> names = fieldsOf(lines.at(0));
        std::vector<std::map<std::string, std::string>> found;
        for (std::size_t i = 1; i < lines.size(); ++i) {
            const std::vector<std::string> fields = fieldsOf(lines[i]);
            std::map<std::string, std::string> row;
            for (std::size_t k = 0; k < fields.size(); ++k) {
                row[names.at(k)] = fields[k];
            }
            found.push_back(std::move(row));
        }
        return found;
    }
    [[nodiscard]] Arguments labelled(const Arguments& more) const {
        Arguments all{"--labels", path("labels.nii.gz"), "--target", "20,0,30"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    void SetUp() override {
        output({"make", "volume", "builtin:head:30", path("labels.nii.gz")});
        writeText(path("labels.nii.txt"), "70 Cortex\n90 Skin\n120 Skull\n");
    }
};

} // namespace voxtact::test
