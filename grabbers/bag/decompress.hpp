// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace crisp::bag {

/// Decompresses a chunk.
/// @param method  "", "none", "bz2", "lz4" (a frame) or "zstd"
/// @param size    [bytes] of the result, by the bag's header
/// @param room    holds the result, if the bytes are compressed; memory that it has is used again
/// @return the result, in `room` or in `bytes`
/// @throws BagDamage  if the bytes cannot be decompressed, have another size, or the method is not known
std::string_view decompress(std::string_view method, std::string_view bytes, std::uint64_t size,
                            std::string& room);

}  // namespace crisp::bag
