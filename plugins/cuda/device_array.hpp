// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <crisp/error.hpp>

namespace crisp::cuda {

/// @throws Error unless `status` is success
inline void check(cudaError_t status, const std::string& what) {
  if (status == cudaSuccess) return;
  throw Error("the graphics processor failed to " + what + ": " + cudaGetErrorString(status),
              "check it with `nvidia-smi`, or measure with `measure: rqe` and `search: grid`");
}

/// n values in the memory of the current device, owned.
template <class T>
class DeviceArray {
 public:
  explicit DeviceArray(std::size_t n) : size_(n) {
    if (n > 0) check(cudaMalloc(&data_, n * sizeof(T)), "make room for a cloud");
  }
  explicit DeviceArray(std::span<const T> values) : DeviceArray(values.size()) { upload(values); }
  DeviceArray(const DeviceArray&) = delete;
  DeviceArray& operator=(const DeviceArray&) = delete;
  ~DeviceArray() { cudaFree(data_); }

  T* data() const { return data_; }

  /// @param values  n
  void upload(std::span<const T> values) {
    if (size_ > 0) {
      check(cudaMemcpy(data_, values.data(), size_ * sizeof(T), cudaMemcpyHostToDevice), "take a cloud");
    }
  }

  std::vector<T> download() const {
    std::vector<T> values(size_);
    if (size_ > 0) {
      check(cudaMemcpy(values.data(), data_, size_ * sizeof(T), cudaMemcpyDeviceToHost),
            "give its sums back");
    }
    return values;
  }

 private:
  T* data_ = nullptr;
  std::size_t size_;
};

}  // namespace crisp::cuda
