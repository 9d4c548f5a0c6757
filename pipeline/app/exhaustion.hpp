// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace crisp::app {

/// Lets the program end with a message and exit status 1 where the memory is exhausted in a thread or in a
/// destructor, from where no exception can be passed on. Files that are not complete are removed.
void end_where_memory_is_exhausted();

}  // namespace crisp::app
