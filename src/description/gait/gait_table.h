/// A table of signals as a gait file or a text file of its own has it.
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
  std::vector<std::string> files;  ///< That were read.
};
template <class Io, Either<TableGait, TableText> Table>
void Keys(Io& io, Table& t) {
  io.Map("table", "table",
         "The signals from a table: `taut gait export` writes such files. Either `file`, or "
         "`cables` and `rows`.",
         R"({"file": "commands.csv", "repeat_from_s": 0})");
  if constexpr (!Io::kResolved) {
    io.Rule(R"("oneOf": [{"required": ["rows", "cables"]}, {"required": ["file"]}])");
    io("file", t.file,
       "A text file, seen from this file's folder: a line `time_s,outer_top_1_m_per_s,...` "
       "(`outer_top_1_m` with `drives: rest_length`), then a line a row; lines that begin with # "
       "are "
       "comments.");
  }
  io("cables", t.cables, "Cables by name, one a column.");
  if constexpr (Io::kResolved) {
    io("time_s", t.time_s);
    io("rows", t.rows);
    io("linear", t.linear);
  } else {
    io("rows", t.rows_text,
       "Time and a signal for each cable, in m/s or m; the first time is 0, and times rise.");
    io("interpolation", t.linear, kInterpolations,
       "Between rows: `hold` keeps the last one, `linear` goes straight to the next.");
  }
  io("repeat_from_s", t.repeat_from_s, kFixed, Bound::kNonNegative,
     "At the last row go on from here, again and again. Without it the last row holds.");
}
void Check(const MapReader& map, TableText& table);
void CheckNumbers(const TableGait& table, const SourceRef& at, Diagnostics& out);
void Resolve(const TableGait& table, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out);
/// The rows, which the table of keys leaves to code.
std::string LinesBesideKeys(const TableGait& table);

}  // namespace taut::description
