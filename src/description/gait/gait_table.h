/// Keys of tables of signals, in gait files or in separate CSV files.
#pragma once

#include "description/gait/gait_parts.h"
#include "description/yaml/head_keys.h"

namespace taut::description {

inline const Choices<bool> kInterpolations{{"hold", false}, {"linear", true}};

struct RowsForm {
  static constexpr const char* kSchema =
      R"("type": "array", "title": "[[time_s, signal, ...], ...]", )"
      R"("items": {"type": "array", "items": {"$ref": "#/$defs/number"}})";
};
struct TableText : TableGait {
  Raw<FileForm> file;
  Raw<RowsForm> rows_text;
  std::vector<std::string> files;  ///< Files that were read.
};
template <class Io, Either<TableGait, TableText> Table>
void Keys(Io& io, Table& t) {
  io.Map("table", "table",
         "Signals from a table, such as `taut gait export` writes. Required: either `file`, or "
         "`cables` and "
         "`rows`.",
         R"({"file": "commands.csv", "repeat_from_s": 0})");
  if constexpr (!Io::kResolved) {
    io.Rule(R"("oneOf": [{"required": ["rows", "cables"]}, {"required": ["file"]}])");
    io("file", t.file,
       "Text file, relative to this file's folder: a line `time_s,outer_top_1_m_per_s,...` "
       "(`outer_top_1_m` with `drives: rest_length`), then one line per row; lines that begin with "
       "# are comments.");
  }
  io("cables", t.cables, "Names of the cables, one per column.");
  if constexpr (Io::kResolved) {
    io("time_s", t.time_s);
    io("rows", t.rows);
    io("linear", t.linear);
  } else {
    io("rows", t.rows_text,
       "Time and one signal per cable, in m/s or m; the first time is 0, and times increase.");
    io("interpolation", t.linear, kInterpolations,
       "Value between rows. `hold`: the value of the last row. `linear`: interpolated.");
  }
  io("repeat_from_s", t.repeat_from_s, kFixed, Bound::kNonNegative,
     "Time to which the table returns after the last row, repeatedly. Default: the last row is "
     "held.");
}
void Check(const MapReader& map, TableText& table);
void CheckNumbers(const TableGait& table, const SourceRef& at, Diagnostics& out);
void Resolve(const TableGait& table, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out);
/// Returns the rows of the table as lines of YAML.
std::string LinesBesideKeys(const TableGait& table);

}  // namespace taut::description
