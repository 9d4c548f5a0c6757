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

#include "pipeline/data/error.hpp"

namespace crisp {

FileDigest digest_of(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error("cannot read " + file.string() + ": " + std::strerror(errno));

  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> hash(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  EVP_DigestInit_ex(hash.get(), EVP_sha256(), nullptr);
  FileDigest digest;
  std::vector<char> block(1 << 20);
  while (stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto count = static_cast<std::size_t>(stream.gcount());
    EVP_DigestUpdate(hash.get(), block.data(), count);
    digest.bytes += count;
  }
  if (stream.bad()) throw Error("cannot read " + file.string() + ": " + std::strerror(errno));

  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned length = 0;
  EVP_DigestFinal_ex(hash.get(), bytes.data(), &length);
  for (unsigned i = 0; i < length; ++i) digest.sha256 += fmt::format("{:02x}", bytes[i]);
  return digest;
}

}  // namespace crisp
