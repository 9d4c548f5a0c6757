// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/report/crispness_stage.hpp"

#include <fmt/format.h>

#include <crisp/cloud.hpp>
#include <crisp/neighbour_search.hpp>
#include <crisp/registrar.hpp>
#include <crisp/rqe.hpp>

namespace crisp::diagnose {
namespace {

std::unique_ptr<Search> make_search(const std::string& name, const RunSettings& run) {
  return run.registrar->get<SearchRegistry>().make(name);
}

}  // namespace

void CrispnessStage::describe(StageDescription<CrispnessStage>& d) {
  d.name("diagnose.crispness").summary("measures the crispness of a cloud by its Rényi quadratic entropy");
  d.details(
      "A lower entropy means a crisper cloud. Entropies are comparable only between clouds of the same points, assembled with different calibrations, and at the same kernel width.");
  d.takes<Cloud>();
  d.option("sigma", &CrispnessStage::sigmas_,
           "kernel width, or several; about the range noise is the most sensitive")
      .unit("m")
      .range(1e-4, 10);
  d.option("cutoff", &CrispnessStage::cutoff_,
           "largest distance of a pair, in kernel widths; farther pairs are left out")
      .range(1, 12);
  d.option("search", &CrispnessStage::search_, "neighbour search: grid, flann, exact, or a plugin's");
}

void CrispnessStage::check(const RunSettings& run) const {
  if (sigmas_.empty()) throw Error("no kernel width is given", "set `sigma` to one kernel width or several");
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
    context.warn("the cloud has no points, so its crispness was not measured");
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
    context.print(fmt::format("RQE {:.4f} at sigma {:g} m ({:.1f} neighbours per point)", result.value,
                              sigmas_[k], neighbours));
  }
  context.report({{"points", points_.size()}, {"widths", widths}});
}

}  // namespace crisp::diagnose
