// `taut export structure`: nodes, bars and strings for tensegrity statics tools.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "any_robot.h"
#include "export.h"
#include "member_groups.h"
#include "output.h"
#include "standard_streams.h"
#include "table.h"
#include "taut/analysis.h"
#include "taut/minimal_experiment.h"
#include "taut/pin_jointed.h"
#include "taut/version.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct StructureArguments {
  PlacedRobotArguments robot;
  std::string out;
  bool json = false, tables = false, weightless = false, equilibrium = false;
};

const char* KindOf(const PinMember& member) {
  switch (member.kind) {
    case PinMember::Kind::kRod:
      return "rod";
    case PinMember::Kind::kBrace:
      return "brace";
    case PinMember::Kind::kBar:
      return "bar";
    case PinMember::Kind::kString:
      break;
  }
  return "string";
}

std::string CsvOf(const Matrix& matrix) {
  std::string text;
  for (int r = 0; r < matrix.rows; ++r) {
    for (int c = 0; c < matrix.columns; ++c) {
      text += fmt::format("{}{}", c > 0 ? "," : "", matrix(r, c));
    }
    text += '\n';
  }
  return text;
}

/// Returns the connectivity matrix: one row per member, one column per node.
template <class Of>
Matrix PerNode(const PinJointed& structure, const Of& of) {
  Matrix m(3, static_cast<int>(structure.nodes.size()));
  for (int n = 0; n < m.columns; ++n) {
    const auto [x, y, z] = of(structure.nodes[static_cast<std::size_t>(n)]);
    m(0, n) = x, m(1, n) = y, m(2, n) = z;
  }
  return m;
}

/// Returns the matrices by file name.
std::vector<std::pair<std::string, Matrix>> MatricesOf(const PinJointed& s) {
  const auto bars = static_cast<std::size_t>(s.bars);
  Matrix q(static_cast<int>(s.members.size()), 1);
  for (int m = 0; m < q.rows; ++m) {
    q(m, 0) = s.members[static_cast<std::size_t>(m)].force_density_n_per_m;
  }
  return {{"N", NodeMatrix(s)},
          {"C_b", Connectivity(s, 0, bars)},
          {"C_s", Connectivity(s, bars, s.members.size())},
          {"S", Clustering(s)},
          {"q", std::move(q)},
          {"W", PerNode(s, [](const PinNode& n) { return n.load_n; })},
          {"R", PerNode(s, [](const PinNode& n) { return n.left_n; })},
          {"pinned", PerNode(s, [](const PinNode& n) {
             return Vec3{n.pinned[0] ? 1.0 : 0.0, n.pinned[1] ? 1.0 : 0.0, n.pinned[2] ? 1.0 : 0.0};
           })}};
}

std::string NodesCsv(const PinJointed& s) {
  std::string text = "node,name,mass_kg,on_ground\n";
  int number = 0;
  for (const PinNode& node : s.nodes) {
    text += fmt::format("{},{},{},{}\n", ++number, node.name, node.mass_kg, int{node.on_ground});
  }
  return text;
}

std::string MembersCsv(const PinJointed& s) {
  std::string text =
      "member,kind,name,from,to,cluster,length_m,rest_length_m,force_n,force_density_n_per_m,"
      "stiffness_n_per_m,area_m2,young_pa,mass_kg\n";
  int number = 0;
  for (const PinMember& m : s.members) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", ++number, KindOf(m), m.name,
                        m.from + 1, m.to + 1, m.cluster + 1, m.length_m, m.rest_length_m, m.force_n,
                        m.force_density_n_per_m, m.stiffness_n_per_m, m.section.area_m2,
                        m.section.young_pa, m.section.mass_kg);
  }
  return text;
}

std::string ClustersCsv(const PinJointed& s) {
  std::string text = "cluster,name,length_m,rest_length_m,force_n,stiffness_n_per_m\n";
  int number = 0;
  for (const PinCluster& c : s.clusters) {
    text += fmt::format("{},{},{},{},{},{}\n", ++number, c.name, c.length_m, c.rest_length_m,
                        c.force_n, c.stiffness_n_per_m);
  }
  return text;
}

ordered_json RowsOf(const Matrix& matrix) {
  ordered_json rows = ordered_json::array();
  for (int r = 0; r < matrix.rows; ++r) {
    ordered_json row = ordered_json::array();
    for (int c = 0; c < matrix.columns; ++c) row.push_back(matrix(r, c));
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string JsonOf(const ModelDef& def, const PinJointed& s) {
  ordered_json all{{"format_version", 1}, {"taut_version", kVersion}, {"model", def.name}};
  for (const auto& [name, matrix] : MatricesOf(s)) all[name] = RowsOf(matrix);
  all["nodes"] = all["members"] = all["clusters"] = ordered_json::array();
  for (const PinNode& n : s.nodes) {
    all["nodes"].push_back({{"name", n.name}, {"mass_kg", n.mass_kg}, {"on_ground", n.on_ground}});
  }
  for (const PinMember& m : s.members) {
    all["members"].push_back({{"kind", KindOf(m)},
                              {"name", m.name},
                              {"from", m.from},
                              {"to", m.to},
                              {"cluster", m.cluster},
                              {"length_m", m.length_m},
                              {"rest_length_m", m.rest_length_m},
                              {"force_n", m.force_n},
                              {"force_density_n_per_m", m.force_density_n_per_m},
                              {"stiffness_n_per_m", m.stiffness_n_per_m},
                              {"area_m2", m.section.area_m2},
                              {"young_pa", m.section.young_pa},
                              {"mass_kg", m.section.mass_kg}});
  }
  for (const PinCluster& c : s.clusters) {
    all["clusters"].push_back({{"name", c.name},
                               {"length_m", c.length_m},
                               {"rest_length_m", c.rest_length_m},
                               {"force_n", c.force_n},
                               {"stiffness_n_per_m", c.stiffness_n_per_m}});
  }
  all["notes"] = s.notes;
  return all.dump(1) + "\n";
}

/// Returns the range of a quantity over the bars or over the strings.
std::string RangeOf(const PinJointed& s, bool bars, double PinMember::*quantity, const char* unit) {
  Range range;
  for (const PinMember& m : s.members) {
    if ((m.kind != PinMember::Kind::kString) == bars) range.Add(m.*quantity);
  }
  return range.Text(3, unit);
}

std::string StructureSummary(const ModelDef& def, const PinJointed& s) {
  const auto bars = static_cast<std::size_t>(s.bars);
  const std::size_t strings = s.members.size() - bars;
  const std::string verdict =
      fmt::format("{}: nodes: {}, bars: {}, strings: {}, clusters of strings: {}", def.name,
                  s.nodes.size(), bars, strings, s.clusters.size() - bars);
  CappedLines lines;
  const auto add = [&](const char* what, bool of_bars, std::size_t count) {
    if (count == 0) return;
    const auto range = [&](double PinMember::*quantity, const char* unit) {
      return RangeOf(s, of_bars, quantity, unit);
    };
    lines.Add(fmt::format("{}: length {}, force {}, force density {}", what,
                          range(&PinMember::length_m, "m"), range(&PinMember::force_n, "N"),
                          range(&PinMember::force_density_n_per_m, "N/m")));
  };
  add("bars", true, bars);
  add("strings", false, strings);
  return lines.Text(verdict);
}

std::string TableOf(const PinJointed& s) {
  Table members({"member", "kind", "from", "to", "length", "force", "force density"});
  members.Add({"", "", "", "", "m", "N", "N/m"});
  for (const PinMember& m : s.members) {
    members.Add({m.name, KindOf(m), s.nodes[static_cast<std::size_t>(m.from)].name,
                 s.nodes[static_cast<std::size_t>(m.to)].name, Fixed(m.length_m, 6),
                 Fixed(m.force_n, 3), Fixed(m.force_density_n_per_m, 3)});
  }
  return members.Text();
}

/// Writes all files into a folder, which may exist.
int WriteFolder(const std::string& folder, const ModelDef& def, const PinJointed& s) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    fmt::print(stderr, "{}: error: cannot create the folder: {}\n", folder, error.message());
    return kFailed;
  }
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto& [name, matrix] : MatricesOf(s)) files.emplace_back(name + ".csv", CsvOf(matrix));
  files.emplace_back("nodes.csv", NodesCsv(s));
  files.emplace_back("members.csv", MembersCsv(s));
  files.emplace_back("clusters.csv", ClustersCsv(s));
  files.emplace_back("structure.json", JsonOf(def, s));
  for (const auto& [name, text] : files) {
    const int exit = WriteNamed((fs::path(folder) / name).string(), text);
    if (exit != kOk) return exit;
  }
  return kOk;
}

/// Moves the robot to the equilibrium that `taut analyze` finds from its pose.
bool Rest(bool weightless, ModelDef& def) {
  LoadCaseSpec loads;
  loads.weight = !weightless && IsHeld(def);
  const Equilibrium at = FindEquilibrium(def, loads);
  if (at.found) {
    def = ModelAt(def, at.pose);
  } else {
    fmt::print(stderr, "error: there is no equilibrium: {}\n", at.why);
  }
  return at.found;
}

int ExportStructure(const StructureArguments& args) {
  int exit = kOk;
  const auto robot = LoadPlacedRobot(args.robot, exit);
  if (!robot) return exit;
  ModelDef def = robot->def;
  if (args.equilibrium && !Rest(args.weightless, def)) return kFailed;
  const PinJointed structure = PinJointedOf(def, !args.weightless);
  for (const std::string& note : structure.notes) fmt::print(stderr, "note: {}\n", note);
  if (!args.out.empty()) {
    OutputIsNews();
    exit = WriteFolder(args.out, def, structure);
    if (exit != kOk) return exit;
  }
  if (args.json) {
    fmt::print("{}", JsonOf(def, structure));
    return kOk;
  }
  fmt::print("{}", StructureSummary(def, structure));
  if (args.tables) fmt::print("\n{}\n", TableOf(structure));
  if (!args.out.empty()) fmt::print("Matrices and tables: {}\n", args.out);
  SayNext({"analyze", args.robot.path});
  return kOk;
}

}  // namespace

void AddExportStructure(CLI::App& group, int& exit_code) {
  auto args = std::make_shared<StructureArguments>();
  CLI::App* command = group.add_subcommand(
      "structure",
      "Write nodes, bars and strings: the matrices N, C_b, C_s, q and S of tensegrity statics.");
  AddPlacedRobot(*command, args->robot);
  command
      ->add_option(
          "--out", args->out,
          "Output folder for N.csv, C_b.csv, C_s.csv, q.csv, S.csv, ... and structure.json")
      ->option_text("FOLDER");
  command->add_flag("--equilibrium", args->equilibrium,
                    "Use the nearby equilibrium (as in `taut analyze`) instead of the start pose");
  command->add_flag("--no_weight,--no-weight", args->weightless, "Leave out the robot's weight");
  command->add_flag("--json", args->json, "JSON instead of text");
  command->add_flag("--tables", args->tables, "Also print the table of all members");
  command->footer(
      "Examples:\n"
      "  taut export structure models/prism3.yaml --out prism3\n"
      "  taut export structure models/t3_prism.yaml --equilibrium --no_weight --json\n"
      "  taut export structure experiments/drop_six_strut.yaml --pose "
      "runs/drop_six_strut/trace.h5\n"
      "In MATLAB: N = readmatrix('prism3/N.csv'). N is 3 x nodes; C = [C_b; C_s] has one row per\n"
      "member, -1 at its first node and 1 at its second; q is the force density (docs/export.md).\n"
      "Exit status: 0 success, 1 a file cannot be written or the robot does not settle,\n"
      "2 bad usage, 3 bad input.");
  command->callback([args, &exit_code] { exit_code = ExportStructure(*args); });
}

}  // namespace taut::cli
