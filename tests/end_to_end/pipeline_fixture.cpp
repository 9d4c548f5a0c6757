// SPDX-License-Identifier: BSD-3-Clause
#include "tests/end_to_end/pipeline_fixture.hpp"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include <crisp/builtin.hpp>
#include <crisp/cloud_conversion.hpp>

#include "tests/support/source_dir.hpp"

namespace crisp::test {
namespace {

using namespace crisp::app;
namespace fs = std::filesystem;

/// Collects what is written to a stream while it lives.
class Listener {
 public:
  explicit Listener(std::ostream& stream) : stream_(stream), before_(stream.rdbuf(heard_.rdbuf())) {}
  ~Listener() { stream_.rdbuf(before_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  std::string text() const { return heard_.str(); }

 private:
  std::ostream& stream_;
  std::ostringstream heard_;
  std::streambuf* before_;
};

std::vector<std::string> list_files(const fs::path& folder) {
  std::vector<std::string> names;
  if (!fs::is_directory(folder)) return names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

fs::path fast_folder() {
  const fs::path memory = "/dev/shm";
  return fs::is_directory(memory) && access(memory.c_str(), W_OK) == 0 ? memory : fs::temp_directory_path();
}

}  // namespace

PipelineFixture::PipelineFixture() : folder_(fast_folder()) {}

const nlohmann::json& Outcome::stage(const std::string& tag) const {
  for (const auto& stage : summary.at("stages")) {
    if (stage.at("tag") == tag) return stage;
  }
  throw std::runtime_error("the summary has no stage " + tag);
}

std::uint64_t Outcome::count(const std::string& tag, const std::string& name) const {
  return stage(tag).at("counts").value(name, std::uint64_t{0});
}

std::uint64_t Outcome::losses(const std::string& tag) const {
  std::uint64_t sum = 0;
  for (const auto& [name, n] : stage(tag).at("counts").items()) sum += n.get<std::uint64_t>();
  return sum;
}

Outcome PipelineFixture::run(const std::string& config, const fs::path& input, const std::string& output,
                             const std::vector<std::string>& set, const fs::path& rig) const {
  const fs::path out = folder_ / output;
  std::error_code not_there;
  fs::remove_all(out, not_there);
  RunRequest request{.file = fs::path(source_dir()) / "configs" / config,
                     .arguments = {.output = out, .set = set},
                     .quiet = true};
  if (!input.empty()) request.arguments.input = input;
  if (!rig.empty()) request.arguments.rig = rig;
  Builtin builtin;
  const Listener listener(std::cerr);
  Outcome outcome{.status = run_command(request, builtin.registrar())};
  outcome.console = listener.text();
  outcome.files = list_files(out);
  if (fs::exists(out / "summary.json"))
    outcome.summary = nlohmann::json::parse(bytes_of(out / "summary.json"));
  if (fs::exists(out / "cloud.pcd")) outcome.cloud = cloud_of(read_pcd(out / "cloud.pcd")).cloud;
  return outcome;
}

void PipelineFixture::simulate(const std::string& output, const std::vector<std::string>& options,
                               const fs::path& rig) const {
  std::vector<std::string> set;
  for (const auto& option : options) set.push_back("grabber.simulate." + option);
  const Outcome outcome = run("simulate.yaml", {}, output, set, rig);
  if (outcome.status != ExitStatus::done) throw std::runtime_error("no simulation: " + outcome.console);
}

Outcome PipelineFixture::assemble(const std::string& simulation, const std::string& output,
                                  const fs::path& capture) const {
  const fs::path made = folder_ / simulation;
  return run("assemble.yaml", capture.empty() ? made / "hub.pcap" : capture, output,
             {"calibration=" + (made / "truth.yaml").string()});
}

}  // namespace crisp::test
