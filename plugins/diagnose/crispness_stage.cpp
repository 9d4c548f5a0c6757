// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/crispness_stage.hpp"

#include <fmt/format.h>

#include "pipeline/data/cloud.hpp"
#include "pipeline/quality/rqe.hpp"
#include "pipeline/quality/search.hpp"
#include "pipeline/stage/registry.hpp"

namespace crisp {
namespace {

std::unique_ptr<Search> make_search(const std::string& name, const RunSettings& run) {
  return run.registrar->get<SearchRegistry>().make(name);
}

}  // namespace

void CrispnessStage::describe(StageDescription<CrispnessStage>& d) {
  d.name("diagnose.crispness").summary("says how crisp a cloud is: its Rényi quadratic entropy");
  d.details(
      "The lower the entropy, the crisper the cloud. Only clouds of the same points, placed in different "
      "ways, "
      "can be compared, and only at the same kernel width.");
  d.takes<Cloud>();
  d.option("sigma", &CrispnessStage::sigmas_, "kernel width, or several; about the noise shows the most")
      .unit("m")
      .range(1e-4, 10);
  d.option("cutoff", &CrispnessStage::cutoff_, "distance in kernel widths beyond which pairs are left out")
      .range(1, 12);
  d.option("search", &CrispnessStage::search_, "how neighbours are found: grid, flann, exact, or a plugin's");
}

void CrispnessStage::check(const RunSettings& run) const {
  if (sigmas_.empty()) throw Error("there is no sigma to measure at", "give one kernel width or several");
  make_search(search_, run);
}

void CrispnessStage::process(const Inputs& in, Outputs&, Context&) {
  for (const Point& point : in.get<Cloud>()) {
    points_.x.push_back(static_cast<double>(point.x));
    points_.y.push_back(static_cast<double>(point.y));
    points_.z.push_back(static_cast<double>(point.z));
  }
}

void CrispnessStage::finish(Outputs&, Context& context) {
  if (points_.size() == 0) {
    context.warn("no points came, so their crispness was not measured");
    return;
  }
  auto widths = nlohmann::json::array();
  for (std::size_t k = 0; k < sigmas_.size() && !context.interrupted(); ++k) {
    context.progress(static_cast<double>(k) / static_cast<double>(sigmas_.size()),
                     fmt::format("sigma {} m", sigmas_[k]));
    const auto search = make_search(search_, context.run());
    const Rqe result =
        rqe(points_.view(), {}, {.sigma = sigmas_[k], .cutoff = cutoff_, .gradient = false}, *search);
    const double neighbours = 2.0 * static_cast<double>(result.pairs) / static_cast<double>(points_.size());
    widths.push_back({{"sigma", sigmas_[k]},
                      {"rqe", result.value},
                      {"error_bound", result.error_bound},
                      {"neighbours", neighbours}});
    context.say(fmt::format("RQE {:.4f} at sigma {:g} m ({:.1f} neighbours a point)", result.value,
                            sigmas_[k], neighbours));
  }
  context.report({{"points", points_.size()}, {"widths", widths}});
}

}  // namespace crisp
