// SPDX-License-Identifier: BSD-3-Clause
// Preloaded into a program, it makes one of the program's system calls fail: those on files below a folder,
// and those that get a thread its stack. A large `operator new` counts as a call, too.
//
// A seccomp filter traps the calls of the C library, also those that it makes itself (fwrite, std::ofstream),
// which symbols of a preloaded library never see. The handler of SIGSYS makes the call, or injects the fault.
// Processes that the program forks count their calls together with it; what it executes is left alone.
//
//   CRISP_FAULT_FOLDER  the folder, absolute
//   CRISP_FAULT_CALL    the number of the call that fails, from 1; 0: none
//   CRISP_FAULT_KIND    a number of errno; "full": no space from that call on; "starved": no memory from that
//                       call on; "short": half of what is to be written; "kill": SIGKILL before the call;
//                       "torn": SIGKILL after half of what is to be written
//   CRISP_FAULT_LOG     file to which the injected call is appended as "NUMBER CALL PATH"; every call if
//   there is
//                       no number
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string_view>

#include "tests/faults/fault_filter.hpp"

// Makes a call from outside the C library, which the filter lets pass.
extern "C" long crisp_fault_pass(long number, long a, long b, long c, long d, long e, long f);
asm(R"(
  .text
  .globl crisp_fault_pass
crisp_fault_pass:
  mov %rdi, %rax
  mov %rsi, %rdi
  mov %rdx, %rsi
  mov %rcx, %rdx
  mov %r8, %r10
  mov %r9, %r8
  mov 8(%rsp), %r9
  syscall
  ret
)");

namespace {

/// How a call names the file that it works on.
enum class Names : std::uint8_t { descriptor, path, folder_and_path, nothing };

struct Call {
  int number = 0;
  const char* name = "";
  Names names = Names::nothing;
  int at = 0;  ///< argument that names the file; of a renaming the new name
};

constexpr std::array kCalls = {
    Call{SYS_open, "open", Names::path},
    Call{SYS_openat, "open", Names::folder_and_path},
    Call{SYS_creat, "open", Names::path},
    Call{SYS_read, "read", Names::descriptor},
    Call{SYS_pread64, "read", Names::descriptor},
    Call{SYS_write, "write", Names::descriptor},
    Call{SYS_writev, "write", Names::descriptor},
    Call{SYS_pwrite64, "pwrite", Names::descriptor},
    Call{SYS_rename, "rename", Names::path, 1},
    Call{SYS_renameat, "rename", Names::folder_and_path, 2},
    Call{SYS_renameat2, "rename", Names::folder_and_path, 2},
    Call{SYS_fsync, "fsync", Names::descriptor},
    Call{SYS_fdatasync, "fsync", Names::descriptor},
    Call{SYS_truncate, "truncate", Names::path},
    Call{SYS_ftruncate, "truncate", Names::descriptor},
    Call{SYS_link, "link", Names::path, 1},
    Call{SYS_linkat, "link", Names::folder_and_path, 2},
    Call{SYS_unlink, "unlink", Names::path},
    Call{SYS_unlinkat, "unlink", Names::folder_and_path},
    Call{SYS_mkdir, "mkdir", Names::path},
    Call{SYS_mkdirat, "mkdir", Names::folder_and_path},
    Call{SYS_mmap, "thread", Names::nothing},
};
constexpr Call kNew = {-1, "new", Names::nothing};
constexpr std::size_t kLarge = 1 << 16;  ///< [bytes] from which on an `operator new` counts

using Arguments = std::array<long, 6>;
using Path = std::array<char, 4096>;

std::string_view folder;
std::string_view kind;
const char* log_path = nullptr;
long fault_at = 0;
std::atomic<long>* calls = nullptr;  ///< shared with the processes that are forked

long pass(long number, const Arguments& a) {
  return crisp_fault_pass(number, a[0], a[1], a[2], a[3], a[4], a[5]);
}

std::size_t path_of_descriptor(long descriptor, Path& path) {
  std::array<char, 64> link{};
  std::snprintf(link.data(), link.size(), "/proc/self/fd/%ld", descriptor);
  const auto length = crisp_fault_pass(SYS_readlink, reinterpret_cast<long>(link.data()),
                                       reinterpret_cast<long>(path.data()), path.size() - 1, 0, 0, 0);
  return length < 0 ? 0 : static_cast<std::size_t>(length);
}

bool is_stack(const Arguments& arguments) { return (arguments[3] & MAP_STACK) != 0; }

std::string_view path_of(const Call& call, const Arguments& arguments, Path& path) {
  if (call.names == Names::descriptor) return {path.data(), path_of_descriptor(arguments[call.at], path)};
  const bool has_folder = call.names == Names::folder_and_path;
  // NOLINTNEXTLINE(performance-no-int-to-ptr): the address in a register
  const auto* name = reinterpret_cast<const char*>(arguments[call.at + (has_folder ? 1 : 0)]);
  if (name == nullptr) return {};
  if (name[0] == '/' || !has_folder || static_cast<int>(arguments[call.at]) == AT_FDCWD) return name;
  const std::size_t length = path_of_descriptor(arguments[call.at], path);
  const int more = std::snprintf(path.data() + length, path.size() - length, "/%s", name);
  return {path.data(), length + static_cast<std::size_t>(more)};
}

void log_call(long number, const Call& call, std::string_view path) {
  Path line{};
  const int length = std::snprintf(line.data(), line.size(), "%ld %s %.*s\n", number, call.name,
                                   static_cast<int>(path.size()), path.data());
  const long file = crisp_fault_pass(SYS_openat, AT_FDCWD, reinterpret_cast<long>(log_path),
                                     O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666, 0, 0);
  crisp_fault_pass(SYS_write, file, reinterpret_cast<long>(line.data()), length, 0, 0, 0);
  crisp_fault_pass(SYS_close, file, 0, 0, 0, 0, 0);
}

/// Writes half of what the call was to write; any other call is made as it is.
long pass_half(long number, Arguments arguments) {
  if (number == SYS_write || number == SYS_pwrite64) arguments[2] = (arguments[2] + 1) / 2;
  if (number != SYS_writev) return pass(number, arguments);
  // NOLINTNEXTLINE(performance-no-int-to-ptr): the address in a register
  const auto* parts = reinterpret_cast<const iovec*>(arguments[1]);
  long at = 0;
  while (at + 1 < arguments[2] && parts[at].iov_len == 0) ++at;
  iovec part = parts[at];
  part.iov_len = (part.iov_len + 1) / 2;
  return pass(SYS_writev, {arguments[0], reinterpret_cast<long>(&part), 1});
}

bool needs_room(const Call& call, const Arguments& arguments) {
  const std::string_view name = call.name;
  const bool creates =
      call.number == SYS_creat || (call.number == SYS_open && (arguments[1] & (O_CREAT | O_TMPFILE)) != 0) ||
      (call.number == SYS_openat && (arguments[2] & (O_CREAT | O_TMPFILE) & ~O_DIRECTORY) != 0);
  return creates || name == "write" || name == "pwrite" || name == "fsync" || name == "link" ||
         name == "mkdir";
}

long inject(const Call& call, const Arguments& arguments) {
  if (kind == "torn") pass_half(call.number, arguments);
  if (kind == "torn" || kind == "kill") crisp_fault_pass(SYS_kill, getpid(), SIGKILL, 0, 0, 0, 0);
  if (call.names == Names::nothing) {  // it can fail in one way only
    const bool fails = kind == "starved" || std::atol(kind.data()) > 0;
    return fails ? -ENOMEM : pass(call.number, arguments);
  }
  if (kind == "short") return pass_half(call.number, arguments);
  if (kind == "full") return needs_room(call, arguments) ? -ENOSPC : pass(call.number, arguments);
  if (kind == "starved") return pass(call.number, arguments);
  return -std::atol(kind.data());
}

/// Counts a call. @return whether it is to fail
bool count(const Call& call, std::string_view path) {
  const long number = ++*calls;
  if (number == fault_at || fault_at == 0) log_call(number, call, path);
  const bool lasts = kind == "full" || kind == "starved";
  return number == fault_at || (lasts && fault_at > 0 && number > fault_at);
}

long perform(const Call& call, const Arguments& arguments) {
  Path buffer{};
  const bool is_memory = call.names == Names::nothing;
  const std::string_view path = is_memory ? "memory" : path_of(call, arguments, buffer);
  const bool is_watched = is_memory ? is_stack(arguments) : path.starts_with(folder);
  return is_watched && count(call, path) ? inject(call, arguments) : pass(call.number, arguments);
}

void* allocate(std::size_t size, std::size_t alignment) {
  const bool fails =
      size >= kLarge && calls != nullptr && count(kNew, "memory") && inject(kNew, {}) == -ENOMEM;
  // NOLINTBEGIN(cppcoreguidelines-no-malloc): `operator new` itself
  void* memory = fails                                    ? nullptr
                 : alignment <= alignof(std::max_align_t) ? std::malloc(size)
                                                          : std::aligned_alloc(alignment, size);
  // NOLINTEND(cppcoreguidelines-no-malloc)
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void handle(int /*signal*/, siginfo_t* info, void* context) {
  const int saved = errno;
  auto& registers = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  const Arguments arguments = {registers[REG_RDI], registers[REG_RSI], registers[REG_RDX],
                               registers[REG_R10], registers[REG_R8],  registers[REG_R9]};
  for (const auto& call : kCalls) {
    if (call.number == info->si_syscall) registers[REG_RAX] = perform(call, arguments);
  }
  errno = saved;
}

const char* setting(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

__attribute__((constructor)) void begin() {
  folder = setting("CRISP_FAULT_FOLDER");
  kind = setting("CRISP_FAULT_KIND");
  log_path = setting("CRISP_FAULT_LOG");
  fault_at = std::atol(setting("CRISP_FAULT_CALL"));
  if (folder.empty()) return;
  void* shared = mmap(nullptr, sizeof *calls, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  calls = new (shared) std::atomic<long>(0);
  struct sigaction action = {};
  action.sa_sigaction = handle;
  action.sa_flags = SA_SIGINFO | SA_RESTART;
  sigaction(SIGSYS, &action, nullptr);
  std::array<int, kCalls.size()> numbers{};
  for (std::size_t i = 0; i < kCalls.size(); ++i) numbers.at(i) = kCalls[i].number;
  crisp::test::trap_calls_of_c_library(numbers);
}

}  // namespace

// NOLINTBEGIN(misc-new-delete-overloads): the standard library's `operator delete` frees what comes of malloc
void* operator new(std::size_t size) { return allocate(size, 1); }
void* operator new[](std::size_t size) { return allocate(size, 1); }
// NOLINTEND(misc-new-delete-overloads)
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
