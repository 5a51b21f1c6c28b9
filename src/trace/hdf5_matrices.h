/// Matrices and lists of names in an HDF5 file, for other programs.
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

/// Writes a new file, which replaces a file of that name when it is complete. Creates the groups of
/// a path. Returns false and reports an error if it cannot be written.
bool WriteHdf5(const std::string& path, const Hdf5Content& content, Diagnostics& out);

}  // namespace taut::trace
