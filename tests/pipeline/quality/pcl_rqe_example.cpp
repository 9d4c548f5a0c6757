// SPDX-License-Identifier: BSD-3-Clause
// How crisp is a PCL cloud? Prints the entropy of a wall, and of the same wall seen twice, 5 cm apart.
#include <pcl/point_types.h>

#include <exception>
#include <iostream>

#include <crisp/pcl_rqe.hpp>

int main() try {
  const auto once = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  const auto twice = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 100; ++j) {
      const float apart = (i + j) % 2 == 0 ? 0.05F : 0.0F;
      once->emplace_back(2.0F, 0.02F * static_cast<float>(i), 0.02F * static_cast<float>(j));
      twice->emplace_back(2.0F + apart, 0.02F * static_cast<float>(i), 0.02F * static_cast<float>(j));
    }
  }
  crisp::PclRqe<pcl::PointXYZ> rqe;
  rqe.setSigma(0.02);
  rqe.setInputCloud(once);
  const double crisp_wall = rqe.compute().value;
  rqe.setInputCloud(twice);
  const double double_wall = rqe.compute().value;
  std::cout << "crisp: " << crisp_wall << ", doubled: " << double_wall << '\n';
  return crisp_wall < double_wall ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
