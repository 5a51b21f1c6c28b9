#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "description/gait_parts.h"
#include "description/merged_file.h"
#include "description/reader.h"

namespace taut {
namespace description {
namespace {

SineWave ReadWave(const Value& value, const Scope& scope) {
  const MapReader map(value, "waves",
                      {"name", "cables", "amplitude_m_per_s", "phase_rad", "offset_m_per_s",
                       "phase_per_segment_rad", "frequency_hz"},
                      scope);
  SineWave wave;
  wave.at = value.at;
  wave.name = map.Name("name");
  if (const Value* cables = map.Require("cables")) {
    wave.cables = ReadMatch(*cables, map.Path("cables"), scope);
  }
  wave.amplitude_m_per_s = map.Number("amplitude_m_per_s", Bound::kAny);
  wave.phase_rad = map.NumberOr("phase_rad", 0.0, Bound::kAny);
  wave.offset_m_per_s = map.NumberOr("offset_m_per_s", 0.0, Bound::kAny);
  wave.phase_per_segment_rad = map.NumberOr("phase_per_segment_rad", 0.0, Bound::kAny);
  wave.frequency_hz = map.FindNumber("frequency_hz", Bound::kNonNegative);
  return wave;
}

/// Complains about a name that was there before; both kinds of gait name their parts.
void CheckTwice(std::map<std::string, SourceRef>& seen, const std::string& name,
                const SourceRef& at, const std::string& what, const Scope& scope) {
  if (name.empty()) return;
  const auto [first, fresh] = seen.emplace(name, at);
  if (fresh) return;
  scope.out.Error(at, "there are two " + what + " " + name,
                  "the first is in line " + std::to_string(first->second.line));
}

SineGait ReadSine(const Value& value, const Scope& scope) {
  const MapReader map(value, "sine", {"frequency_hz", "waves"}, scope);
  SineGait sine;
  sine.frequency_hz = map.Number("frequency_hz", Bound::kNonNegative);
  std::map<std::string, SourceRef> names;
  for (const ValuePtr& item : Items(map.Require("waves"), "sine.waves", scope)) {
    sine.waves.push_back(ReadWave(*item, scope));
    CheckTwice(names, sine.waves.back().name, item->at, "waves", scope);
  }
  if (map.Has("waves") && sine.waves.empty() && scope.out.ok()) {
    map.Error("waves", "sine.waves must have a wave or more");
  }
  return sine;
}

CouplingGroup ReadGroup(const Value& value, const Scope& scope) {
  const MapReader map(value, "groups", {"name", "weight_per_m", "phase_rad"}, scope);
  CouplingGroup group;
  group.at = value.at;
  group.name = map.Text("name");
  group.weight_per_m = map.Number("weight_per_m", Bound::kAny);
  group.phase_rad = map.Number("phase_rad", Bound::kAny);
  return group;
}

CpgGait ReadCpg(const Value& value, const Scope& scope) {
  const MapReader map(value, "cpg",
                      {"frequency_hz", "amplitude_m_per_s", "convergence_per_s",
                       "integrator_step_s", "symmetry", "order", "inverted", "feedback", "groups"},
                      scope);
  CpgGait cpg;
  cpg.at = value.at;
  cpg.frequency_hz = map.Number("frequency_hz", Bound::kAny);
  cpg.amplitude_m_per_s = map.Number("amplitude_m_per_s", Bound::kNonNegative);
  cpg.convergence_per_s =
      map.NumberOr("convergence_per_s", cpg.convergence_per_s, Bound::kPositive);
  cpg.integrator_step_s =
      map.NumberOr("integrator_step_s", cpg.integrator_step_s, Bound::kPositive);
  cpg.symmetry = map.ChoiceOr("symmetry", CpgSymmetry::kSegments, kSymmetries);
  cpg.order = map.NamesOr("order", {});
  if (const Value* inverted = map.Find("inverted")) {
    cpg.inverted = ReadMatch(*inverted, map.Path("inverted"), scope);
  }
  if (const Value* value_of_feedback = map.Find("feedback")) {
    const MapReader feedback(*value_of_feedback, "cpg.feedback",
                             {"gain_rad_per_n_s", "reference_n"}, scope);
    cpg.feedback = {feedback.Number("gain_rad_per_n_s", Bound::kAny),
                    feedback.NumberOr("reference_n", 0.0, Bound::kAny)};
  }
  std::map<std::string, SourceRef> names;
  for (const ValuePtr& item : Items(map.Find("groups"), "cpg.groups", scope)) {
    cpg.groups.push_back(ReadGroup(*item, scope));
    CheckTwice(names, cpg.groups.back().name, item->at, "groups", scope);
  }
  return cpg;
}

void ReadRows(const MapReader& map, TableGait& table, const Scope& scope) {
  table.cables = map.NamesOr("cables", {});
  if (!map.Has("cables")) map.Require("cables");
  for (const ValuePtr& item : Items(map.Find("rows"), "table.rows", scope)) {
    const auto row = ReadNumbers(*item, "table.rows: a row", table.cables.size() + 1, scope);
    if (!row) continue;
    table.time_s.push_back(row->front());
    table.rows.emplace_back(row->begin() + 1, row->end());
  }
}

TableGait ReadTable(const Value& value, std::vector<std::string>& files, const Scope& scope) {
  const MapReader map(value, "table", {"file", "cables", "rows", "interpolation", "repeat_from_s"},
                      scope);
  const std::size_t errors_before = scope.out.items().size();
  TableGait table;
  const std::string key = map.ExactlyOne({"file", "rows"});
  if (key == "file") {
    if (map.Has("cables")) {
      map.Error("cables", "table.cables has no effect", "the file's columns name the cables");
    }
    const std::string path = PathBeside(map.Find("file")->at.file, map.Text("file"));
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) {
      scope.out.Error(map.Find("file")->at, "table.file: there is no file \"" + path + "\"",
                      "as seen from the folder of the file that names it");
    } else if (auto read = ReadGaitTable(path, scope.out)) {
      table = std::move(*read);
      files.push_back(path);
    }
  } else if (key == "rows") {
    ReadRows(map, table, scope);
  }
  table.at = value.at;
  table.linear = map.ChoiceOr("interpolation", false, kInterpolations);
  table.repeat_from_s = map.FindNumber("repeat_from_s", Bound::kNonNegative);
  if (scope.out.items().size() == errors_before) CheckTable(table, value.at, scope.out);
  return table;
}

}  // namespace

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
  description::NameSet used;
  const description::Scope scope{names, out, &used};
  const description::MapReader map(
      *file.root, "",
      {"taut", "kind", "base", "name", "description", "parameters", "sine", "cpg", "table"}, scope);
  GaitSpec gait;
  gait.files = file.files;
  gait.name = map.Name("name");
  gait.description = map.TextOr("description", "");
  const std::string kind = map.ExactlyOne({"sine", "cpg", "table"});
  if (kind == "sine") gait.sine = description::ReadSine(*map.Find(kind), scope);
  if (kind == "cpg") gait.cpg = description::ReadCpg(*map.Find(kind), scope);
  if (kind == "table") gait.table = description::ReadTable(*map.Find(kind), gait.files, scope);
  if (out.items().size() != errors_before) return std::nullopt;
  description::WarnOfUnused(file.parameters, std::move(used), file.files, out);
  return gait;
}

}  // namespace taut
