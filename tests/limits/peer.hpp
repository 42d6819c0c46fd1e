// What a time that was measured here and now would be on a machine that does nothing else. Other processes take a part
// of the caches and the other half of a core, and a virtual machine may have to ask its host for each page of memory.
#pragma once

#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ctime>

namespace breve::limits {

inline double processor_time(clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
  timespec now;
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The processor time of a thread, and the pages of memory that were new to it.
struct Used {
  double time = 0;  // s
  long pages = 0;

  static Used now() {
    rusage usage;
    getrusage(RUSAGE_THREAD, &usage);
    return {processor_time(), usage.ru_minflt};
  }
  Used operator-(const Used& other) const { return {time - other.time, pages - other.pages}; }
};

/// Plain work that is measured next to what it is compared with. What it takes on an idle machine follows from what it
/// is, and not from another measurement.
class Peer {
 public:
  /// @return  s that the last `rest` s of `used` would be on an idle machine; never more than they were. As few of the
  ///          pages as possible are taken to belong to the rest.
  static double idle(const Used& used, double rest) {
    const double page = std::max(kPage, seconds_of_a_page());
    const double pages = std::max(0.0, static_cast<double>(used.pages) - (used.time - rest) / page);
    const double computed = std::max(0.0, rest - pages * page);
    return std::min(rest, computed / slowness() + pages * kPage);
  }

 private:
  // A multiplication and an addition that wait for the step before take 4 cycles: 2 ns at 2 GHz.
  static constexpr std::uint64_t kSteps = 1000000;
  static constexpr double kStep = 2e-9;
  static double slowness() {
    const double began = processor_time();
    std::uint64_t state = 1;
    for (std::uint64_t i = 0; i < kSteps; ++i) {
      state = state * 6364136223846793005U + 1442695040888963407U;
      asm volatile("" : "+r"(state));  // is needed, in this order
    }
    return std::max(1.0, (processor_time() - began) / (kStep * static_cast<double>(kSteps)));
  }

  // A system that runs on the machine itself gives a process a page, and clears it, within half a microsecond.
  static constexpr double kPage = 0.5e-6;
  static double seconds_of_a_page() {
    constexpr std::size_t kPages = 512, kBytes = 4096;
    void* const memory = mmap(nullptr, kPages * kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return 0;
    const Used began = Used::now();
    for (std::size_t i = 0; i < kPages; ++i) static_cast<volatile unsigned char*>(memory)[i * kBytes] = 1;
    const Used used = Used::now() - began;
    munmap(memory, kPages * kBytes);
    return used.time / static_cast<double>(std::max(1L, used.pages));
  }
};

}  // namespace breve::limits
