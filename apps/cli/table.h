/// Text tables for terminals.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace taut::cli {

/// Table with columns as wide as their widest cell; the first is aligned left, the others right.
/// After 60 rows it ends with the number of omitted rows.
class Table {
 public:
  explicit Table(std::vector<std::string> head) { rows_.push_back(std::move(head)); }
  void Add(std::vector<std::string> row);
  std::string Text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
  std::size_t added_ = 0;
};

/// Formats `x` with `digits` decimals; pure round-off becomes 0, and 0 has no sign.
std::string Fixed(double x, int digits);

}  // namespace taut::cli
