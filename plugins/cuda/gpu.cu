// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <optional>

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

/// @param bytes  that the cloud needs besides what it has
void check_room(std::size_t points, std::size_t bytes) {
  std::size_t free = 0;
  std::size_t all = 0;
  check(cudaMemGetInfo(&free, &all), "report its memory");
  if (bytes <= free) return;
  throw Error("a cloud of " + std::to_string(points) + " points needs " + std::to_string(bytes >> 20) +
                  " MiB of the graphics processor's memory, of which " + std::to_string(free >> 20) +
                  " MiB are free",
              "thin the cloud, or measure with `measure: rqe` and `search: grid`");
}

/// Three coordinates of n points.
struct DeviceVectors {
  explicit DeviceVectors(std::size_t n) : x(n), y(n), z(n) {}

  DeviceArray<double> x, y, z;
};

/// A plan, and room for the cloud that it is of.
class GpuPlan {
 public:
  explicit GpuPlan(const CellPlan& plan)
      : needs_double_(plan.needs_double),
        blocks_(blocks_with_room(plan)),
        index_(plan.order.index),
        units_(plan.units),
        near_(plan.near),
        near_begin_(plan.near_begin),
        at_(plan.order.index.size()),
        weight_(plan.order.index.size()),
        kernel_(plan.units.size()),
        pairs_(plan.units.size()) {}

  UnitSums sum(const PointsView& points, std::span<const double> weights, const PairKernel& kernel,
               bool gradient) {
    UnitSums sums;
    if (blocks_ == 0) return sums;
    at_.x.upload(points.x);
    at_.y.upload(points.y);
    at_.z.upload(points.z);
    weight_.upload(weights);
    if (gradient && !gradient_) {
      check_room(points.size(), 3 * sizeof(double) * points.size());
      gradient_.emplace(points.size());
    }
    const PlanView view{at_.x.data(),  at_.y.data(),  at_.z.data(), weight_.data(),
                        index_.data(), units_.data(), near_.data(), near_begin_.data()};
    Results results{nullptr, nullptr, nullptr, kernel_.data(), pairs_.data()};
    if (gradient) {
      results.x = gradient_->x.data();
      results.y = gradient_->y.data();
      results.z = gradient_->z.data();
    }
    if (needs_double_) {
      sum_units<double><<<blocks_, kLanes>>>(view, kernel, results);
    } else {
      sum_units<float><<<blocks_, kLanes>>>(view, kernel, results);
    }
    check(cudaGetLastError(), "begin to sum");
    check(cudaDeviceSynchronize(), "sum");
    if (gradient) sums.gradient = {gradient_->x.download(), gradient_->y.download(), gradient_->z.download()};
    sums.kernel = kernel_.download();
    sums.pairs = pairs_.download();
    return sums;
  }

 private:
  /// Number of blocks, once memory is available.
  static unsigned blocks_with_room(const CellPlan& plan) {
    const std::size_t points = plan.order.index.size();
    check_room(points, points * (4 * sizeof(double) + sizeof(std::uint32_t)) +
                           plan.units.size() * (sizeof(Unit) + sizeof(double) + sizeof(std::uint64_t)) +
                           plan.near.size() * sizeof(SlotRange) +
                           plan.near_begin.size() * sizeof(std::uint64_t));
    return static_cast<unsigned>(plan.units.size());  // no more than points, which 32 bits can number
  }

  bool needs_double_;
  unsigned blocks_;
  DeviceArray<std::uint32_t> index_;
  DeviceArray<Unit> units_;
  DeviceArray<SlotRange> near_;
  DeviceArray<std::uint64_t> near_begin_;
  DeviceVectors at_;
  DeviceArray<double> weight_;
  std::optional<DeviceVectors> gradient_;  // once it is requested
  DeviceArray<double> kernel_;
  DeviceArray<std::uint64_t> pairs_;
};

}  // namespace

std::string why_no_gpu() {
  int devices = 0;
  const cudaError_t status = cudaGetDeviceCount(&devices);
  if (status != cudaSuccess) return cudaGetErrorString(status);
  return devices == 0 ? "CUDA finds no device" : "";
}

SumUnits take_plan_to_gpu(const CellPlan& plan) {
  return [gpu = std::make_shared<GpuPlan>(plan)](const auto&... cloud) { return gpu->sum(cloud...); };
}

}  // namespace crisp::cuda
