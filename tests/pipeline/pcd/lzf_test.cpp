// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/pcd/lzf.hpp"

#include <gtest/gtest.h>
#include <liblzf/lzf.h>

#include <random>

namespace crisp {
namespace {

using namespace crisp::pcd;

/// liblzf is the judge.
std::string expanded(const std::string& compressed, std::size_t size) {
  std::string bytes(size + 1, '?');
  const auto n = lzf_decompress(compressed.data(), static_cast<unsigned>(compressed.size()), bytes.data(),
                                static_cast<unsigned>(bytes.size()));
  return bytes.substr(0, n);
}

/// Bytes of so many different values: 256 cannot be compressed, 1 can be best.
std::string sample(std::size_t size, unsigned values) {
  std::mt19937 random(42);
  std::string bytes(size, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random() % values);
  return bytes;
}

TEST(Lzf, WhatItCompressesIsExpandedToTheSame) {
  for (const unsigned values : {1U, 2U, 16U, 256U}) {
    for (const std::size_t size : {1, 2, 3, 4, 31, 32, 33, 263, 264, 265, 266, 267, 8191, 8193, 100000}) {
      const std::string bytes = sample(size, values);
      ASSERT_EQ(expanded(compress_lzf(bytes), size), bytes) << size << " bytes of " << values << " values";
    }
  }
}

TEST(Lzf, ARepetitionOfEveryLengthAndDistanceIsExpandedToTheSame) {
  const std::string noise = sample(9000, 256);
  for (std::size_t length = 3; length < 300; ++length) {
    const std::string bytes = noise.substr(0, 8192 - 150 + length) + noise.substr(0, length);
    ASSERT_EQ(expanded(compress_lzf(bytes), bytes.size()), bytes) << length;
  }
}

TEST(Lzf, RepetitionShrinksAndNoiseHardlyGrows) {
  EXPECT_LT(compress_lzf(sample(100000, 1)).size(), 100000U / 80);
  EXPECT_LE(compress_lzf(sample(100000, 256)).size(), 100000U * 33 / 32 + 1);
}

TEST(Lzf, NothingBecomesNothing) { EXPECT_EQ(compress_lzf(""), ""); }

}  // namespace
}  // namespace crisp
