// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <csignal>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/pipeline/app/program_fixture.hpp"

namespace crisp {

/// Batches of inputs whose one word determines what a job does: see toy.perform.
class BatchTest : public ProgramTest {
 protected:
  BatchTest() {
    std::filesystem::create_directory(folder_ / "in");
    write_file(folder_ / "perform.yaml",
               "crisp: 1\n"
               "pipeline:\n"
               "  - stage: toy.perform\n"
               "    with: {file: ${input}, result: \"${output}/${stem}.txt\", journal: " +
                   path("journal") + "}\n");
  }

  /// @param name  with its ending: "a/b.pcap"
  void put(const std::string& name, const std::string& what) const {
    write_file(folder_ / "in" / name, what);
  }

  std::vector<std::string> words(std::vector<std::string> more = {}) const {
    std::vector<std::string> all = {"batch", path("perform.yaml"), "-i", path("in"), "-o", path("out")};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Outcome batch(const std::vector<std::string>& more = {}) { return crisp(words(more)); }

  /// How often a job began, by the input's file name.
  std::map<std::string, int> calls() const {
    std::map<std::string, int> count;
    std::ifstream journal(folder_ / "journal");
    for (std::string line; std::getline(journal, line);) ++count[line];
    return count;
  }

  /// The field of a recording in table.csv; none of them holds a comma in these tests.
  std::string field(const std::string& recording, const std::string& column) const {
    std::istringstream table(content("out/table.csv"));
    std::vector<std::string> names;
    for (std::string line; std::getline(table, line);) {
      std::vector<std::string> fields;
      std::istringstream split(line);
      for (std::string one; std::getline(split, one, ',');) fields.push_back(one);
      if (names.empty()) names = fields;
      if (fields.at(0) != recording) continue;
      const auto at = static_cast<std::size_t>(std::ranges::find(names, column) - names.begin());
      return at < fields.size() ? fields[at] : "";
    }
    return "no such row";
  }

  void wait_for_calls(std::size_t count) const {
    while (calls().size() < count) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
};

}  // namespace crisp
