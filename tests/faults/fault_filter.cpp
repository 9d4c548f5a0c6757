// SPDX-License-Identifier: BSD-3-Clause
#include "tests/faults/fault_filter.hpp"

#include <link.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string_view>
#include <vector>

namespace crisp::test {
namespace {

/// Where the code of the C library lies: [begin, end).
struct Range {
  std::uintptr_t begin = 0, end = 0;
};

int find_code(dl_phdr_info* object, std::size_t, void* range) {
  if (std::string_view(object->dlpi_name).find("/libc.so") == std::string_view::npos) return 0;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const auto& part = object->dlpi_phdr[i];
    if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
    const std::uintptr_t begin = object->dlpi_addr + part.p_vaddr;
    *static_cast<Range*>(range) = {begin, begin + part.p_memsz};
  }
  return 1;
}

/// Passes all calls from outside of this part of the memory. For one that lies across a multiple of 4 GiB, as
/// one program in two thousand finds it, the larger part counts.
void add_range(std::vector<sock_filter>& program, Range range) {
  constexpr auto kAddress = offsetof(seccomp_data, instruction_pointer);
  const auto lower = [](std::uintptr_t address) { return static_cast<std::uint32_t>(address); };
  const std::uintptr_t border = (range.end - 1) >> 32U << 32U;
  if (range.begin < border) (range.end - border < border - range.begin ? range.end : range.begin) = border;
  program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kAddress + 4));
  program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, lower(range.begin >> 32U), 0, 4));
  program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kAddress));
  program.push_back(BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, lower(range.begin), 0, 2));
  program.push_back(BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, lower(range.end - 1), 1, 0));
  program.push_back(BPF_STMT(BPF_JMP | BPF_JA, 1));
  program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
}

}  // namespace

void trap_calls_of_c_library(std::span<const int> numbers) {
  Range code;
  dl_iterate_phdr(find_code, &code);
  if (code.begin == 0) {
    std::fprintf(stderr, "fault_preload: the C library is not found\n");
    _exit(125);
  }
  std::vector<sock_filter> program;
  add_range(program, code);
  program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(numbers[i]),
                               static_cast<std::uint8_t>(numbers.size() - i), 0));
  }
  program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP));
  const sock_fprog filter = {static_cast<unsigned short>(program.size()), program.data()};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0) {
    std::perror("fault_preload: no seccomp filter");
    _exit(125);
  }
}

}  // namespace crisp::test
