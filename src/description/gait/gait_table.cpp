#include "description/gait/gait_table.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/input_file.h"
#include "description/yaml/read_keys.h"
#include "description/yaml/yaml_tree.h"

namespace taut {
namespace description {
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

/// Returns "outer_top_1" for "outer_top_1_m". Returns an empty text if the unit of the quantity is
/// missing.
std::string CableOf(const std::string& cell, GaitDrives drives) {
  const std::string unit = UnitOfName(drives);
  const bool good = cell.size() > unit.size() && cell.ends_with(unit);
  return good ? cell.substr(0, cell.size() - unit.size()) : std::string();
}

bool ReadHeader(const std::vector<std::string>& cells, GaitDrives drives, const SourceRef& at,
                TableGait& table, Diagnostics& out) {
  bool good = cells.front() == "time_s";
  if (!good)
    out.Error("gait_table.no_time", at,
              "the first column must be time_s, got \"" + cells.front() + "\"");
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
    out.Error("gait_table.bad_column", at,
              "column " + std::to_string(i + 1) + " has the unknown heading \"" + cell + "\"",
              of_other.empty()
                  ? std::string("expected a cable's name with its unit, such as outer_top_1") +
                        UnitOfName(drives)
                  : WhoDrives(drives) + (" needs " + of_other) + UnitOfName(drives));
    good = false;
  }
  return good;
}

/// Reads a row. Returns false after an error.
bool ReadRow(const std::vector<std::string>& cells, const SourceRef& at, TableGait& table,
             Diagnostics& out) {
  if (cells.size() != table.cables.size() + 1) {
    out.Error("gait_table.ragged_row", at,
              "the row has " + std::to_string(cells.size()) + " cells, but the header has " +
                  std::to_string(table.cables.size() + 1));
    return false;
  }
  std::vector<double> row(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (ToNumber(cells[i], row[i])) continue;
    out.Error("gait_table.not_a_number", at, "\"" + cells[i] + "\" is not a finite number",
              "column " + std::to_string(i + 1));
    return false;
  }
  table.time_s.push_back(row.front());
  table.rows.emplace_back(row.begin() + 1, row.end());
  return true;
}

/// Checks a table from a file or from keys.
void CheckTable(const TableGait& table, const SourceRef& at, Diagnostics& out) {
  if (table.cables.empty() || table.rows.empty()) {
    out.Error("gait_table.empty", at, "a table needs at least one column for a cable and one row");
    return;
  }
  if (table.time_s.front() != 0.0) {
    out.Error("gait_table.bad_start", at,
              "the first row of a table must be at 0 s, got " + Shown(table.time_s.front()) + " s");
  }
  for (std::size_t i = 1; i < table.time_s.size(); ++i) {
    if (table.time_s[i] > table.time_s[i - 1]) continue;
    out.Error("gait_table.times_not_increasing", at,
              "the times of a table must increase, but " + Shown(table.time_s[i]) + " s follows " +
                  Shown(table.time_s[i - 1]) + " s");
    break;
  }
  if (table.repeat_from_s && !(*table.repeat_from_s < table.time_s.back())) {
    out.Error("gait_table.bad_repeat", at,
              "table.repeat_from_s must be before the last row, which is at " +
                  Shown(table.time_s.back()) + " s");
  }
}

/// Reads a table from a CSV file with the header "time_s,outer_top_1_m_per_s,...". Lines that begin
/// with # are comments. Returns nothing after an error.
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
    out.Error("gait_table.no_header", {path, 1, 1}, "the table has no header line",
              std::string("such as time_s,outer_top_1") + UnitOfName(drives));
  }
  if (out.items().size() != errors_before) return std::nullopt;
  CheckTable(table, {path, 1, 1}, out);
  return table;
}

void ReadRows(const Value& rows, const Scope& scope, TableGait& table) {
  for (const ValuePtr& item : Items(&rows, "table.rows", scope)) {
    const auto row = ReadNumbers(*item, "table.rows: a row", table.cables.size() + 1, scope);
    if (!row) continue;
    table.time_s.push_back(row->front());
    table.rows.emplace_back(row->begin() + 1, row->end());
  }
}

}  // namespace

void Check(const MapReader& map, TableText& table) {
  const std::size_t errors_before = map.scope().out.items().size();
  const auto drives =
      map.scope().spelling.index > 0 ? GaitDrives::kRestLength : GaitDrives::kVelocity;
  const std::string key = map.ExactlyOne({"file", "rows"});
  if (key == "file") {
    if (map.Has("cables")) {
      map.Error("gait_table.cables_without_effect", "cables", "table.cables has no effect",
                "the headings of the file name the cables");
    }
    const auto path = FindFile(table.file.value, "table.file", map.scope());
    if (auto read = path ? ReadGaitTable(*path, drives, map.scope().out) : std::nullopt) {
      table.cables = std::move(read->cables);
      table.time_s = std::move(read->time_s);
      table.rows = std::move(read->rows);
      table.files.push_back(*path);
    }
  } else if (key == "rows") {
    map.Require("cables");
    ReadRows(*table.rows_text.value, map.scope(), table);
  }
  if (map.scope().out.items().size() == errors_before &&
      !std::isnan(table.repeat_from_s.value_or(0.0))) {
    CheckTable(table, table.at, map.scope().out);
  }
}

void CheckNumbers(const TableGait& table, const SourceRef& at, Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  if (table.rows.size() != table.time_s.size())
    out.Error("gait_table.times_missing", at, "a table needs a time for each row");
  for (const std::vector<double>& row : table.rows) {
    if (row.size() == table.cables.size()) continue;
    out.Error("gait_table.signals_missing", at, "a table's row needs a signal for each cable");
    break;
  }
  if (out.items().size() == errors_before) CheckTable(table, at, out);
}

void Resolve(const TableGait& table, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out) {
  std::vector<std::string> names;
  for (const CableDef& cable : robot.def.cables) names.push_back(cable.name);
  for (const std::string& name : table.cables) {
    const auto found = std::find(names.begin(), names.end(), name);
    const int cable = static_cast<int>(found - names.begin());
    if (found == names.end()) {
      out.Error("cable.unknown", table.at, robot.def.name + " has no cable \"" + name + "\"",
                NameHint(name, names));
    } else if (std::count(resolved.cables.begin(), resolved.cables.end(), cable) > 0) {
      out.Error("gait_table.duplicate_cable", table.at, "the table contains " + name + " twice");
    } else {
      resolved.cables.push_back(cable);
    }
  }
}

std::string LinesBesideKeys(const TableGait& table) {
  std::string out = "  rows:\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    out += "    - [" + Shown(table.time_s[i]);
    for (const double v : table.rows[i]) out += ", " + Shown(v);
    out += "]\n";
  }
  return out;
}

}  // namespace description

std::string GaitTableText(const TableGait& table, GaitDrives drives) {
  std::string out = "time_s";
  for (const std::string& cable : table.cables) {
    out += "," + cable + description::UnitOfName(drives);
  }
  out += '\n';
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    out += description::Shown(table.time_s[i]);
    for (const double v : table.rows[i]) out += "," + description::Shown(v);
    out += '\n';
  }
  return out;
}

}  // namespace taut
