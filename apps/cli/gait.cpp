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
#include "shipped_inputs.h"
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
    fmt::print(stderr, "warning: the gait has feedback, which a table cannot contain\n");
  }
  return WriteOrPrint(args.out, GaitTableText(*table, gait->drives));
}

int WriteGait(const GaitArguments& args, const GaitSpec& gait) {
  const int written = WriteOrPrint(args.out, GaitYaml(gait));
  if (written == kOk && !args.out.empty()) SayNext({"check", args.out});
  return written;
}

int Import(const GaitArguments& args) {
  Diagnostics found;
  auto gait = ImportNtrtGait(args.input, args.order, found);
  if (!gait) return Fail(found, kBadInput);
  if (!args.name.empty()) gait->name = args.name;
  return WriteGait(args, *gait);
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
  return WriteGait(args, *gait);
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
  CLI::App* gait = app.add_subcommand("gait", "Create, convert and list gaits.");
  gait->require_subcommand(1);
  const auto add_set = [&](CLI::App* command) {
    command->add_option("--set", args->set, "Set a parameter of the model")
        ->option_text("NAME=VALUE")
        ->allow_extra_args(false);
  };

  CLI::App* export_ =
      gait->add_subcommand("export", "Write the cable signals of a gait as a table (CSV).");
  AddInput(*export_, "gait", {"gait"}, args->input, "Gait file (YAML)")->required();
  AddInput(*export_, "robot", {"model", "experiment"}, args->robot,
           "Model or experiment file (YAML)")
      ->required();
  export_
      ->add_option("--rate_hz", args->rate_hz,
                   "Rate of the rows, also the update rate of the gait [Hz]")
      ->option_text("X")
      ->check(NumberWithin(1e-3, 1e6))
      ->capture_default_str();
  export_->add_option("--duration_s", args->duration_s, "Duration of the table [s]")
      ->option_text("S")
      ->check(NumberWithin(0.0, 1e6))
      ->capture_default_str();
  export_->add_option("--out", args->out, "Output file (default: standard output)")
      ->option_text("FILE");
  add_set(export_);
  export_->footer(
      "Examples:\n"
      "  taut gait export gaits/cpg_learned.yaml models/tetraspine3.yaml --out commands.csv");
  export_->callback([args, &exit_code] { exit_code = Export(*args); });

  CLI::App* import_ =
      gait->add_subcommand("import", "Convert a gait of NTRT's spines to a gait file.");
  import_
      ->add_option(
          "path", args->input,
          "Folder with bestParameters-*.nnw; or controlVars.json of hand-tuned waves; or the "
          ".json file of a controller with feedback")
      ->required();
  AddChoice(*import_, "--order", args->order, kOrders,
            "Cable order of the NTRT version that learned the gait (default: paper2015)");
  import_->add_option("--name", args->name, "Name of the gait")
      ->option_text("NAME")
      ->check(CheckName);
  import_->add_option("--out", args->out, "Output file (default: standard output)")
      ->option_text("FILE");
  import_->footer(
      "Examples:\n"
      "  taut gait import ntrt/hardwareLearning/logs --name sidewinder --out sidewinder.yaml");
  import_->callback([args, &exit_code] { exit_code = Import(*args); });

  CLI::App* create = gait->add_subcommand("create",
                                          "Write a CPG gait with all couplings of a robot, with "
                                          "zero weights and phases, for learning.");
  AddInput(*create, "robot", {"model", "experiment"}, args->robot,
           "Model or experiment file (YAML)")
      ->required();
  AddChoice(*create, "--symmetry", args->symmetry, kSymmetries,
            "Rule by which couplings share parameters (default: segments)");
  AddChoice(*create, "--drives", args->drives, kDrives, "Kind of signal (default: velocity)");
  create->add_option("--name", args->name, "Name of the gait")
      ->option_text("NAME")
      ->check(CheckName);
  create->add_option("--out", args->out, "Output file (default: standard output)")
      ->option_text("FILE");
  add_set(create);
  create->footer("Examples:\n  taut gait create models/tetraspine12.yaml --out blank.yaml");
  create->callback([args, &exit_code] { exit_code = Create(*args); });

  CLI::App* values = gait->add_subcommand("values", "List every parameter of a gait by name.");
  AddInput(*values, "gait", {"gait"}, args->input, "Gait file (YAML)")->required();
  values->add_flag("--json", args->json, "JSON instead of a table");
  values->footer("Examples:\n  taut gait values gaits/hand_tuned_sine.yaml");
  values->callback([args, &exit_code] { exit_code = Values(*args); });

  gait->footer(
      "Examples:\n"
      "  taut gait export gaits/cpg_learned.yaml models/tetraspine3.yaml --out commands.csv\n"
      "  taut gait import ntrt/hardwareLearning/logs --name sidewinder --out sidewinder.yaml\n"
      "  taut gait create models/tetraspine12.yaml --out blank.yaml\n"
      "  taut gait values gaits/hand_tuned_sine.yaml\n"
      "A gait file with `table: {file: commands.csv}` plays a table (docs/formats/gait.md).\n"
      "Exit status: 0 success, 1 a file cannot be written, 2 bad usage, 3 bad input.");
}

}  // namespace taut::cli
