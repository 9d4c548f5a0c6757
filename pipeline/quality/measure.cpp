// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include <crisp/measure.hpp>
#include <crisp/rqe.hpp>

namespace crisp {
namespace {

class RqeMeasure final : public Measure {
 public:
  RqeMeasure(std::unique_ptr<Search> search, double cutoff) : search_(std::move(search)), cutoff_(cutoff) {}

  Quality evaluate(const PointsView& points, std::span<const double> weights, double scale,
                   bool gradient) override {
    Rqe result =
        rqe(points, weights, {.sigma = scale, .cutoff = cutoff_, .gradient = gradient, .error_bound = false},
            *search_);
    return {result.value, std::move(result.gradient)};
  }

 private:
  std::unique_ptr<Search> search_;
  double cutoff_;
};

}  // namespace

void register_built_in(MeasureRegistry& registry) {
  registry.add("rqe", "Rényi's quadratic entropy",
               [](const MeasureSettings& settings, const SearchRegistry& searches) {
                 return std::make_unique<RqeMeasure>(searches.make(settings.search), settings.cutoff);
               });
}

}  // namespace crisp
