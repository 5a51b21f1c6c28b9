/// Writer of matrices and lists of names in an HDF5 file, for other programs.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/matrix.h"

namespace taut::trace {

struct Hdf5Content {
  std::vector<std::pair<std::string, const Matrix*>> matrices;          ///< Pairs of path and
                                                                        ///< matrix.
  std::vector<std::pair<std::string, std::vector<double>>> lists;       ///< Pairs of path and
                                                                        ///< numbers.
  std::vector<std::pair<std::string, std::vector<std::string>>> texts;  ///< Pairs of path and
                                                                        ///< texts.
  std::vector<std::pair<std::string, std::string>> attributes;          ///< Text attributes of the
                                                                        ///< file.
  std::vector<std::pair<std::string, double>> numbers;                  ///< Number attributes of
                                                                        ///< the file.
};

/// Writes a new file, including the groups of all paths. Replaces an existing file only when the
/// new one is complete. Returns false and reports an error on failure.
bool WriteHdf5(const std::string& path, const Hdf5Content& content, Diagnostics& out);

}  // namespace taut::trace
