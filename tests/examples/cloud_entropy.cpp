// SPDX-License-Identifier: BSD-3-Clause
// cloud_entropy CLOUD.pcd SIZE: how crisp a cloud is, and how many of its points remain with one in each
// voxel of SIZE metres.
#include <cstdlib>
#include <exception>
#include <iostream>

#include <crisp/cloud_conversion.hpp>  // crisp::pcd
#include <crisp/first_in_voxel.hpp>    // crisp::filter
#include <crisp/pcl_rqe.hpp>           // crisp::pcl_rqe

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  const crisp::Cloud::ConstPtr cloud = crisp::cloud_of(crisp::read_pcd(argv[1])).cloud;

  crisp::FirstInVoxel<crisp::Point> thin;
  thin.setLeafSize(std::atof(argv[2]));
  thin.setInputCloud(cloud);
  crisp::Cloud thinned;
  thin.filter(thinned);

  crisp::PclRqe<crisp::Point> rqe;
  rqe.setSigma(0.05);
  rqe.setInputCloud(cloud);
  std::cout << thinned.size() << " of " << cloud->size() << " points, RQE " << rqe.compute().value << "\n";
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
