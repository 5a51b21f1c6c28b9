#include <charconv>
#include <sstream>

#include "base/input_file.h"
#include "description/gait_parts.h"
#include "description/yaml_tree.h"

namespace taut::description {
namespace {

constexpr std::size_t kMaxErrors = 20;

std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != ' ' && c != '\t' && c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

/// "outer_top_1" of "outer_top_1_m". Empty if the name has not the unit of the quantity.
std::string CableOf(const std::string& cell, GaitDrives drives) {
  const std::string unit = UnitOfName(drives);
  const bool good = cell.size() > unit.size() && cell.ends_with(unit);
  return good ? cell.substr(0, cell.size() - unit.size()) : std::string();
}

bool ReadHeader(const std::vector<std::string>& cells, GaitDrives drives, const SourceRef& at,
                TableGait& table, Diagnostics& out) {
  bool good = cells.front() == "time_s";
  if (!good) out.Error(at, "the first column must be time_s, got \"" + cells.front() + "\"");
  for (std::size_t i = 1; i < cells.size(); ++i) {
    const std::string& cell = cells[i];
    const std::string cable = CableOf(cell, drives);
    if (!cable.empty()) {
      table.cables.push_back(cable);
      continue;
    }
    const bool velocity = drives == GaitDrives::kVelocity;
    const std::string of_other =
        CableOf(cell, velocity ? GaitDrives::kRestLength : GaitDrives::kVelocity);
    out.Error(at, "column " + std::to_string(i + 1) + " is \"" + cell + "\"",
              of_other.empty() ? std::string("a cable's name with its unit, such as outer_top_1") +
                                     UnitOfName(drives)
                               : WhoDrives(drives) + (" has " + of_other) + UnitOfName(drives));
    good = false;
  }
  return good;
}

/// False: a cell was wrong.
bool ReadRow(const std::vector<std::string>& cells, const SourceRef& at, TableGait& table,
             Diagnostics& out) {
  if (cells.size() != table.cables.size() + 1) {
    out.Error(at, "a row of " + std::to_string(cells.size()) + " cells under a header of " +
                      std::to_string(table.cables.size() + 1));
    return false;
  }
  std::vector<double> row(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (ToNumber(cells[i], row[i])) continue;
    out.Error(at, "\"" + cells[i] + "\" is not a finite number", "column " + std::to_string(i + 1));
    return false;
  }
  table.time_s.push_back(row.front());
  table.rows.emplace_back(row.begin() + 1, row.end());
  return true;
}

}  // namespace

bool ToNumber(const std::string& text, double& number) {
  const char* end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, number);
  return status == std::errc() && stop == end && number - number == 0.0;  // finite
}

const char* UnitOfName(GaitDrives drives) {
  return drives == GaitDrives::kVelocity ? "_m_per_s" : "_m";
}

const char* WhoDrives(GaitDrives drives) {
  return drives == GaitDrives::kVelocity ? "a gait that drives velocities"
                                         : "a gait that drives rest lengths";
}

std::optional<TableGait> ReadGaitTable(const std::string& path, GaitDrives drives,
                                       Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  const auto text = base::ReadInputFile(path, kMaxFileBytes, "", out);
  if (!text) return std::nullopt;
  std::istringstream in(*text);
  TableGait table;
  bool header = false, good = true;
  int number = 0;
  for (std::string line; good && std::getline(in, line);) {
    const SourceRef at{path, ++number, 1};
    if (line.empty() || line == "\r" || line.front() == '#') continue;
    const std::vector<std::string> cells = Cells(line);
    if (!header) {
      good = ReadHeader(cells, drives, at, table, out);
      header = true;
    } else if (!ReadRow(cells, at, table, out)) {
      good = out.items().size() < errors_before + kMaxErrors;
    }
  }
  if (!header) {
    out.Error({path, 1, 1}, "has no header line",
              std::string("such as time_s,outer_top_1") + UnitOfName(drives));
  }
  if (out.items().size() != errors_before) return std::nullopt;
  CheckTable(table, {path, 1, 1}, out);
  return table;
}

}  // namespace taut::description
