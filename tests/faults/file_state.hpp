// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace crisp::test {

/// The files of a folder and of those in it, by their path relative to it, with their bytes.
using Files = std::map<std::string, std::string>;
Files list_files(const std::filesystem::path& folder);

/// A part of a file, or a lock.
bool is_hidden(const std::string& name);
/// A record of a run: when and how it went.
bool is_record(const std::string& name);
/// A batch's own account: its manifest and the tables that are made of it.
bool is_account(const std::string& name);
/// Whether the file is complete, as far as its content shows; the last line or record of one that grows may
/// be cut off where the program was killed.
bool is_whole(const std::string& name, const std::string& bytes, bool may_be_cut);

/// Whether both sets have the file, and with the same content but for times, or neither does.
bool same_file(const std::string& name, const Files& files, const Files& expected);

}  // namespace crisp::test
