// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/sha256.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include <crisp/error.hpp>

namespace crisp::files {
namespace {

/// A SHA-256 that is fed block by block.
class Sha256 {
 public:
  Sha256() : hash_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    EVP_DigestInit_ex(hash_.get(), EVP_sha256(), nullptr);
  }

  void add(const char* bytes, std::size_t count) { EVP_DigestUpdate(hash_.get(), bytes, count); }

  /// As hexadecimal digits. Nothing may be added afterwards.
  std::string digits() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
    unsigned length = 0;
    EVP_DigestFinal_ex(hash_.get(), bytes.data(), &length);
    std::string text;
    for (unsigned i = 0; i < length; ++i) text += fmt::format("{:02x}", bytes[i]);
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> hash_;
};

}  // namespace

std::string sha256_of(std::string_view text) {
  Sha256 hash;
  hash.add(text.data(), text.size());
  return hash.digits();
}

FileDigest digest_of(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw Error("cannot read " + file.string() + ": " + std::strerror(errno),
                "check its name and its permissions");
  }

  Sha256 hash;
  FileDigest digest;
  std::vector<char> block(1 << 20);
  while (stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto count = static_cast<std::size_t>(stream.gcount());
    hash.add(block.data(), count);
    digest.bytes += count;
  }
  if (stream.bad())
    throw Error("cannot read " + file.string() + ": " + std::strerror(errno), "check the disk");

  digest.sha256 = hash.digits();
  return digest;
}

}  // namespace crisp::files
