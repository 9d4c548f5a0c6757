// SPDX-License-Identifier: BSD-3-Clause

// Configuration of jemalloc, read before the first allocation. Some hundred megabytes of scans wait for their
// clocks to be settled; with huge pages the kernel has a five-hundredth of the page faults. Stages release
// such arrays and allocate them again within seconds, so that memory goes back to the system after a minute
// only.
extern "C" {
extern const char* const malloc_conf;
const char* const malloc_conf = "thp:always,dirty_decay_ms:60000,muzzy_decay_ms:60000";
}
