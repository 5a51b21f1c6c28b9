#include <cmath>
#include <map>

#include "description/gait_keys.h"
#include "description/merged_file.h"
#include "description/read_keys.h"

namespace taut {
namespace description {
namespace {

/// Complains about names that are there twice; both kinds of gait name their parts.
template <class Part>
void CheckTwice(const std::vector<Part>& parts, const std::string& what, const Scope& scope) {
  std::map<std::string, SourceRef> seen;
  for (const Part& part : parts) {
    if (part.name.empty()) continue;
    const auto [first, fresh] = seen.emplace(part.name, part.at);
    if (fresh) continue;
    scope.out.Error(part.at, "there are two " + what + " " + part.name,
                    "the first is in line " + std::to_string(first->second.line));
  }
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

void Check(const MapReader& map, SineGait& sine) {
  CheckTwice(sine.waves, "waves", map.scope());
  if (map.Has("waves") && sine.waves.empty() && map.scope().out.ok()) {
    map.Error("waves", "sine.waves must have a wave or more");
  }
}

void Check(const MapReader& map, CpgGait& cpg) { CheckTwice(cpg.groups, "groups", map.scope()); }

void Check(const MapReader& map, TableText& table) {
  const std::size_t errors_before = map.scope().out.items().size();
  const auto drives =
      map.scope().spelling.index > 0 ? GaitDrives::kRestLength : GaitDrives::kVelocity;
  const std::string key = map.ExactlyOne({"file", "rows"});
  if (key == "file") {
    if (map.Has("cables")) {
      map.Error("cables", "table.cables has no effect", "the file's columns name the cables");
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

void CheckTable(const TableGait& table, const SourceRef& at, Diagnostics& out) {
  if (table.cables.empty() || table.rows.empty()) {
    out.Error(at, "a table needs a column for a cable and a row");
    return;
  }
  if (table.time_s.front() != 0.0) {
    out.Error(at, "a table's first row is at 0 s, not at " + Shown(table.time_s.front()) + " s");
  }
  for (std::size_t i = 1; i < table.time_s.size(); ++i) {
    if (table.time_s[i] > table.time_s[i - 1]) continue;
    out.Error(at, "a table's times must rise, but " + Shown(table.time_s[i]) + " s follows " +
                      Shown(table.time_s[i - 1]) + " s");
    break;
  }
  if (table.repeat_from_s && !(*table.repeat_from_s < table.time_s.back())) {
    out.Error(at, "table.repeat_from_s must be before the last row, which is at " +
                      Shown(table.time_s.back()) + " s");
  }
}

}  // namespace description

std::optional<GaitSpec> LoadGait(const std::string& path, Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  const description::MergedFile file = description::ReadMergedFile(path, "gait", out);
  if (!file.root) return std::nullopt;
  const description::NameTable names = description::ResolveParameters(file.parameters, out);
  description::GaitText gait;
  description::NameSet used;
  description::ReadMapping(*file.root, "", {names, out, &used}, gait);
  if (out.items().size() != errors_before) return std::nullopt;
  description::WarnOfUnused(file.parameters, std::move(used), file.files, out);
  gait.files = file.files;
  if (gait.table_text) {
    gait.table = *gait.table_text;
    gait.files.insert(gait.files.end(), gait.table_text->files.begin(),
                      gait.table_text->files.end());
  }
  return gait;
}

}  // namespace taut
