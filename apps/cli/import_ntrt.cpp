// `taut import ntrt`: an NTRT model as a taut model.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include "commands.h"
#include "import.h"
#include "member_groups.h"
#include "output.h"
#include "overrides.h"
#include "standard_streams.h"
#include "taut/import_ntrt.h"

namespace taut::cli {
namespace {

struct ImportNtrtArguments {
  std::string path, out, name;
  double length_unit_m = NAN;
  bool like_ntrt = false, tables = false, strict = false;
};

/// Returns the verdict and a summary: differences from NTRT and omissions. `tables`: also the laws
/// that agree with NTRT.
std::string Report(const NtrtImport& import, const std::string& out, bool tables) {
  const NtrtCounts& c = import.counts;
  const std::string verdict =
      fmt::format("{}: model of {} of {:.4g} kg, {}, size {:.4g} m", out, Counted(c.bodies, "body"),
                  c.mass_kg, Counted(c.cables, "cable"), c.size_m);
  CappedLines lines;
  lines.Add(fmt::format("from {}: {}, {}; {}, {}, {}", Counted(c.files, "file"),
                        Counted(c.nodes, "node"), Counted(c.pairs, "pair"), Counted(c.rods, "rod"),
                        Counted(c.boxes, "box"), Counted(c.spheres, "sphere")));
  for (const std::string& line : import.different) lines.Add("different from NTRT: " + line);
  for (const std::string& line : import.dropped) lines.Add("left out: " + line);
  std::string text = lines.Text(verdict);
  if (!tables) return text;
  const auto list = [&](const char* title, const std::vector<std::string>& all) {
    if (!all.empty()) text += fmt::format("\n{}:\n", title);
    for (const std::string& line : all) text += fmt::format("  {}\n", line);
  };
  list("Same as NTRT", import.as_ntrt);
  list("Different from NTRT", import.different);
  list("Left out", import.dropped);
  return text + "\n";
}

/// Prints the robot's size for common units of length, so that the user can recognize the unit: the
/// files do not contain it.
int AskForUnit(const ImportNtrtArguments& args) {
  Diagnostics found;
  const auto import = ImportNtrt(args.path, {1.0, args.like_ntrt, ""}, found);
  std::string hint;
  if (import) {
    const double size = import->counts.size_m;
    hint = fmt::format(
        "\nAt 0.1, as in NTRT's resources and BuildModel (gravity 98.1), the robot is {:.3g} m "
        "large; "
        "at 0.01, as in its spines (gravity 981), {:.3g} m; at 1, {:.3g} m.",
        0.1 * size, 0.01 * size, size);
  }
  fmt::print(
      stderr,
      "error: --length_unit_m is missing: NTRT's files do not define their unit of length{}\n",
      hint);
  return kUsage;
}

int Import(const ImportNtrtArguments& args) {
  if (std::isnan(args.length_unit_m)) return AskForUnit(args);
  Diagnostics found;
  const auto import = ImportNtrt(args.path, {args.length_unit_m, args.like_ntrt, args.name}, found);
  if (import) WarnOfRefusal(import->model_yaml, "", args.path, found);
  if (!import || !Pass(found, args.strict)) return Fail(found, kBadInput);
  if (args.out.empty()) {
    fmt::print("{}", import->model_yaml);
    return kOk;
  }
  OutputIsNews();
  const int exit = WriteNamed(args.out, import->model_yaml);
  if (exit != kOk) return exit;
  fmt::print("{}", Report(*import, args.out, args.tables));
  SayNext({"check", args.out});
  return kOk;
}

}  // namespace

void AddImportNtrt(CLI::App& import, int& exit_code) {
  auto args = std::make_shared<ImportNtrtArguments>();
  CLI::App* ntrt = import.add_subcommand(
      "ntrt", "Convert a structure of NASA's NTRT, with all included files, to a model.");
  ntrt->add_option("file", args->path, "NTRT structure (YAML)")->required();
  ntrt->add_option("--length_unit_m", args->length_unit_m,
                   "Length unit of the files [m], such as 0.1 or 0.01 (required: the files do not "
                   "define it)")
      ->option_text("U")
      ->check(NumberWithin(1e-9, 1e9));
  ntrt->add_flag("--like_ntrt", args->like_ntrt,
                 "Follow NTRT even where its behavior is likely unintended: % ends a file, "
                 "friction acts along the slip");
  ntrt->add_option("--name", args->name, "Name of the model (default: name of the file)")
      ->option_text("NAME")
      ->check(CheckName);
  ntrt->add_option("--out", args->out, "Output file (default: standard output)")
      ->option_text("FILE");
  ntrt->add_flag("--tables", args->tables,
                 "With --out: full report, including the laws that agree with NTRT");
  ntrt->add_flag("--strict", args->strict, kStrictHelp);
  ntrt->footer(
      "Examples:\n"
      "  taut import ntrt SuperBall.yaml --length_unit_m 0.1 --out superball.yaml\n"
      "  taut check superball.yaml\n"
      "Terms and differences: docs/from_ntrt.md.");
  ntrt->callback([args, &exit_code] { exit_code = Import(*args); });
}

}  // namespace taut::cli
