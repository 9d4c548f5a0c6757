// SPDX-License-Identifier: BSD-3-Clause
// Every reader of YAML on the same bytes: whatever they are, the answer is a value or an Error.
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include <crisp/calibration_file.hpp>
#include <crisp/pipeline.hpp>
#include <crisp/rig_file.hpp>

#include "pipeline/files/calibration_yaml.hpp"
#include "pipeline/files/findings_file.hpp"
#include "pipeline/files/rig_yaml.hpp"
#include "pipeline/stage/pipeline_plan.hpp"

namespace crisp {
namespace {

using namespace crisp::files;
using namespace crisp::stage;

/// An option of every type, so that a pipeline's text reaches each of their readers.
class FuzzedStage final : public Stage {
 public:
  enum class Way { here, there };

  static void describe(StageDescription<FuzzedStage>& d) {
    d.name("fuzz.all").summary("has options of every type").takes<Calibration>(Need::optional);
    d.gives<Calibration>();
    d.option("flag", &FuzzedStage::flag_, "-");
    d.option("count", &FuzzedStage::count_, "-").range(0, 100);
    d.option("length", &FuzzedStage::length_, "-").unit("m");
    d.option("angles", &FuzzedStage::angles_, "-").unit("rad");
    d.option("share", &FuzzedStage::share_, "-").unit("1");
    d.option("names", &FuzzedStage::names_, "-");
    d.option("file", &FuzzedStage::file_, "-");
    d.option("way", &FuzzedStage::way_, "-").choices({{"here", Way::here}, {"there", Way::there}});
  }
  void process(const Inputs&, Outputs&, Context&) override {}

 private:
  bool flag_ = false;
  int count_ = 0;
  double length_ = 0;
  std::vector<double> angles_;
  std::optional<double> share_;
  std::vector<std::string> names_;
  std::filesystem::path file_;
  Way way_ = Way::here;
};

template <class Read>
auto attempt(Read read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const Error&) {
    return std::nullopt;
  }
}

bool read_pipeline(const YamlNode& root) {
  Registrar registrar;
  registrar.stage<FuzzedStage>();
  RunSettings run;
  run.registrar = &registrar;
  const PipelineArguments arguments{.input = "/in", .output = "/out", .set = {"fuzz.all.count=3", "n=2"}};
  std::vector<Error> errors;
  const PipelinePlan plan = parse_plan(root, "/nowhere", arguments, registrar.stages(), errors);
  build_pipeline(plan.stages, run, errors);
  return errors.empty();
}

/// What was read can be written, and reads back as the same.
void write_again(const Calibration& calibration) {
  const std::string text = to_yaml(calibration);
  if (to_yaml(parse_calibration(parse_yaml(text, "again"))) != text) std::abort();
}

void write_again(const Findings& findings) {
  const std::string text = findings_json(findings);
  if (findings_json(parse_findings(parse_yaml(text, "again"))) != text) std::abort();
}

}  // namespace
}  // namespace crisp

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto root = crisp::attempt([&] { return crisp::files::parse_yaml(text, "fuzz.yaml"); });
  if (!root) return 0;
  crisp::attempt([&] { return crisp::files::parse_rig(*root); });
  const auto calibration = crisp::attempt([&] { return crisp::files::parse_calibration(*root); });
  if (calibration) crisp::write_again(*calibration);
  const auto findings = crisp::attempt([&] { return crisp::files::parse_findings(*root); });
  if (findings) crisp::write_again(*findings);
  crisp::attempt([&] { return crisp::read_pipeline(*root); });
  return 0;
}
