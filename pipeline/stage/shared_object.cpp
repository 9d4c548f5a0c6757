// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/whole_file.hpp"

#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

namespace crisp {
namespace {

using FileHeader = ElfW(Ehdr);
using ProgramHeader = ElfW(Phdr);
using SectionHeader = ElfW(Shdr);

template <class Header>
std::optional<std::vector<Header>> read_headers(std::ifstream& stream, std::uint64_t at, std::size_t count) {
  std::vector<Header> headers(count);
  stream.seekg(static_cast<std::streamoff>(at));
  stream.read(reinterpret_cast<char*>(headers.data()), static_cast<std::streamsize>(count * sizeof(Header)));
  if (!stream) return std::nullopt;
  return headers;
}

bool is_of_this_machine(const FileHeader& header) {
  constexpr unsigned char kClass = sizeof(void*) == 8 ? ELFCLASS64 : ELFCLASS32;
  return std::memcmp(header.e_ident, ELFMAG, SELFMAG) == 0 && header.e_ident[EI_CLASS] == kClass;
}

/// Whether so many bytes from there on are in a file of this size.
bool lies_within(std::uint64_t size, std::uint64_t at, std::uint64_t bytes) {
  return at <= size && bytes <= size - at;
}

}  // namespace

std::string what_is_cut_off(const std::filesystem::path& file) {
  std::error_code failure;
  const std::uint64_t size = std::filesystem::file_size(file, failure);
  std::ifstream stream(file, std::ios::binary);
  const auto header = failure ? std::nullopt : read_headers<FileHeader>(stream, 0, 1);
  if (!header || !is_of_this_machine(header->front())) return {};
  const auto missing = [size](const char* what) {
    return fmt::format("it is cut short: {} reach beyond its {} bytes; copy or build it anew", what, size);
  };
  const FileHeader& elf = header->front();
  const auto programs = read_headers<ProgramHeader>(stream, elf.e_phoff, elf.e_phnum);
  if (!programs) return missing("its program headers");
  const auto is_segment_within = [size](const ProgramHeader& segment) {
    return lies_within(size, segment.p_offset, segment.p_filesz);
  };
  if (!std::ranges::all_of(*programs, is_segment_within)) return missing("its segments");
  const auto sections = read_headers<SectionHeader>(stream, elf.e_shoff, elf.e_shnum);
  if (!sections) return missing("its section headers");
  const auto is_section_within = [size](const SectionHeader& section) {
    return section.sh_type == SHT_NOBITS || lies_within(size, section.sh_offset, section.sh_size);
  };
  return std::ranges::all_of(*sections, is_section_within) ? std::string() : missing("its sections");
}

}  // namespace crisp
