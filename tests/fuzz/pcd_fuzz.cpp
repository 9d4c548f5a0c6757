// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdint>

#include <crisp/cloud_conversion.hpp>
#include <crisp/error.hpp>
#include <crisp/measurement_tables.hpp>

namespace {

/// An Error is the right answer to most of what the fuzzer thinks of.
template <class Read>
void attempt(Read read) {
  try {
    read();
  } catch (const crisp::Error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  attempt([&] {
    const auto table = crisp::parse_pcd({reinterpret_cast<const char*>(data), size}, "fuzz.pcd");
    attempt([&] { crisp::cloud_of(table); });
    attempt([&] { crisp::measurements_of(table); });
    attempt([&] { crisp::trajectory_of(table); });
    attempt([&] { crisp::trajectory_between(table, 1); });
  });
  return 0;
}
