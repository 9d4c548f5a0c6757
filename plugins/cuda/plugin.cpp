// SPDX-License-Identifier: BSD-3-Clause
#include <crisp/error.hpp>
#include <crisp/measure.hpp>
#include <crisp/plugin.hpp>

#include "plugins/cuda/gpu.hpp"

namespace {

std::unique_ptr<crisp::Search> make_search() {
  const std::string reason = crisp::cuda::why_no_gpu();
  if (!reason.empty()) {
    throw crisp::Error("there is no graphics processor to measure on: " + reason,
                       "install its driver, or measure with `measure: rqe` and `search: grid`");
  }
  return std::make_unique<crisp::cuda::UnitSearch>(crisp::cuda::take_plan_to_gpu);
}

void register_cuda(crisp::Registrar& registrar) {
  registrar.get<crisp::SearchRegistry>().add("cuda", "on a graphics processor", make_search);
  registrar.get<crisp::MeasureRegistry>().add(
      "rqe_cuda", "Rényi's quadratic entropy on a graphics processor",
      [](crisp::MeasureSettings settings, const crisp::SearchRegistry& searches) {
        crisp::MeasureRegistry built_in;
        crisp::register_built_in(built_in);
        settings.search = "cuda";
        return built_in.make("rqe", settings, searches);
      });
}

}  // namespace

CRISP_PLUGIN("cuda", CRISP_VERSION, register_cuda);
