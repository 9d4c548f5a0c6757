// SPDX-License-Identifier: BSD-3-Clause

// What jemalloc reads before it gives out any memory. Some hundred megabytes of scans wait for their clocks
// to be settled; in huge pages they cost the kernel a five-hundredth of the faults.
extern "C" {
extern const char* const malloc_conf;
const char* const malloc_conf = "thp:always";
}
