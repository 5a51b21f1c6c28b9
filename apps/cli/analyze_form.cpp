// `taut analyze --form`: form finding from cable tensions or force densities.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "analyze_form.h"
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
  fmt::print("Model {}: equilibrium shape{}\n\n{}", robot.def.name,
             weight ? ", with weight" : ", without weight", FormTable(robot.def, form));
  if (args.out.empty()) return kOk;
  const std::optional<std::string> text =
      ModelYaml(form.robot,
                fmt::format("Made by taut {} from {}: equilibrium shape by form finding.", kVersion,
                            std::filesystem::path(file).filename().string()),
                found);
  if (!text) return Fail(found, kFailed);
  OutputIsNews();
  const int exit = WriteNamed(args.out, *text);
  if (exit == kOk) fmt::print("\nModel: {}\n", args.out);
  return exit;
}

}  // namespace taut::cli
