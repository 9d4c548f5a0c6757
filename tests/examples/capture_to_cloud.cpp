// SPDX-License-Identifier: BSD-3-Clause
// A capture and a calibration become a cloud, without a pipeline.
//
//     capture_to_cloud HUB.pcap CALIBRATION.yaml CLOUD.pcd
#include <cstdlib>
#include <iostream>
#include <optional>

#include <crisp/calibration_file.hpp>
#include <crisp/capture_reader.hpp>
#include <crisp/clock_aligner.hpp>
#include <crisp/cloud_conversion.hpp>
#include <crisp/deskew.hpp>
#include <crisp/effect_catalogue.hpp>

namespace {

/// The calibration's lasers are in the order of the rig, as crisp writes them.
crisp::Cloud cloud_of(const char* capture, const crisp::Rig& rig, const crisp::Calibration& calibration) {
  crisp::TermRegistry terms;
  crisp::register_built_in(terms);
  const crisp::SensorModel model(calibration, terms);
  crisp::MirrorAngleCache mirrors;
  crisp::Cloud cloud;
  std::optional<crisp::PlateTrajectory> plate;  // of the stretch of time whose measurements come next
  const crisp::AlignmentSink place{
      .trajectory = [&](crisp::PlateTrajectory next) { plate = std::move(next); },
      .measurements =
          [&](const std::shared_ptr<const crisp::Measurements>& beams) {
            cloud += *crisp::deskew(*beams, *plate, model, mirrors).cloud;
          }};
  crisp::ClockAligner aligner(rig, {}, place);
  crisp::CaptureReader reader(capture, rig);
  while (const auto item = reader.next()) std::visit([&](const auto& each) { aligner.add(each); }, *item);
  const crisp::AlignmentReport report = aligner.finish();
  for (const auto& caveat : report.caveats) std::cerr << "untrusted: " << caveat << "\n";
  return cloud;
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    std::cerr << "usage: capture_to_cloud HUB.pcap CALIBRATION.yaml CLOUD.pcd\n";
    return EXIT_FAILURE;
  }
  try {
    const auto cloud = cloud_of(words[1], crisp::default_rig(), crisp::read_calibration(words[2]));
    crisp::AtomicFile file(words[3]);
    crisp::write_pcd(file, crisp::to_pcd_table(cloud), crisp::PcdFormat::binary_compressed);
    file.commit();
    std::cout << cloud.size() << " points\n";
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
