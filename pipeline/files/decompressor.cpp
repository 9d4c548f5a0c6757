// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/decompressor.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <limits>

namespace crisp::files {
namespace {

/// gzip, of one member or several one after the other, as gzip and pigz write.
class GzipDecompressor final : public Decompressor {
 public:
  GzipDecompressor() {
    constexpr int kGzip = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, kGzip) != Z_OK) throw CompressionFault("zlib has no memory");
  }
  ~GzipDecompressor() override { inflateEnd(&stream_); }

  std::size_t run(std::string_view& from, char* to, std::size_t most) override {
    constexpr std::size_t kMax = std::numeric_limits<uInt>::max();
    stream_.next_out = reinterpret_cast<Bytef*>(to);
    stream_.avail_out = static_cast<uInt>(std::min(most, kMax));
    const std::size_t room = stream_.avail_out;
    while (!from.empty() && stream_.avail_out == room) {
      if (ended_) inflateReset(&stream_);
      // zlib's interface takes what it does not change without const
      stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(from.data()));
      stream_.avail_in = static_cast<uInt>(std::min(from.size(), kMax));
      const std::size_t had = stream_.avail_in;
      const int status = inflate(&stream_, Z_NO_FLUSH);
      from.remove_prefix(had - stream_.avail_in);
      ended_ = status == Z_STREAM_END;
      if (status != Z_OK && status != Z_STREAM_END)
        throw CompressionFault(stream_.msg ? stream_.msg : "its compressed data are damaged");
    }
    return room - stream_.avail_out;
  }
  bool may_end() const override { return ended_; }

 private:
  z_stream stream_{};
  bool ended_ = false;  ///< of the member; another may follow
};

class ZstdDecompressor final : public Decompressor {
 public:
  std::size_t run(std::string_view& from, char* to, std::size_t most) override {
    ZSTD_outBuffer out{to, most, 0};
    if (from.empty() && left_ == 0) return 0;  // it would request the next frame
    do {
      ZSTD_inBuffer in{from.data(), from.size(), 0};
      left_ = ZSTD_decompressStream(context_.get(), &out, &in);
      if (ZSTD_isError(left_) != 0) throw CompressionFault(ZSTD_getErrorName(left_));
      from.remove_prefix(in.pos);
    } while (out.pos == 0 && !from.empty());
    return out.pos;
  }
  bool may_end() const override { return left_ == 0; }

 private:
  std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context_{ZSTD_createDCtx(), ZSTD_freeDCtx};
  std::size_t left_ = 0;  ///< 0: a frame has ended
};

}  // namespace

std::unique_ptr<Decompressor> Decompressor::of(std::string_view begin) {
  if (begin.starts_with("\x1f\x8b\x08")) return std::make_unique<GzipDecompressor>();
  if (begin.starts_with("\x28\xb5\x2f\xfd")) return std::make_unique<ZstdDecompressor>();
  return nullptr;
}

}  // namespace crisp::files
