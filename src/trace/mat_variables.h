/// Reader of the numeric variables of MATLAB files of version 7.3, which are HDF5 files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::trace {

/// Real matrix, column by column as in MATLAB.
struct MatVariable {
  std::string name;  ///< Fields of structs are separated by dots: "log.force".
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;

  bool IsVector() const { return rows == 1 || columns == 1; }
  std::size_t size() const { return rows * columns; }
};

/// Returns whether a file begins with the header of a MATLAB file of any version above 4.
bool IsMatFile(const std::string& path);

/// Reads all real numeric and logical matrices. Omits texts, cells, objects such as `timetable`,
/// and complex numbers. A child process opens the file, as for traces (readers.h). Returns nothing
/// and adds an error if the file has another version or is damaged.
std::optional<std::vector<MatVariable>> ReadMatVariables(const std::string& path, Diagnostics& out);

/// Columns of equal length.
struct MatColumns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
};

/// Returns all variables with `rows` values per column. Column j of a matrix is named "name_j",
/// starting at 1. A matrix whose columns have another length, but whose rows have this length, is
/// transposed. `rows` = 0: the number of values of most vectors, the larger one if equal.
MatColumns ColumnsOf(const std::vector<MatVariable>& variables, std::size_t rows);

}  // namespace taut::trace
