// SPDX-License-Identifier: BSD-3-Clause

// Configuration of jemalloc, read before the first allocation. Some hundred megabytes of scans wait for their
// clocks to be settled; with huge pages the kernel has a five-hundredth of the page faults.
extern "C" {
extern const char* const malloc_conf;
const char* const malloc_conf = "thp:always";
}
