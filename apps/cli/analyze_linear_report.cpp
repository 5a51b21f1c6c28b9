// Text and JSON output of `taut analyze --linear` and `--response`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analyze_linear.h"
#include "member_groups.h"
#include "table.h"

namespace taut::cli {
namespace {

using Json = nlohmann::ordered_json;

const char* DerivativesName(Derivatives derivatives) {
  return derivatives == Derivatives::kExact ? "exact" : "differences";
}

/// Returns the pattern of a signal's name, such as "node/*/force_x": a robot has hundreds of
/// signals.
std::string PatternOf(const std::string& name) {
  const std::size_t first = name.find('/');
  const std::size_t last = name.rfind('/');
  return first == last ? name : name.substr(0, first + 1) + "*" + name.substr(last);
}

void AddSignals(const char* kind, const std::vector<LinearSignal>& signals, Table& table) {
  std::vector<std::pair<std::string, std::string>> patterns;
  std::vector<int> counts;
  for (const LinearSignal& signal : signals) {
    const std::pair<std::string, std::string> pattern{PatternOf(signal.name), signal.unit};
    const auto found = std::find(patterns.begin(), patterns.end(), pattern);
    if (found == patterns.end()) {
      patterns.push_back(pattern), counts.push_back(1);
    } else {
      ++counts[static_cast<std::size_t>(found - patterns.begin())];
    }
  }
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    table.Add(
        {i == 0 ? kind : "", patterns[i].first, patterns[i].second, fmt::format("{}", counts[i])});
  }
}

std::string Signals(const StateSpace& system) {
  Table table({"signals", "name", "unit", "count"});
  AddSignals("states", system.states, table);
  AddSignals("inputs", system.inputs, table);
  AddSignals("outputs", system.outputs, table);
  return table.Text();
}

/// Returns whether a mode neither decays nor grows, such as a translation of a free robot.
/// Round-off splits the double eigenvalue z = 1 into pairs that look like oscillations.
bool IsNeutral(const LinearMode& mode) { return std::abs(mode.z - 1.0) < 1e-6; }
/// Returns whether a mode oscillates visibly, with a damping ratio below 0.99.
bool Swings(const LinearMode& mode) { return mode.frequency_hz > 0 && mode.damping < 0.99; }

/// Numbers of modes by kind; a conjugate pair counts as one oscillation.
struct ModeCounts {
  int neutral = 0, swings = 0, grow = 0;
};

ModeCounts CountModes(const std::vector<LinearMode>& modes) {
  ModeCounts counts;
  for (const LinearMode& mode : modes) {
    if (IsNeutral(mode)) {
      counts.neutral += mode.z.imag() > 0 ? 2 : 1;
      continue;
    }
    if (std::abs(mode.z) > 1 + 1e-6) ++counts.grow;
    if (Swings(mode)) ++counts.swings;
  }
  return counts;
}

std::string ModeTable(const LinearResult& result, int most) {
  Table table({"mode", "frequency", "damping", "amplitude after 1 s"});
  table.Add({"", "Hz", "of critical", "ratio"});
  const ModeCounts counts = CountModes(result.modes);
  int swings = 0;
  for (const LinearMode& mode : result.modes) {
    if (IsNeutral(mode) || !Swings(mode) || ++swings > most) continue;
    table.Add({fmt::format("{}", swings), fmt::format("{:.7g}", mode.frequency_hz),
               Fixed(mode.damping, 6),
               fmt::format("{:.3g}", std::pow(std::abs(mode.z), 1 / result.system.period_s))});
  }
  if (most == 0) return {};
  std::string text =
      fmt::format("\nFree motion\n  neutral modes: {}, oscillations: {}, growing modes: {}\n",
                  counts.neutral, counts.swings, counts.grow);
  if (swings > 0) text += table.Text();
  if (swings > most) text += fmt::format("  ... and {} faster oscillations\n", swings - most);
  return text;
}

std::string ResponseTable(const LinearResult::Response& response) {
  Table table({"frequency", "gain", "phase"});
  table.Add({"Hz", response.unit, "rad"});
  const FrequencyResponse& r = response.values;
  for (std::size_t i = 0; i < r.frequency_hz.size(); ++i) {
    table.Add({fmt::format("{:.6g}", r.frequency_hz[i]), fmt::format("{:.6g}", r.magnitude[i]),
               Fixed(r.phase_rad[i], 4)});
  }
  return fmt::format("\nResponse of {} to {}\n", response.output, response.input) + table.Text();
}

Json SignalsJson(const std::vector<LinearSignal>& signals) {
  Json json = Json::array();
  for (const LinearSignal& signal : signals) {
    json.push_back({{"name", signal.name}, {"unit", signal.unit}, {"at", signal.at}});
  }
  return json;
}

}  // namespace

std::string LinearSummary(const LinearResult& result) {
  const StateSpace& system = result.system;
  const ModeCounts counts = CountModes(result.modes);
  CappedLines lines;
  for (const std::string& note : result.notes) lines.Add(note);
  for (const std::string& remark : system.remarks) lines.Add(remark);
  lines.Add(fmt::format("states: {}, inputs: {}, outputs: {}; tick: {:g} s, step: {:g} s",
                        system.states.size(), system.inputs.size(), system.outputs.size(),
                        system.period_s, system.step_s));
  std::string swings = fmt::format("neutral modes: {}, oscillations: {}, growing modes: {}",
                                   counts.neutral, counts.swings, counts.grow);
  const auto slowest = std::find_if(result.modes.begin(), result.modes.end(),
                                    [](const LinearMode& m) { return !IsNeutral(m) && Swings(m); });
  if (slowest != result.modes.end()) {
    swings += fmt::format("; slowest: {:.4g} Hz, damping {:.3g} of critical", slowest->frequency_hz,
                          slowest->damping);
  }
  lines.Add(swings);
  for (const LinearResult::Response& response : result.responses) {
    const FrequencyResponse& r = response.values;
    const auto peak = std::max_element(r.magnitude.begin(), r.magnitude.end());
    const auto at = static_cast<std::size_t>(peak - r.magnitude.begin());
    lines.Add(fmt::format("{} over {} [{}]: gain {:.4g} at {:.4g} Hz, largest {:.4g} at {:.4g} Hz",
                          response.output, response.input, response.unit, r.magnitude.front(),
                          r.frequency_hz.front(), *peak, r.frequency_hz[at]));
  }
  return lines.Text(fmt::format("{}: linearized about its equilibrium, {}", result.model,
                                counts.grow > 0 ? "unstable" : "no mode grows"));
}

std::string LinearTables(const LinearResult& result, int most_modes) {
  const StateSpace& system = result.system;
  std::string text = fmt::format("Model {}: linearization about the equilibrium\n", result.model);
  for (const std::string& note : result.notes) text += "  " + note + "\n";
  for (const std::string& remark : system.remarks) text += "  " + remark + "\n";
  text += fmt::format("  tick: {:g} s, step: {:g} s\n", system.period_s, system.step_s);
  text += fmt::format(
      "  derivatives: {}, at most {:.1e} from {}\n\n", DerivativesName(system.derivatives),
      system.disagreement,
      system.derivatives == Derivatives::kExact ? "finite differences" : "exact derivatives");
  text += Signals(system) + ModeTable(result, most_modes);
  for (const LinearResult::Response& response : result.responses) text += ResponseTable(response);
  return text;
}

std::string LinearJson(const LinearResult& result) {
  const StateSpace& system = result.system;
  Json json{{"format_version", 1},
            {"model", result.model},
            {"file", result.file},
            {"notes", result.notes},
            {"remarks", system.remarks},
            {"period_s", system.period_s},
            {"step_s", system.step_s},
            {"derivatives", DerivativesName(system.derivatives)},
            {"disagreement", system.disagreement},
            {"states", SignalsJson(system.states)},
            {"inputs", SignalsJson(system.inputs)},
            {"outputs", SignalsJson(system.outputs)}};
  json["modes"] = Json::array();
  for (const LinearMode& mode : result.modes) {
    json["modes"].push_back({{"frequency_hz", mode.frequency_hz},
                             {"damping", mode.damping},
                             {"z", Json::array({mode.z.real(), mode.z.imag()})}});
  }
  json["responses"] = Json::array();
  for (const LinearResult::Response& response : result.responses) {
    json["responses"].push_back({{"input", response.input},
                                 {"output", response.output},
                                 {"unit", response.unit},
                                 {"frequency_hz", response.values.frequency_hz},
                                 {"gain", response.values.magnitude},
                                 {"phase_rad", response.values.phase_rad}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string ResponsesCsv(const LinearResult& result) {
  std::string text = "input,output,unit,frequency_hz,gain,phase_rad\n";
  for (const LinearResult::Response& response : result.responses) {
    const FrequencyResponse& r = response.values;
    for (std::size_t i = 0; i < r.frequency_hz.size(); ++i) {
      text += fmt::format("{},{},{},{},{},{}\n", response.input, response.output, response.unit,
                          r.frequency_hz[i], r.magnitude[i], r.phase_rad[i]);
    }
  }
  return text;
}

}  // namespace taut::cli
