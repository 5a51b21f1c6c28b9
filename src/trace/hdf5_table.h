/// Reader of tables of numbers in HDF5 files of other programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "trace/table_budget.h"

namespace taut::trace {

struct Hdf5Table {
  int rows = 0, columns = 0;
  std::vector<double> values;  ///< Numbers of the table, row by row.
};

/// Reads a two-dimensional dataset of any number type, and adds the number of values to `budget`.
/// Returns nothing and reports an error if the dataset is missing or exceeds the budget. A child
/// process opens the file, as for traces (readers.h).
std::optional<Hdf5Table> ReadHdf5Table(const std::string& path, const std::string& name,
                                       TableBudget& budget, Diagnostics& out);

}  // namespace taut::trace
