#include "description/gait_keys.h"
#include "description/write_keys.h"
#include "taut/files.h"

namespace taut {
namespace description {
namespace {

/// The rows that `TableGait` has apart from their times.
std::string Rows(const TableGait& table) {
  std::string out = "  rows:\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    out += "    - [" + Shown(table.time_s[i]);
    for (const double v : table.rows[i]) out += ", " + Shown(v);
    out += "]\n";
  }
  return out;
}

}  // namespace
}  // namespace description

std::string GaitYaml(const GaitSpec& gait) {
  description::GaitText text{gait, {}, {}};
  if (gait.table) text.table_text = description::TableText{*gait.table, {}, {}, {}};
  description::BlockWriter<false> writer("");
  Keys(writer, std::as_const(text));
  return "taut: 1\nkind: gait\n" + writer.text() +
         (gait.table ? description::Rows(*gait.table) : "");
}

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

bool SaveGait(const GaitSpec& gait, const std::string& path, Diagnostics& out) {
  return WriteWholeFile(path, GaitYaml(gait), out);
}

}  // namespace taut
