// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/record/record_stage.hpp"

#include <utility>

namespace crisp::record {

void RecordStage::describe(StageDescription<RecordStage>& d) {
  d.name("write.capture").summary("records scans and encoder readings as a capture for grabber.capture");
  d.details(
      "A pcap file with nanosecond stamps, as a capture of the hub's network interface: a TCP connection per laser (CoLa-B) and the plate's datagrams. Reading it gives the same scans and readings with the same times of receipt.\n\n"
      "The file grows in place, and received data are on disk soon after: neither Ctrl-C nor a power cut leaves an unreadable file. An existing recording is continued after its last intact record; if nothing behind its end could be read, it stays unchanged and file-2.pcap is begun. A simulated capture or another program's file of that name is an error. A full disk ends the recording, which the summary reports; the other stages go on.");
  d.takes<Scan>().takes<PlateReading>();
  d.option("file", &RecordStage::file_, "the capture").writes({"<stem>-#<ext>"}).required();
  d.option("max_bytes", &RecordStage::settings_, &RecorderSettings::max_bytes,
           "approximate size limit of a file; then file-2.pcap is begun, and so on; 0: no limit")
      .range(0, 1e15);
  d.option("max_duration", &RecordStage::settings_, &RecorderSettings::most_seconds,
           "duration limit of a file; then the next is begun; 0: no limit")
      .unit("s")
      .range(0, 1e9);
  d.option("safe_after", &RecordStage::settings_, &RecorderSettings::safe_after,
           "maximum delay until received data are on disk")
      .unit("s")
      .range(0, 60);
}

void RecordStage::check(const RunSettings&) const { refuse_foreign(file_); }

void RecordStage::write(HubItem item, Context& context) {
  ++given_;
  if (failed_) return;
  try {
    if (!recorder_) recorder_ = std::make_unique<CaptureRecorder>(file_, context.rig(), settings_);
    recorder_->write(std::move(item));
  } catch (const Error& error) {
    fail(error, context);
  }
}

void RecordStage::fail(const Error& error, Context& context) {
  failed_ = true;
  const std::string what = "the recording ended early: " + error.message();
  context.mark_untrusted(what);
  context.set_status({.line = "the recording has ended", .events = {what}});
  end();
}

void RecordStage::process(const Inputs& in, Outputs&, Context& context) {
  if (auto scan = in.share<Scan>()) {
    write(std::move(scan), context);
  } else {
    write(in.get<PlateReading>(), context);
  }
}

void RecordStage::end() {
  if (!recorder_) return;
  files_ = recorder_->files();
  recorded_ = recorder_->recorded();
  notes_ = recorder_->notes();
  recorder_.reset();
}

void RecordStage::finish(Outputs&, Context& context) {
  if (given_ == 0) {
    throw Error("nothing was received, so that there is no capture to write",
                "check that the devices are switched on and at the rig's addresses");
  }
  try {
    if (recorder_) recorder_->close();
  } catch (const Error& error) {
    fail(error, context);
  }
  end();
  for (auto& note : notes_) context.warn(std::move(note));
  context.count("items that were not recorded", given_ - recorded_);
  for (const auto& file : files_) context.wrote(file);
}

void register_record(Registrar& registrar) { registrar.stage<RecordStage>(); }

}  // namespace crisp::record
