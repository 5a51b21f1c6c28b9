/// Tables for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace taut::cli {

/// Columns as wide as their widest cell; the first one to the left, the others to the right. A
/// table of more than 60 rows ends with how many are missing.
class Table {
 public:
  explicit Table(std::vector<std::string> head) { rows_.push_back(std::move(head)); }
  void Add(std::vector<std::string> row);
  std::string Text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
  std::size_t added_ = 0;
};

/// With so many decimals; what is nothing but round-off is 0, and 0 has no sign.
std::string Fixed(double x, int digits);

}  // namespace taut::cli
