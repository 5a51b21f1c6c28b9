// Command `taut gait`: creation, inspection and conversion of gaits.
#include <fmt/format.h>

#include <cstdio>
#include <map>
#include <memory>

#include "any_robot.h"
#include "commands.h"
#include "gait_report.h"
#include "output.h"
#include "overrides.h"
#include "shipped.h"
#include "taut/gait.h"
#include "taut/play.h"
#include "taut/spec.h"

namespace taut::cli {
namespace {

struct GaitArguments {
  std::string input, robot, out, name;
  std::vector<std::string> set;
  double rate_hz = 100.0, duration_s = 60.0;
  CpgSymmetry symmetry = CpgSymmetry::kSegments;
  GaitDrives drives = GaitDrives::kVelocity;
  NtrtCableOrder order = NtrtCableOrder::kPaper2015;
  bool json = false;
};

const std::map<std::string, NtrtCableOrder> kOrders{{"paper2015", NtrtCableOrder::kPaper2015},
                                                    {"since2016", NtrtCableOrder::kSince2016}};

const std::map<std::string, GaitDrives> kDrives{{"velocity", GaitDrives::kVelocity},
                                                {"rest_length", GaitDrives::kRestLength}};

int Export(const GaitArguments& args) {
  const auto overrides = ParseOverrides(args.set);
  if (!overrides) return kUsage;
  Diagnostics found;
  const auto gait = LoadGait(args.input, found);
  const auto robot = LoadAnyRobot(args.robot, *overrides, found);
  if (!gait || !robot || !Pass(found, false)) return Fail(found, kBadInput);
  const auto table = PlayGait(*gait, *robot, args.rate_hz, args.duration_s, found);
  if (!table) return Fail(found, kBadInput);
  if (gait->cpg && gait->cpg->feedback) {
    fmt::print(stderr, "warning: the gait has feedback; a table has none\n");
  }
  return WriteOrPrint(args.out, GaitTableText(*table, gait->drives));
}

int Import(const GaitArguments& args) {
  Diagnostics found;
  auto gait = ImportNtrtGait(args.input, args.order, found);
  if (!gait) return Fail(found, kBadInput);
  if (!args.name.empty()) gait->name = args.name;
  return WriteOrPrint(args.out, GaitYaml(*gait));
}

int Create(const GaitArguments& args) {
  const auto overrides = ParseOverrides(args.set);
  if (!overrides) return kUsage;
  Diagnostics found;
  const auto robot = LoadAnyRobot(args.robot, *overrides, found);
  if (!robot || !Pass(found, false)) return Fail(found, kBadInput);
  auto gait = NewCpgGait(*robot, args.symmetry, found, args.drives);
  if (!gait) return Fail(found, kBadInput);
  if (!args.name.empty()) gait->name = args.name;
  return WriteOrPrint(args.out, GaitYaml(*gait));
}

int Values(const GaitArguments& args) {
  Diagnostics found;
  auto gait = LoadGait(args.input, found);
  if (!gait || !Pass(found, false)) return Fail(found, kBadInput);
  fmt::print("{}{}", args.json ? GaitJson(*gait) : GaitTable(*gait), args.json ? "\n" : "");
  return kOk;
}

}  // namespace

void AddGait(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<GaitArguments>();
  CLI::App* gait =
      app.add_subcommand("gait", "Gaits as files: export, import, create, list their values.");
  gait->require_subcommand(1);
  const auto add_set = [&](CLI::App* command) {
    command->add_option("--set", args->set, "Parameter of the model")
        ->option_text("NAME=VALUE")
        ->allow_extra_args(false);
  };

  CLI::App* export_ = gait->add_subcommand(
      "export", "What a gait says to the cables, as a table in plain text (CSV).");
  AddInput(*export_, "gait", args->input, "Gait file (YAML)")->required();
  AddInput(*export_, "robot", args->robot, "Model or experiment file (YAML)")->required();
  export_->add_option("--rate_hz", args->rate_hz, "Rows a second; also the gait's own rate")
      ->option_text("X")
      ->check(NumberWithin(1e-3, 1e6))
      ->capture_default_str();
  export_->add_option("--duration_s", args->duration_s, "Up to here [s]")
      ->option_text("S")
      ->check(NumberWithin(0.0, 1e6))
      ->capture_default_str();
  export_->add_option("--out", args->out, "File to write (default: print)")->option_text("FILE");
  add_set(export_);
  export_->footer(
      "Example:\n  taut gait export gaits/cpg_learned.yaml models/tetraspine3.yaml --out "
      "commands.csv");
  export_->callback([args, &exit_code] { exit_code = Export(*args); });

  CLI::App* import_ = gait->add_subcommand("import", "A gait of NTRT's spines as a gait file.");
  import_
      ->add_option(
          "path", args->input,
          "Folder with bestParameters-*.nnw, the hand-tuned controlVars.json, or the .json of a "
          "controller with feedback")
      ->required();
  AddChoice(*import_, "--order", args->order, kOrders,
            "Order of NTRT's cables when it learned (default: paper2015)");
  import_->add_option("--name", args->name, "Name of the gait")
      ->option_text("NAME")
      ->check(CheckName);
  import_->add_option("--out", args->out, "File to write (default: print)")->option_text("FILE");
  import_->footer(
      "Example:\n  taut gait import ntrt/hardwareLearning/logs --name sidewinder --out "
      "sidewinder.yaml");
  import_->callback([args, &exit_code] { exit_code = Import(*args); });

  CLI::App* create = gait->add_subcommand(
      "create", "A CPG with all couplings of a robot, weights and phases 0: a start for learning.");
  AddInput(*create, "robot", args->robot, "Model or experiment file (YAML)")->required();
  AddChoice(*create, "--symmetry", args->symmetry, kSymmetries,
            "Which couplings are alike (default: segments)");
  AddChoice(*create, "--drives", args->drives, kDrives, "What its signals are (default: velocity)");
  create->add_option("--name", args->name, "Name of the gait")
      ->option_text("NAME")
      ->check(CheckName);
  create->add_option("--out", args->out, "File to write (default: print)")->option_text("FILE");
  add_set(create);
  create->footer("Example:\n  taut gait create models/tetraspine12.yaml --out blank.yaml");
  create->callback([args, &exit_code] { exit_code = Create(*args); });

  CLI::App* values = gait->add_subcommand("values", "Every number of a gait by name.");
  AddInput(*values, "gait", args->input, "Gait file (YAML)")->required();
  values->add_flag("--json", args->json, "JSON instead of a table");
  values->footer("Example:\n  taut gait values gaits/hand_tuned_sine.yaml");
  values->callback([args, &exit_code] { exit_code = Values(*args); });

  gait->footer(
      "Examples:\n"
      "  taut gait export gaits/cpg_learned.yaml models/tetraspine3.yaml --out commands.csv\n"
      "  taut gait import ntrt/hardwareLearning/logs --name sidewinder --out sidewinder.yaml\n"
      "  taut gait create models/tetraspine12.yaml --out blank.yaml\n"
      "  taut gait values gaits/hand_tuned_sine.yaml\n"
      "A table comes back as a gait by `table: {file: commands.csv}` (docs/formats/gait.md).\n"
      "Exit status: 0 good, 1 a file cannot be written, 2 bad usage, 3 bad input.");
}

}  // namespace taut::cli
