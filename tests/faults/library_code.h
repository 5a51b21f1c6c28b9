/// Code of loaded libraries by address, for inject_faults.cpp: an allocation belongs to the library
/// whose code called the allocator.
#pragma once

#include <link.h>

#include <atomic>
#include <cstdint>
#include <cstring>

namespace faults {

/// Address range of a library's code.
struct Code {
  std::uintptr_t begin = 0, end = 0;
  bool Has(std::uintptr_t at) const { return at >= begin && at < end; }
};
inline Code hdf5;
inline constexpr int kMostLibraries = 32;
inline Code chosen[kMostLibraries];  ///< Libraries whose allocations count.
inline int chosen_count = 0;
/// TAUT_FAULT_LIBRARIES; empty: the allocations of all libraries count.
inline char chosen_names[400] = {};
inline std::atomic<unsigned long long> known_libraries{0};

inline bool IsChosen(const char* library) {
  char names[sizeof chosen_names];
  std::strcpy(names, chosen_names);
  char* rest = nullptr;
  for (char* name = strtok_r(names, ":", &rest); name != nullptr;
       name = strtok_r(nullptr, ":", &rest)) {
    if (std::strstr(library, name) != nullptr) return true;
  }
  return false;
}

/// Callback for each library: records the address ranges.
inline int FindCode(dl_phdr_info* library, std::size_t, void*) {
  const bool is_hdf5 = std::strstr(library->dlpi_name, "libhdf5") != nullptr;
  if (!is_hdf5 && (chosen_names[0] == '\0' || !IsChosen(library->dlpi_name))) return 0;
  for (int i = 0; i < library->dlpi_phnum; ++i) {
    const auto& part = library->dlpi_phdr[i];
    if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
    const std::uintptr_t begin = library->dlpi_addr + part.p_vaddr;
    const Code code{begin, begin + part.p_memsz};
    if (is_hdf5) {
      hdf5 = code;
    } else if (chosen_count < kMostLibraries) {
      chosen[chosen_count++] = code;
    }
  }
  return 0;
}

/// Callback for the first library: the number of libraries that were ever loaded.
inline int CountLibraries(dl_phdr_info* library, std::size_t, void* count) {
  *static_cast<unsigned long long*>(count) = library->dlpi_adds;
  return 1;
}

/// Finds the code of libraries that were loaded since the last call.
inline void FindNewCode() {
  unsigned long long count = 0;
  dl_iterate_phdr(CountLibraries, &count);
  if (known_libraries.exchange(count) == count) return;
  chosen_count = 0;
  dl_iterate_phdr(FindCode, nullptr);
}

}  // namespace faults
