// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace crisp {

/// Decompresses a chunk.
/// @param method  "", "none", "bz2", "lz4" (a frame) or "zstd"
/// @param size    [bytes] of the result, by the bag's header
/// @throws BagDamage  if the bytes cannot be decompressed, have another size, or the method is not known
std::string decompress(std::string_view method, std::string_view bytes, std::uint64_t size);

}  // namespace crisp
