#include "table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "taut/diagnostics.h"

namespace taut::cli {

constexpr std::size_t kMostRows = 60;

void Table::Add(std::vector<std::string> row) {
  ++added_;
  if (added_ > kMostRows) return;
  for (std::string& cell : row) cell = Printable(cell);
  rows_.push_back(std::move(row));
}

std::string Table::Text() const {
  std::vector<std::size_t> width(rows_[0].size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows_) {
    std::string line = fmt::format("  {:<{}}", row[0], width[0]);
    for (std::size_t i = 1; i < row.size(); ++i) line += fmt::format("  {:>{}}", row[i], width[i]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  if (added_ > kMostRows) text += fmt::format("  ... and {} more\n", added_ - kMostRows);
  return text;
}

std::string Fixed(double x, int digits) {
  std::string text = fmt::format("{:.{}f}", std::fabs(x) < 5e-10 ? 0.0 : x, digits);
  return text.find_first_not_of("-0.") == std::string::npos && text[0] == '-' ? text.substr(1)
                                                                              : text;
}

}  // namespace taut::cli
