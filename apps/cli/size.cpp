// `taut size`: demands of a run on motors and springs, and components of a catalogue that meet
// them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "member_groups.h"
#include "output.h"
#include "overrides.h"
#include "table.h"
#include "taut/sizing.h"

namespace taut::cli {
namespace {

using Json = nlohmann::ordered_json;

struct SizeArguments {
  std::string folder, catalogue;
  std::optional<double> spool_radius_m;
  bool json = false, tables = false, strict = false;
};

/// Returns the folder of a run, given by this folder or by a trace in it.
std::string FolderOfRun(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return path;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

/// Suitability of the catalogue's components for a cable, in the order of the catalogue.
struct Choice {
  const CableDemand* cable;
  std::vector<SizingMargins> motors, springs;
};

std::vector<Choice> Choices(const RunDemand& run, const Catalogue& catalogue,
                            const std::optional<double>& spool_radius_m) {
  std::vector<Choice> choices;
  for (const CableDemand& cable : run.cables) {
    Choice choice{&cable, {}, {}};
    for (const CatalogueMotor& motor : catalogue.motors) {
      if (!cable.actuated) break;
      const double radius_m = spool_radius_m ? *spool_radius_m : *motor.spool_radius_m;
      choice.motors.push_back(SizingMarginsOf(motor, radius_m, catalogue.factor, cable));
    }
    for (const CatalogueSpring& spring : catalogue.springs) {
      choice.springs.push_back(
          SizingMarginsOf(spring, catalogue.factor, catalogue.stiffness_tolerance, cable));
    }
    choices.push_back(std::move(choice));
  }
  return choices;
}

std::string FactorText(double factor) {
  return std::isfinite(factor) ? fmt::format("{:.2f}", factor) : "-";
}

std::string DemandTable(const RunDemand& run) {
  Table table({"cable", "peak force", "rms", "peak speed", "rms", "peak power", "rms",
               "gross energy", "net", "wound length", "extension"});
  table.Add({"", "N", "N", "m/s", "m/s", "W", "W", "J", "J", "m", "m"});
  for (const CableDemand& d : run.cables) {
    std::vector<std::string> row{d.cable, Fixed(d.peak_force_n, 2), Fixed(d.rms_force_n, 2)};
    if (d.actuated) {
      for (const double x : {d.peak_speed_m_per_s, d.rms_speed_m_per_s}) row.push_back(Fixed(x, 4));
      for (const double x : {d.peak_power_w, d.rms_power_w}) row.push_back(Fixed(x, 3));
      for (const double x : {d.gross_energy_j, d.net_energy_j}) row.push_back(Fixed(x, 3));
      row.push_back(Fixed(d.wound_m, 4));
    } else {
      row.insert(row.end(), 7, "-");
    }
    row.push_back(Fixed(d.stretch_m, 5));
    table.Add(row);
  }
  return table.Text();
}

/// Formats one column per component: the smallest safety factor and its quantity.
std::string FitTable(const std::vector<Choice>& choices, std::vector<SizingMargins> Choice::*fits) {
  std::vector<std::string> head{"cable"};
  for (const Choice& choice : choices) {
    if (head.size() > 1) break;
    for (const SizingMargins& fit : choice.*fits) head.push_back(fit.name);
  }
  Table table(head);
  for (const Choice& choice : choices) {
    if ((choice.*fits).empty()) continue;
    std::vector<std::string> row{choice.cable->cable};
    for (const SizingMargins& fit : choice.*fits) {
      std::string text = FactorText(fit.least.factor) + " " + fit.least.of;
      if (fits == &Choice::springs) text += fmt::format(" {:+.0f} %", 100 * fit.stiffness_off);
      row.push_back((fit.fits ? "" : "no: ") + text);
    }
    table.Add(row);
  }
  return table.Text();
}

/// Returns the names of components that suit every cable that needs one.
std::vector<std::string> FitAll(const std::vector<Choice>& choices,
                                std::vector<SizingMargins> Choice::*fits, std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) {
    std::string name;
    bool all = true;
    for (const Choice& choice : choices) {
      if ((choice.*fits).empty()) continue;
      name = (choice.*fits)[i].name;
      all = all && (choice.*fits)[i].fits;
    }
    if (all && !name.empty()) names.push_back(name);
  }
  return names;
}

/// Returns the cables that need a component and for which the catalogue has none.
std::vector<std::string> Without(const std::vector<Choice>& choices,
                                 std::vector<SizingMargins> Choice::*fits) {
  std::vector<std::string> names;
  for (const Choice& choice : choices) {
    const auto& all = choice.*fits;
    if (all.empty() ||
        std::any_of(all.begin(), all.end(), [](const SizingMargins& f) { return f.fits; })) {
      continue;
    }
    names.push_back(choice.cable->cable);
  }
  return names;
}

std::string Joined(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

/// Returns the verdict and a summary of at most ten lines.
std::string SizeSummary(const RunDemand& run, const Catalogue& of,
                        const std::vector<Choice>& choices) {
  CappedLines lines;
  std::string verdict;
  const auto fits = [&](const char* kind, std::size_t count,
                        std::vector<SizingMargins> Choice::*margins) {
    if (count == 0) return;
    const auto all = FitAll(choices, margins, count), none = Without(choices, margins);
    if (!verdict.empty()) verdict += ", ";
    if (!none.empty()) {
      verdict += fmt::format("no {} for {}", kind, Counted(none.size(), "cable"));
      lines.Add(fmt::format("no {} for: {}", kind, Joined(none)));
    } else {
      verdict += fmt::format("a {} for every cable", kind);
    }
    lines.Add(fmt::format("{}s suitable for all cables: {}", kind, Joined(all)));
  };
  fits("motor", of.motors.size(), &Choice::motors);
  fits("spring", of.springs.size(), &Choice::springs);
  int actuated = 0;
  const CableDemand *force = nullptr, *speed = nullptr, *power = nullptr;
  double energy_j = 0, net_j = 0, stretch_m = 0;
  for (const CableDemand& d : run.cables) {
    if (!force || d.peak_force_n > force->peak_force_n) force = &d;
    stretch_m = std::max(stretch_m, d.stretch_m);
    if (!d.actuated) continue;
    ++actuated, energy_j += d.gross_energy_j, net_j += d.net_energy_j;
    if (!speed || d.peak_speed_m_per_s > speed->peak_speed_m_per_s) speed = &d;
    if (!power || d.peak_power_w > power->peak_power_w) power = &d;
  }
  if (verdict.empty()) {
    verdict = fmt::format("requirements of {}, {} with actuators",
                          Counted(run.cables.size(), "cable"), actuated);
  }
  if (force) {
    lines.Add(
        fmt::format("largest tension: {:.2f} N in {}; largest extension of a spring: {:.5f} m",
                    force->peak_force_n, force->cable, stretch_m));
  }
  if (speed) {
    lines.Add(fmt::format("largest speed: {:.4f} m/s in {}; largest power: {:.3f} W in {}",
                          speed->peak_speed_m_per_s, speed->cable, power->peak_power_w,
                          power->cable));
    lines.Add(
        fmt::format("energy of all actuators: gross {:.3f} J, net {:.3f} J", energy_j, net_j));
  }
  lines.Add(fmt::format("{:g} to {:g} s, {} rows; peaks and energies of {}", run.from_s, run.to_s,
                        run.rows, run.every_step ? "every step" : "rows only"));
  return lines.Text(run.experiment + ": " + verdict);
}

std::string SizeTables(const RunDemand& run, const Catalogue& of,
                       const std::vector<Choice>& choices) {
  std::string text = DemandTable(run);
  if (!of.motors.empty()) {
    text += fmt::format("\nMotors: smallest ratio of rating to requirement (required: {:g})\n{}",
                        of.factor, FitTable(choices, &Choice::motors));
  }
  if (!of.springs.empty()) {
    text +=
        "\nSprings: smallest ratio of rating to requirement, and deviation from the cable's "
        "stiffness\n" +
        FitTable(choices, &Choice::springs);
  }
  return text;
}

Json FactorJson(double factor) { return std::isfinite(factor) ? Json(factor) : Json(); }

Json FitsJson(const std::vector<SizingMargins>& fits, bool springs) {
  Json list = Json::array();
  for (const SizingMargins& fit : fits) {
    Json factors = Json::object();
    for (const Margin& margin : fit.margins) factors[margin.of] = FactorJson(margin.factor);
    Json one{{"name", fit.name}, {"fits", fit.fits}, {"factors", factors}};
    if (springs) {
      one["stiffness_off"] = fit.stiffness_off;
    } else {
      one["spool_turns"] = fit.spool_turns;
    }
    list.push_back(std::move(one));
  }
  return list;
}

std::string SizeJson(const RunDemand& run, const Catalogue* catalogue,
                     const std::vector<Choice>& choices) {
  Json json{{"format_version", 1},
            {"experiment", run.experiment},
            {"from_s", run.from_s},
            {"to_s", run.to_s},
            {"rows", run.rows},
            {"peaks_of_every_step", run.every_step},
            {"catalogue", catalogue ? Json(catalogue->name) : Json()},
            {"factor", catalogue ? Json(catalogue->factor) : Json()}};
  json["cables"] = Json::array();
  for (const Choice& choice : choices) {
    const CableDemand& d = *choice.cable;
    json["cables"].push_back({{"name", d.cable},
                              {"actuated", d.actuated},
                              {"peak_force_n", d.peak_force_n},
                              {"rms_force_n", d.rms_force_n},
                              {"peak_speed_m_per_s", d.peak_speed_m_per_s},
                              {"rms_speed_m_per_s", d.rms_speed_m_per_s},
                              {"peak_power_w", d.peak_power_w},
                              {"rms_power_w", d.rms_power_w},
                              {"gross_energy_j", d.gross_energy_j},
                              {"net_energy_j", d.net_energy_j},
                              {"wound_m", d.wound_m},
                              {"stiffness_n_per_m", d.stiffness_n_per_m},
                              {"stretch_m", d.stretch_m},
                              {"motors", FitsJson(choice.motors, false)},
                              {"springs", FitsJson(choice.springs, true)}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

/// Checks that every motor has a spool.
bool HaveSpools(const SizeArguments& args, const Catalogue& catalogue, Diagnostics& out) {
  if (args.spool_radius_m) return true;
  for (const CatalogueMotor& motor : catalogue.motors) {
    if (motor.spool_radius_m) continue;
    out.Error("catalogue.motor_without_spool", {args.catalogue, 0, 0},
              "motor " + motor.name + " has no spool_radius_m",
              "add the key, or set it for all motors with --spool_radius_m");
  }
  return out.ok();
}

int Size(const SizeArguments& args) {
  Diagnostics found;
  std::optional<Catalogue> catalogue;
  if (!args.catalogue.empty()) {
    catalogue = LoadCatalogue(args.catalogue, found);
    if (catalogue) HaveSpools(args, *catalogue, found);
  }
  const auto run = DemandOfRun(FolderOfRun(args.folder), found);
  if (!Pass(found, args.strict)) return Fail(found, kBadInput);
  if (catalogue) {
    // Lists suitable components with the lightest first.
    std::stable_sort(catalogue->motors.begin(), catalogue->motors.end(),
                     [](const CatalogueMotor& a, const CatalogueMotor& b) {
                       return a.mass_kg.value_or(INFINITY) < b.mass_kg.value_or(INFINITY);
                     });
  }
  const Catalogue nothing;
  const Catalogue& of = catalogue ? *catalogue : nothing;
  const std::vector<Choice> choices = Choices(*run, of, args.spool_radius_m);
  const auto no_motor = Without(choices, &Choice::motors),
             no_spring = Without(choices, &Choice::springs);
  const int exit = no_motor.empty() && no_spring.empty() ? kOk : kFailed;
  if (args.json) {
    fmt::print("{}\n", SizeJson(*run, catalogue ? &*catalogue : nullptr, choices));
    return exit;
  }
  fmt::print("{}", SizeSummary(*run, of, choices));
  if (args.tables) fmt::print("\n{}\n", SizeTables(*run, of, choices));
  std::vector<std::string> next{"size", args.folder};
  if (catalogue) next.insert(next.end(), {"--catalogue", args.catalogue});
  if (args.spool_radius_m) {
    next.insert(next.end(), {"--spool_radius_m", fmt::format("{}", *args.spool_radius_m)});
  }
  next.push_back(args.tables ? "--json" : "--tables");
  SayNext(next);
  return exit;
}

}  // namespace

void AddSize(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<SizeArguments>();
  CLI::App* size =
      app.add_subcommand("size", "List the requirements of a run on motors and springs.");
  size->add_option("run", args->folder,
                   "Folder of the run, with trace.h5 and inputs.yaml; or its trace")
      ->required();
  size->add_option("--catalogue", args->catalogue, "Catalogue of motors and springs (YAML)")
      ->option_text("FILE");
  size->add_option("--spool_radius_m", args->spool_radius_m,
                   "Radius of all spools [m] (overrides the catalogue)")
      ->option_text("NUMBER")
      ->check(NumberWithin(1e-6, 1e3));
  size->add_flag("--json", args->json, "JSON instead of text");
  size->add_flag("--tables", args->tables, "Also print the tables of all cables and components");
  size->add_flag("--strict", args->strict, kStrictHelp);
  size->footer(
      "Examples:\n"
      "  taut size runs/sine_hand_tuned\n"
      "  taut size runs/sine_hand_tuned --catalogue examples/winches.yaml\n"
      "  taut size runs/sine_hand_tuned --catalogue examples/winches.yaml --spool_radius_m 0.012\n"
      "Exit status: 0 every cable has a component, 1 a cable has none, 2 bad usage, 3 bad "
      "input.");
  size->callback([args, &exit_code] { exit_code = Size(*args); });
}

}  // namespace taut::cli
