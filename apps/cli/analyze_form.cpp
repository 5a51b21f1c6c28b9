// `taut analyze --form`: form finding from cable tensions or force densities.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "analyze_form.h"
#include "member_groups.h"
#include "output.h"
#include "standard_streams.h"
#include "table.h"
#include "taut/form_finding.h"
#include "taut/version.h"

namespace taut::cli {
namespace {

FormOptions OptionsOf(const FormArguments& args, const ModelDef& def, bool weight) {
  FormOptions options;
  options.weight = options.contact = weight;
  for (const CableDef& cable : def.cables) {
    if (args.force_density_n_per_m) {
      options.force_density_n_per_m.push_back(*args.force_density_n_per_m);
    } else {
      options.tension_n.push_back(args.tension_n ? *args.tension_n : CableTension(cable));
    }
  }
  return options;
}

std::string FormTable(const ModelDef& before, const Form& form) {
  const ModelDef& def = form.robot.def;
  Table cables({"cable", "described length", "length", "rest length", "tension", "force density"});
  cables.Add({"", "m", "m", "m", "N", "N/m"});
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const double length_m = CableLength(def.cables[c]), tension_n = CableTension(def.cables[c]);
    cables.Add({def.cables[c].name, Fixed(CableLength(before.cables[c]), 6), Fixed(length_m, 6),
                Fixed(def.cables[c].rest_length_m, 6), Fixed(tension_n, 3),
                Fixed(tension_n / length_m, 3)});
  }
  return cables.Text();
}

/// Returns the verdict and one line per group of cables.
std::string FormSummary(const RobotSpec& before, const Form& form, bool weight) {
  CappedLines lines;
  for (const CableGroup& group : GroupCables(before, 6)) {
    const auto range = [&](const std::vector<CableDef>& cables, auto quantity, int digits,
                           const char* unit) {
      return RangeOver(group, [&](std::size_t c) { return quantity(cables[c]); })
          .Text(digits, unit);
    };
    const std::vector<CableDef>& now = form.robot.def.cables;
    lines.Add(fmt::format(
        "{}: length {}, was {}; tension {}", group.name, range(now, CableLength, 4, "m"),
        range(before.def.cables, CableLength, 4, "m"), range(now, CableTension, 3, "N")));
  }
  return lines.Text(fmt::format("{}: equilibrium shape found{}", before.def.name,
                                weight ? ", with weight" : ", without weight"));
}

}  // namespace

int FindFormOf(const std::string& file, const RobotSpec& robot, bool weight,
               const FormArguments& args) {
  Diagnostics found;
  const Form form = FindForm(robot, OptionsOf(args, robot.def, weight), found);
  if (!found.ok()) return Fail(found, kBadInput);
  if (!form.found) {
    fmt::print(stderr, "error: form finding failed: {}\n", form.why);
    return kFailed;
  }
  fmt::print("{}", FormSummary(robot, form, weight));
  if (args.tables) fmt::print("\n{}\n", FormTable(robot.def, form));
  if (args.out.empty()) {
    std::vector<std::string> next = args.again;
    const auto flag = [&](const char* name, const std::optional<double>& value) {
      if (value) next.insert(next.end(), {name, fmt::format("{}", *value)});
    };
    flag("--tension_n", args.tension_n);
    flag("--force_density_n_per_m", args.force_density_n_per_m);
    next.insert(next.end(), {"--out", "form.yaml"});
    SayNext(next);
    return kOk;
  }
  const std::optional<std::string> text =
      ModelYaml(form.robot,
                fmt::format("Made by taut {} from {}: equilibrium shape by form finding.", kVersion,
                            std::filesystem::path(file).filename().string()),
                found);
  if (!text) return Fail(found, kFailed);
  OutputIsNews();
  const int exit = WriteNamed(args.out, *text);
  if (exit != kOk) return exit;
  fmt::print("Model: {}\n", args.out);
  SayNext({"analyze", args.out});
  return kOk;
}

}  // namespace taut::cli
