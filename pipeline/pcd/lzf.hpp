// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace crisp::pcd {

/// Compresses as LZF does, the method of binary_compressed PCD files; lzf_decompress() of liblzf, and PCL,
/// read it. The same bytes in give the same bytes out.
///
/// liblzf's own compressor does not: it starts from whatever the stack holds (its INIT_HTAB is 0). PCL's
/// does, but lives in pcl_io, which loads 29 libraries of VTK: 18 ms and 25 MB at every start of a program.
/// @param bytes fewer than 2^32
std::string compress_lzf(std::string_view bytes);

}  // namespace crisp::pcd
