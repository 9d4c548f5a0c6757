// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/plugin_check.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <link.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

namespace crisp::stage {
namespace {

namespace fs = std::filesystem;

using FileHeader = ElfW(Ehdr);
using ProgramHeader = ElfW(Phdr);
using SectionHeader = ElfW(Shdr);

template <class Header>
std::optional<std::vector<Header>> read_headers(const fs::path& file, std::uint64_t at, std::size_t count) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<Header> headers(count);
  stream.seekg(static_cast<std::streamoff>(at));
  stream.read(reinterpret_cast<char*>(headers.data()), static_cast<std::streamsize>(count * sizeof(Header)));
  if (!stream) return std::nullopt;
  return headers;
}

/// The kind of machine that this program itself is for.
FileHeader own_header() {
  const auto own = read_headers<FileHeader>("/proc/self/exe", 0, 1);
  return own ? own->front() : FileHeader{};
}

bool is_of_this_machine(const FileHeader& header) {
  const FileHeader own = own_header();
  return std::memcmp(header.e_ident, own.e_ident, EI_VERSION + 1) == 0 && header.e_machine == own.e_machine &&
         header.e_version == own.e_version;
}

/// Whether so many bytes from there on are in a file of this size.
bool lies_within(std::uint64_t size, std::uint64_t at, std::uint64_t bytes) {
  return at <= size && bytes <= size - at;
}

/// Whether the loader can map what a segment describes.
bool is_sound(const ProgramHeader& segment) {
  constexpr std::uint64_t kLargest = std::uint64_t{1} << 40;
  if (segment.p_type != PT_LOAD) return true;
  const std::uint64_t align = std::max<std::uint64_t>(segment.p_align, 1);
  return segment.p_memsz >= segment.p_filesz && segment.p_memsz < kLargest && segment.p_vaddr < kLargest &&
         (align & (align - 1)) == 0 && segment.p_vaddr % align == segment.p_offset % align;
}

/// Whether the object's dynamic section, by which it is linked, is in what is mapped.
bool has_mapped_dynamic_section(const std::vector<ProgramHeader>& segments) {
  const auto dynamic = std::ranges::find(segments, std::uint32_t{PT_DYNAMIC}, &ProgramHeader::p_type);
  if (dynamic == segments.end() || dynamic->p_memsz < sizeof(ElfW(Dyn))) return false;
  return std::ranges::any_of(segments, [&](const ProgramHeader& segment) {
    return segment.p_type == PT_LOAD && dynamic->p_vaddr >= segment.p_vaddr &&
           lies_within(segment.p_memsz, dynamic->p_vaddr - segment.p_vaddr, dynamic->p_memsz);
  });
}

std::string fault_of_headers(const fs::path& file, std::uint64_t size) {
  const auto header = read_headers<FileHeader>(file, 0, 1);
  if (!header || !is_of_this_machine(header->front())) return "it is no shared object for this machine";
  const auto missing = [size](const char* what) {
    return fmt::format("it is truncated: {} reach beyond its {} bytes; copy or build it again", what, size);
  };
  const FileHeader& elf = header->front();
  if (elf.e_type != ET_DYN) return "it is no shared object, but a program or a part of one";
  if (elf.e_phentsize != sizeof(ProgramHeader) ||
      (elf.e_shnum > 0 && elf.e_shentsize != sizeof(SectionHeader)))
    return "its headers are damaged: their sizes are invalid; copy or build it again";
  const auto programs = read_headers<ProgramHeader>(file, elf.e_phoff, elf.e_phnum);
  if (!programs) return missing("its program headers");
  const auto is_segment_within = [size](const ProgramHeader& segment) {
    return lies_within(size, segment.p_offset, segment.p_filesz);
  };
  if (!std::ranges::all_of(*programs, is_segment_within)) return missing("its segments");
  if (!std::ranges::all_of(*programs, is_sound) || !has_mapped_dynamic_section(*programs))
    return "its program headers are damaged: they are inconsistent; copy or build it again";
  const auto sections = read_headers<SectionHeader>(file, elf.e_shoff, elf.e_shnum);
  if (!sections) return missing("its section headers");
  const auto is_section_within = [size](const SectionHeader& section) {
    return section.sh_type == SHT_NOBITS || lies_within(size, section.sh_offset, section.sh_size);
  };
  return std::ranges::all_of(*sections, is_section_within) ? std::string() : missing("its sections");
}

bool everyone_may_write(const fs::path& path, bool sticky_suffices) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0 || (status.st_mode & S_IWOTH) == 0) return false;
  return !sticky_suffices || (status.st_mode & S_ISVTX) == 0;
}

void silence_output() {
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int output : {STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, output);
}

}  // namespace

std::string fault_of_object(const fs::path& file) {
  std::error_code failure;
  const auto status = fs::status(file, failure);
  if (!fs::exists(status)) return {};  // the loader reports why
  if (!fs::is_regular_file(status)) return "it is no file, but a pipe, a device or a folder";
  const std::uint64_t size = fs::file_size(file, failure);
  return failure ? failure.message() : fault_of_headers(file, size);
}

std::string crash_of(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child < 0) return {};  // it is not known, then
  if (child == 0) {
    const rlimit none = {0, 0};
    setrlimit(RLIMIT_CORE, &none);
    silence_output();
    work();
    _exit(0);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return {};
  }
  if (WIFSIGNALED(status))
    return fmt::format("by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  return WEXITSTATUS(status) == 0 ? std::string() : fmt::format("with status {}", WEXITSTATUS(status));
}

std::string exposure_of(const fs::path& file) {
  if (everyone_may_write(file, false)) return "everyone may write to it";
  const fs::path folder = file.parent_path();
  // In a sticky folder, such as /tmp, nobody else can replace the file.
  if (everyone_may_write(folder, true)) return "everyone may write to its folder, " + folder.string();
  return {};
}

}  // namespace crisp::stage
