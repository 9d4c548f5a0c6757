// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/job_message.hpp"

#include <algorithm>

namespace crisp::batch {

std::string join_fields(const std::vector<std::string>& fields) {
  std::string message;
  for (const auto& field : fields) {
    if (&field != &fields.front()) message += '\0';
    message += field;
  }
  return message;
}

std::vector<std::string> split_fields(const std::string& message) {
  std::vector<std::string> fields;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = message.find('\0', begin);
    fields.push_back(message.substr(begin, end - begin));
    if (end == std::string::npos) return fields;
    begin = end + 1;
  }
}

std::string to_message(const Job& job) {
  return join_fields(
      {"start", std::to_string(job.id), job.name, job.input.string(), job.output.string(), job.rig.string()});
}

Job job_of(const std::vector<std::string>& fields) {
  return {.id = std::stoull(fields.at(1)),
          .name = fields.at(2),
          .input = fields.at(3),
          .output = fields.at(4),
          .rig = fields.at(5)};
}

std::string to_message(const JobEnd& end) {
  std::string error = end.error;
  std::ranges::replace(error, '\0', ' ');
  return join_fields({std::to_string(end.id), std::to_string(end.exit_status), std::to_string(end.signal),
                      std::to_string(end.seconds), std::to_string(end.cpu_seconds),
                      std::to_string(end.memory), error});
}

JobEnd job_end_of(const std::vector<std::string>& fields) {
  return {.id = std::stoull(fields.at(0)),
          .exit_status = std::stoi(fields.at(1)),
          .signal = std::stoi(fields.at(2)),
          .seconds = std::stod(fields.at(3)),
          .cpu_seconds = std::stod(fields.at(4)),
          .memory = std::stoull(fields.at(5)),
          .error = fields.at(6)};
}

}  // namespace crisp::batch
