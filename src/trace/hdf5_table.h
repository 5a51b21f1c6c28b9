/// Tables of numbers in HDF5 files that other programs wrote.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::trace {

struct Hdf5Table {
  int rows = 0, columns = 0;
  std::vector<double> values;  ///< Row by row.
};

/// A data set of two dimensions with numbers of any kind. Nothing and a complaint if there is none
/// called `name`, or it has more than `most` numbers. A child process opens the file, as for traces
/// (readers.h).
std::optional<Hdf5Table> ReadHdf5Table(const std::string& path, const std::string& name,
                                       double most, Diagnostics& out);

}  // namespace taut::trace
