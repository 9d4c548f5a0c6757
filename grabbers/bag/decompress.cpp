// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/decompress.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

#include "grabbers/bag/byte_cursor.hpp"

namespace crisp::bag {
namespace {

constexpr const char* kDamaged = "chunks that cannot be decompressed";

/// Makes room for so many bytes, but never for more than what `compressed` bytes can have become.
void make_room(std::string& out, std::uint64_t size, std::size_t compressed, std::uint64_t best_ratio) {
  if (size / best_ratio > compressed + 1) throw BagDamage{kDamaged};
  out.resize(size);
}

void from_bz2(std::string_view bytes, std::uint64_t size, std::string& out) {
  constexpr std::uint64_t kBestRatio = 100'000;  // 45 bytes of bzip2 can be 900 kB of zeros, and more of them
  constexpr std::uint64_t kMax = std::uint64_t{1} << 31;
  if (size > kMax || bytes.size() > kMax) throw BagDamage{kDamaged};
  make_room(out, size, bytes.size(), kBestRatio);
  auto written = static_cast<unsigned>(size);
  // bzip2's interface takes what it does not change without const
  const int status = BZ2_bzBuffToBuffDecompress(out.data(), &written, const_cast<char*>(bytes.data()),
                                                static_cast<unsigned>(bytes.size()), 0, 0);
  if (status != BZ_OK || written != size) throw BagDamage{kDamaged};
}

void from_lz4(std::string_view bytes, std::uint64_t size, std::string& out) {
  constexpr std::uint64_t kBestRatio = 255;
  make_room(out, size, bytes.size(), kBestRatio);
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) throw BagDamage{kDamaged};
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> context(raw,
                                                                             LZ4F_freeDecompressionContext);
  std::size_t written = 0;
  while (!bytes.empty()) {
    std::size_t to = out.size() - written;
    std::size_t from = bytes.size();
    const std::size_t left = LZ4F_decompress(raw, out.data() + written, &to, bytes.data(), &from, nullptr);
    if (LZ4F_isError(left) != 0 || (to == 0 && from == 0)) throw BagDamage{kDamaged};
    written += to;
    bytes.remove_prefix(from);
    if (left == 0) break;
  }
  if (written != size) throw BagDamage{kDamaged};
}

void from_zstd(std::string_view bytes, std::uint64_t size, std::string& out) {
  constexpr std::uint64_t kBestRatio = 100'000;
  make_room(out, size, bytes.size(), kBestRatio);
  if (ZSTD_decompress(out.data(), out.size(), bytes.data(), bytes.size()) != size) throw BagDamage{kDamaged};
}

}  // namespace

std::string_view decompress(std::string_view method, std::string_view bytes, std::uint64_t size,
                            std::string& room) {
  if (method.empty() || method == "none") return bytes;
  if (method == "bz2")
    from_bz2(bytes, size, room);
  else if (method == "lz4")
    from_lz4(bytes, size, room);
  else if (method == "zstd")
    from_zstd(bytes, size, room);
  else
    throw BagDamage{"chunks with an unknown compression"};
  return room;
}

}  // namespace crisp::bag
