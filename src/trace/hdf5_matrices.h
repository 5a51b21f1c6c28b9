/// Matrices and lists of names in an HDF5 file, for other programs to read.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/matrix.h"

namespace taut::trace {

struct Hdf5Content {
  std::vector<std::pair<std::string, const Matrix*>> matrices;          ///< Path, numbers.
  std::vector<std::pair<std::string, std::vector<double>>> lists;       ///< Path, numbers.
  std::vector<std::pair<std::string, std::vector<std::string>>> texts;  ///< Path, text.
  std::vector<std::pair<std::string, std::string>> attributes;          ///< Of the file.
  std::vector<std::pair<std::string, double>> numbers;                  ///< Of the file.
};

/// Writes a new file, in the place of one of that name once it is complete. Groups of a path are
/// made. False and a complaint if it cannot be written.
bool WriteHdf5(const std::string& path, const Hdf5Content& content, Diagnostics& out);

}  // namespace taut::trace
