// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "plugins/cuda/device_array.hpp"
#include "plugins/cuda/gpu.hpp"

namespace crisp::cuda {
namespace {

/// The threads of a block, each a lane of its unit.
template <class Real>
struct DeviceLanes {
  Lane<Real> lane{};

  template <class Step>
  constexpr void each(const Step& step) {
#ifdef __CUDA_ARCH__
    step(threadIdx.x, lane);
    __syncthreads();
#endif
  }
};

template <class Real>
__global__ void __launch_bounds__(kLanes) sum_units(PlanView plan, PairKernel kernel, Results results) {
  __shared__ Shared<Real> shared;
  DeviceLanes<Real> lanes;
  sum_unit<Real>(plan, kernel, blockIdx.x, lanes, shared, results);
}

void check_room(const CellPlan& plan, const Slots& slots, bool gradient) {
  std::size_t free = 0;
  std::size_t all = 0;
  check(cudaMemGetInfo(&free, &all), "say how much memory it has");
  const std::size_t needed = slots.weight.size() * sizeof(double) * (gradient ? 7 : 4) +
                             plan.units.size() * (sizeof(Unit) + sizeof(double) + sizeof(std::uint64_t)) +
                             plan.near.size() * sizeof(SlotRange) +
                             plan.near_begin.size() * sizeof(std::uint64_t);
  if (needed > free || plan.units.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error("a cloud of " + std::to_string(slots.weight.size()) + " points needs " +
                    std::to_string(needed >> 20) + " MiB of the graphics processor's memory, of which " +
                    std::to_string(free >> 20) + " MiB are free",
                "thin the cloud, or measure with `measure: rqe` and `search: grid`");
  }
}

}  // namespace

std::string why_no_gpu() {
  int devices = 0;
  const cudaError_t status = cudaGetDeviceCount(&devices);
  if (status != cudaSuccess) return cudaGetErrorString(status);
  return devices == 0 ? "CUDA finds no device" : "";
}

UnitSums sum_on_gpu(const CellPlan& plan, const Slots& slots, const PairKernel& kernel, bool gradient) {
  UnitSums sums;
  if (plan.units.empty()) return sums;
  check_room(plan, slots, gradient);
  const DeviceArray x(slots.at.x);
  const DeviceArray y(slots.at.y);
  const DeviceArray z(slots.at.z);
  const DeviceArray weight(slots.weight);
  const DeviceArray units(plan.units);
  const DeviceArray near(plan.near);
  const DeviceArray near_begin(plan.near_begin);
  const std::size_t pulls = gradient ? slots.weight.size() : 0;
  const DeviceArray<double> pull_x(pulls);
  const DeviceArray<double> pull_y(pulls);
  const DeviceArray<double> pull_z(pulls);
  const DeviceArray<double> unit_kernel(plan.units.size());
  const DeviceArray<std::uint64_t> unit_pairs(plan.units.size());

  const PlanView view{x.data(),     y.data(),    z.data(),         weight.data(),
                      units.data(), near.data(), near_begin.data()};
  const Results results{pull_x.data(), pull_y.data(), pull_z.data(), unit_kernel.data(), unit_pairs.data()};
  const auto blocks = static_cast<unsigned>(plan.units.size());
  if (plan.needs_double) {
    sum_units<double><<<blocks, kLanes>>>(view, kernel, results);
  } else {
    sum_units<float><<<blocks, kLanes>>>(view, kernel, results);
  }
  check(cudaGetLastError(), "begin to sum");
  check(cudaDeviceSynchronize(), "sum");
  sums.pull = {pull_x.download(), pull_y.download(), pull_z.download()};
  sums.kernel = unit_kernel.download();
  sums.pairs = unit_pairs.download();
  return sums;
}

}  // namespace crisp::cuda
