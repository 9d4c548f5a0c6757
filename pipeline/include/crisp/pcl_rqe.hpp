// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/common/point_tests.h>
#include <pcl/pcl_base.h>

#include <pcl/impl/pcl_base.hpp>  // the definitions too: PCL compiles them for its own points only
#include <string>
#include <utility>
#include <vector>

#include <crisp/error.hpp>
#include <crisp/rqe.hpp>

namespace crisp {

/// RQE of a PCL cloud, used as PCL's own classes are:
///
///     crisp::PclRqe<pcl::PointXYZ> rqe;
///     rqe.setInputCloud(cloud);
///     rqe.setSigma(0.02);
///     std::cout << rqe.compute().value;
///
/// Points whose coordinates are not finite are left out, as are those that setIndices() does not name.
/// @tparam PointT  any point type with x, y, z [m]
template <class PointT>
class PclRqe : public pcl::PCLBase<PointT> {
 public:
  /// Width of the kernel that stands for each point [m], 1e-6 to 1e6.
  void setSigma(double sigma) { settings_.sigma = sigma; }
  /// [m] Width of the kernel.
  double getSigma() const { return settings_.sigma; }

  /// Distance [σ] beyond which a pair counts as 0.
  void setCutoff(double cutoff) { settings_.cutoff = cutoff; }
  /// [σ] Distance beyond which a pair counts as 0.
  double getCutoff() const { return settings_.cutoff; }

  /// Weights of the input cloud's points; none: all the same.
  void setWeights(std::vector<double> weights) { weights_ = std::move(weights); }

  /// Whether to compute the gradient; off by default.
  void setGradient(bool requested) { settings_.gradient = requested; }

  /// The points that the last compute() took, as indices of the input cloud: the rows of its gradient.
  const pcl::Indices& getUsedIndices() const { return used_; }

  /// @throws Error  without an input cloud, without a finite point in it, or for settings or indices out of
  ///                range
  Rqe compute() {
    if (!this->initCompute()) throw Error("there is no cloud", "call setInputCloud() first");
    Vectors points;
    std::vector<double> weights;
    used_.clear();
    if (!weights_.empty()) check_weights(weights_, this->input_->size());
    for (const auto index : *this->indices_) {
      check_index(index);
      const PointT& point = (*this->input_)[static_cast<std::size_t>(index)];
      if (!pcl::isFinite(point)) continue;
      points.x.push_back(point.x);
      points.y.push_back(point.y);
      points.z.push_back(point.z);
      used_.push_back(index);
      if (!weights_.empty()) weights.push_back(weights_[static_cast<std::size_t>(index)]);
    }
    this->deinitCompute();
    return rqe(points.view(), weights, settings_);
  }

 private:
  void check_index(pcl::index_t index) const {
    if (index >= 0 && static_cast<std::size_t>(index) < this->input_->size()) return;
    throw Error("there is no point " + std::to_string(index) + " in a cloud of " +
                    std::to_string(this->input_->size()),
                "give setIndices() those of the cloud that setInputCloud() was given");
  }

  RqeSettings settings_{.gradient = false};
  std::vector<double> weights_;
  pcl::Indices used_;
};

}  // namespace crisp
