// `taut robot set`, `reference`: values stored in the boards.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "output.h"
#include "robot_console.h"

namespace taut::cli {
namespace {

struct SetArguments : RobotArguments {
  std::vector<std::string> values, cables;
  bool store = false, defaults = false;
};

/// Returns the motors of the named cables; all motors if none is named.
std::vector<int> MotorsOf(const RobotConsole& desk, const std::vector<std::string>& cables,
                          Diagnostics& out) {
  std::vector<int> motors;
  for (const std::string& cable : cables) {
    if (const auto motor = desk.MotorOf(cable, out)) motors.push_back(*motor);
  }
  if (cables.empty()) {
    for (int m = 0; m < static_cast<int>(desk.cables().size()); ++m) motors.push_back(m);
  }
  return motors;
}

int List(RobotConsole& desk, const std::vector<int>& motors, bool json, Diagnostics& found) {
  nlohmann::ordered_json all;
  link::Requests& requests = desk.driver().requests();
  const auto show = [&](const std::string& who, const link::ParameterPlace& place,
                        const link::ParameterInfo& info) {
    const auto value = requests.Get(place, found);
    if (!value) return false;
    if (json) {
      all[who][info.key] = *value;
    } else {
      fmt::print("{:<20}{:<30}{:<12g}{:g} .. {:g}\n", who, info.key, *value, info.range.least,
                 info.range.greatest);
    }
    return true;
  };
  for (const int motor : motors) {
    const auto infos = link::MotorParameters();
    for (std::size_t p = 0; p < infos.size(); ++p) {
      if (!show(desk.cables()[static_cast<std::size_t>(motor)],
                link::PlaceOf(motor, static_cast<std::uint8_t>(p)), infos[p])) {
        return Fail(found, kFailed);
      }
    }
  }
  const auto infos = link::BoardParameters();
  for (std::size_t b = 0; b < desk.driver().state().boards.size(); ++b) {
    for (std::size_t p = 0; p < infos.size(); ++p) {
      if (!show(fmt::format("board {}", b),
                {static_cast<int>(b), board::kMotors, static_cast<std::uint8_t>(p)}, infos[p])) {
        return Fail(found, kFailed);
      }
    }
  }
  if (json) fmt::print("{}\n", all.dump(2));
  return kOk;
}

/// Sends one action to all boards, with their boot numbers from the identification.
bool DoOnAll(RobotConsole& desk, board::Action action, Diagnostics& found) {
  link::Driver& driver = desk.driver();
  for (std::size_t b = 0; b < driver.state().boards.size(); ++b) {
    const int board = static_cast<int>(b);
    const std::uint16_t nonce = driver.state().boards[b].info.nonce;
    if (!driver.requests().Do(board, action, nonce, found)) return false;
    if (!driver.requests().WaitForMemory(board, found)) return false;
  }
  return true;
}

/// Reports that a board returned another value than the one that was set.
void RefuseSetting(const RobotConsole& desk, const link::ParameterValue& value,
                   const link::Setting& setting, int motor, double read, Diagnostics& out) {
  const auto infos = value.of_motor ? link::MotorParameters() : link::BoardParameters();
  std::string board = fmt::format("board {}", setting.place.board);
  if (value.of_motor) {
    board += fmt::format(" (cable \"{}\")", desk.cables()[static_cast<std::size_t>(motor)]);
  }
  out.Error("board.setting_not_kept", {},
            fmt::format("{} returned {} = {:g} after it was set to {:g}", board,
                        infos[value.parameter].key, read, setting.value));
}

int Set(const SetArguments& args) {
  Diagnostics found;
  std::vector<link::ParameterValue> values;
  for (const std::string& text : args.values) {
    if (const auto value = link::ReadParameter(text, "set", found)) values.push_back(*value);
  }
  if (!found.ok()) return Fail(found, kBadInput);
  if (args.dry_run) {
    for (const std::string& text : args.values) fmt::print("would set {}\n", text);
    if (args.defaults) fmt::print("would restore the defaults of the firmware\n");
    if (args.store) fmt::print("would store the values in the boards' memories\n");
    return kOk;
  }
  int exit = kOk;
  const auto desk = RobotConsole::Open(args, nullptr, exit);
  if (!desk) return exit;
  const std::vector<int> motors = MotorsOf(*desk, args.cables, found);
  if (!found.ok()) return Fail(found, kBadInput);
  if (args.defaults && !DoOnAll(*desk, board::Action::kDefaults, found)) {
    return Fail(found, kFailed);
  }
  int done = 0;
  for (const link::ParameterValue& value : values) {
    for (const link::Setting& setting : ForAll(value, static_cast<int>(desk->cables().size()))) {
      const int motor = setting.place.board * board::kMotors + setting.place.index;
      if (value.of_motor && std::find(motors.begin(), motors.end(), motor) == motors.end()) {
        continue;
      }
      if (!desk->driver().requests().Set(setting, found)) return Fail(found, kFailed);
      const auto read = desk->driver().requests().Get(setting.place, found);
      if (!read) return Fail(found, kFailed);
      if (*read != setting.value) {
        RefuseSetting(*desk, value, setting, motor, *read, found);
        return Fail(found, kFailed);
      }
      ++done;
    }
  }
  if (args.store && !DoOnAll(*desk, board::Action::kStore, found)) return Fail(found, kFailed);
  if (args.values.empty() && !args.store && !args.defaults) {
    return List(*desk, motors, args.json, found);
  }
  fmt::print("{} values set{}.\n", done,
             args.store ? " and stored in the boards' memories" : "; use --store to store them");
  return kOk;
}

/// One argument of `reference`, such as "outer_top_1=0.24".
struct ReferenceText {
  std::string cable;
  double rest_length_m = 0;
};

std::optional<ReferenceText> ParseReference(const std::string& text, Diagnostics& out) {
  const std::size_t equals = text.find('=');
  ReferenceText reference{text.substr(0, equals), 0};
  const char* const end = text.data() + text.size();
  const char* const number = equals == std::string::npos ? end : text.data() + equals + 1;
  const bool good = number < end &&
                    std::from_chars(number, end, reference.rest_length_m).ptr == end &&
                    reference.rest_length_m >= 0 && reference.rest_length_m <= 2;
  if (good) return reference;
  out.Error("robot.bad_reference", {}, text + ": not of the form CABLE=REST_LENGTH_M",
            "expected a length of 0 to 2 m, such as outer_top_1=0.24");
  return std::nullopt;
}

int Reference(const SetArguments& args, bool as_model) {
  Diagnostics found;
  std::vector<ReferenceText> references;
  for (const std::string& text : args.values) {
    if (const auto one = ParseReference(text, found)) references.push_back(*one);
  }
  if (args.values.empty() && !as_model) {
    found.Error("robot.nothing_to_reference", {}, "the rest lengths are missing",
                "expected CABLE=REST_LENGTH_M ..., or --as_model");
  }
  if (!found.ok()) return Fail(found, kBadInput);
  if (args.dry_run) {
    fmt::print("would set on the boards of {} {}\n", args.port,
               as_model ? "the model's rest lengths of all cables"
                        : fmt::format("the rest lengths of {} cables", references.size()));
    return kOk;
  }
  int exit = kOk;
  const auto desk = RobotConsole::Open(args, nullptr, exit);
  if (!desk) return exit;
  if (as_model) {
    for (const CableDef& cable : desk->robot().def.cables) {
      if (desk->MotorOf(cable.name)) references.push_back({cable.name, cable.rest_length_m});
    }
  }
  for (const ReferenceText& one : references) desk->MotorOf(one.cable, found);
  if (!found.ok()) return Fail(found, kBadInput);
  for (const ReferenceText& one : references) {
    if (!desk->driver().SetReference(*desk->MotorOf(one.cable), one.rest_length_m, found)) {
      return Fail(found, kFailed);
    }
  }
  fmt::print("{} cables are referenced.\n", references.size());
  return kOk;
}

}  // namespace

void AddRobotSet(CLI::App& robot, int& exit_code) {
  auto args = std::make_shared<SetArguments>();
  CLI::App* set = robot.add_subcommand("set", "Show or set parameters of the boards.");
  set->add_option("values", args->values, "Parameters, such as duty_limit=0.5 (default: show all)")
      ->option_text("NAME=VALUE");
  AddPort(*set, *args);
  AddModelFile(*set, *args);
  set->add_option("--cable", args->cables, "Cables whose motors are set (default: all)")
      ->option_text("NAME");
  set->add_flag("--defaults", args->defaults, "Restore all defaults of the firmware first");
  set->add_flag("--store", args->store, "Store the values permanently, through power loss");
  set->add_flag("--dry_run,--dry-run", args->dry_run, "Print the planned actions only");
  AddJson(*set, *args);
  set->footer(
      "Examples:\n  taut robot set\n"
      "  taut robot set position_gain_n_per_m=200 --cable inner_top_1 inner_top_2\n"
      "  taut robot set tension_limit_n=40 --store\n"
      "docs/hardware/parameters.md lists the parameters. Only gains can be set while motors run.");
  set->callback([args, &exit_code] { exit_code = Set(*args); });
}

void AddRobotReference(CLI::App& robot, int& exit_code) {
  auto args = std::make_shared<SetArguments>();
  auto as_model = std::make_shared<bool>(false);
  CLI::App* reference =
      robot.add_subcommand("reference", "Set the present rest lengths of cables.");
  reference->add_option("values", args->values, "Rest lengths [m], such as outer_top_1=0.24")
      ->option_text("CABLE=REST_LENGTH_M");
  AddPort(*reference, *args);
  AddModel(*reference, *args);
  AddCalibration(*reference, *args);
  auto* flag =
      reference->add_flag("--as_model", *as_model, "Use the model's rest lengths for all cables");
  reference->get_option("values")->excludes(flag);
  reference->add_flag("--dry_run,--dry-run", args->dry_run, "Print the planned actions only");
  reference->footer(
      "Examples:\n"
      "  taut robot reference --as_model\n"
      "  taut robot reference outer_top_1=0.243 outer_left_1=0.197\n"
      "Encoder counts start at zero at each reset of a board: repeat this command after every "
      "reset.\n"
      "Motors must be off or holding.");
  reference->callback([args, as_model, &exit_code] { exit_code = Reference(*args, *as_model); });
}

}  // namespace taut::cli
