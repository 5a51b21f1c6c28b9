/// Dense matrix of doubles. For linear algebra functions, use another library.
#pragma once

#include <cstddef>
#include <vector>

namespace taut {

/// Row-major matrix. Indices are not checked.
struct Matrix {
  int rows = 0, columns = 0;
  std::vector<double> values;

  Matrix() = default;
  Matrix(int row_count, int column_count)
      : rows(row_count),
        columns(column_count),
        values(static_cast<std::size_t>(row_count) * static_cast<std::size_t>(column_count)) {}
  double& operator()(int row, int column) { return values[Index(row, column)]; }
  double operator()(int row, int column) const { return values[Index(row, column)]; }

 private:
  std::size_t Index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

}  // namespace taut
