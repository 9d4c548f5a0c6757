// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/table_lines.hpp"

#include <algorithm>
#include <string_view>

#include <crisp/error.hpp>

namespace crisp::table {
namespace {

constexpr std::size_t kAtOnce = 1 << 16;
constexpr std::size_t kNoText =
    1 << 28;  // longer lines are a device's or an image's zeros, and may never end

}  // namespace

/// False at the end of the text.
bool TableLines::fill() {
  buffer_.resize(kAtOnce);
  in_.read(buffer_.data(), static_cast<std::streamsize>(kAtOnce));
  buffer_.resize(static_cast<std::size_t>(in_.gcount()));
  at_ = 0;
  if (in_.bad()) {
    throw Error("cannot read " + name_ + " on after line " + std::to_string(number_),
                "check that it is a file, and its disk");
  }
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (!begun_ && buffer_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
  begun_ = true;
  return !buffer_.empty();
}

void TableLines::take(std::string& line, std::size_t n) {
  if (line.size() <= kLongest) line.append(buffer_, at_, std::min(n, kLongest + 1 - line.size()));
  at_ += n;
  length_ += n;
  if (length_ > kNoText) {
    throw Error(name_ + " has a line of more than 256 MiB", "is it a table?", Place{name_, number_ + 1, 1});
  }
}

bool TableLines::next(std::string& line) {
  line.clear();
  length_ = 0;
  bool any = false;
  while (at_ < buffer_.size() || fill()) {
    if (after_return_ && buffer_[at_] == '\n') ++at_;
    after_return_ = false;
    if (at_ == buffer_.size()) continue;
    any = true;
    const std::string_view left = std::string_view(buffer_).substr(at_);
    const auto feed = std::min(left.find('\n'), left.size());
    const auto end = std::min(left.substr(0, feed).find('\r'), feed);
    take(line, end);
    if (end == left.size()) continue;
    after_return_ = buffer_[at_] == '\r';
    ++at_;
    break;
  }
  if (any) ++number_;
  return any;
}

}  // namespace crisp::table
