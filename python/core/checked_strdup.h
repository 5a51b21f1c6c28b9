/// `strdup` that throws std::bad_alloc. pybind11 uses the result of `strdup` unchecked, so that
/// missing memory would crash the interpreter. Included before every other header of the module
/// (python/CMakeLists.txt).
#pragma once

#include <cstring>
#include <new>

namespace taut::python {

inline char* CheckedStrdup(const char* text) {
  char* const copy = ::strdup(text);
  if (copy == nullptr) throw std::bad_alloc();
  return copy;
}

}  // namespace taut::python

#define strdup taut::python::CheckedStrdup
