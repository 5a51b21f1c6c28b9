// Actuator sizing: demand of the cables in a run, and margins of motors and springs of a catalogue.
#include "taut/sizing.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>

#include "math/cable_law.h"
#include "taut/run_folder.h"
#include "taut/spec.h"

namespace taut {
namespace {

/// Returns the values of a cable's channel; null after an error.
const std::vector<double>* Rows(const Trace& trace, const std::string& channel,
                                const std::string& path, Diagnostics& out) {
  const auto found = trace.Find(channel);
  if (!found) {
    out.Error("trace.no_channel", {path, 0, 0}, "the trace has no channel \"" + channel + "\"",
              "record it: record.channels of the experiment");
    return nullptr;
  }
  const std::vector<double>& rows = trace.values[*found];
  if (std::all_of(rows.begin(), rows.end(), [](double x) { return std::isfinite(x); }))
    return &rows;
  out.Error("trace.not_finite", {path, 0, 0},
            "channel \"" + channel + "\" has values that are not finite");
  return nullptr;
}

/// Computes the demand of a cable by linear interpolation between rows.
CableDemand OfRows(const std::vector<double>& time_s, const std::vector<double>& tension_n,
                   const std::vector<double>& rest_length_m) {
  CableDemand d;
  double force2 = 0, speed2 = 0, power2 = 0;
  d.peak_force_n = *std::max_element(tension_n.begin(), tension_n.end());
  const auto [shortest, longest] = std::minmax_element(rest_length_m.begin(), rest_length_m.end());
  d.wound_m = *longest - *shortest;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double step_s = time_s[i] - time_s[i - 1];
    const double a = tension_n[i - 1], b = tension_n[i];
    const double wound_m = rest_length_m[i - 1] - rest_length_m[i], speed = wound_m / step_s;
    force2 += step_s * (a * a + a * b + b * b) / 3;
    speed2 += step_s * speed * speed;
    power2 += step_s * speed * speed * (a * a + a * b + b * b) / 3;
    d.peak_speed_m_per_s = std::max(d.peak_speed_m_per_s, std::fabs(speed));
    d.peak_power_w = std::max({d.peak_power_w, a * speed, b * speed});
    const double work_j = 0.5 * (a + b) * wound_m;
    d.gross_energy_j += std::max(0.0, work_j);
    d.net_energy_j += work_j;
  }
  const double span_s = time_s.back() - time_s.front();
  d.rms_force_n = std::sqrt(force2 / span_s);
  d.rms_speed_m_per_s = std::sqrt(speed2 / span_s);
  d.rms_power_w = std::sqrt(power2 / span_s);
  return d;
}

/// Replaces extremes by those in the summary, which covers all steps. Returns false if the file is
/// not a summary of this run.
bool TakeSummary(const nlohmann::json& summary, std::vector<CableDemand>& cables) {
  const auto list = summary.find("cables");
  if (list == summary.end() || !list->is_array() || list->size() != cables.size()) return false;
  try {
    for (std::size_t i = 0; i < cables.size(); ++i) {
      const nlohmann::json& of = list->at(i);
      if (of.at("name") != cables[i].cable) return false;
    }
    for (std::size_t i = 0; i < cables.size(); ++i) {
      const nlohmann::json& of = list->at(i);
      CableDemand& d = cables[i];
      d.peak_force_n = of.at("tension").at("max_n");
      d.peak_elastic_n = of.at("elastic").at("max_n");
      if (!d.actuated) continue;
      const nlohmann::json& actuator = of.at("actuator");
      d.peak_speed_m_per_s = actuator.at("max_speed_m_per_s");
      d.peak_power_w = actuator.at("max_power_w");
      d.gross_energy_j = actuator.at("energy_j");
      d.net_energy_j = actuator.at("net_energy_j");
    }
  } catch (const nlohmann::json::exception&) {
    return false;
  }
  return true;
}

double Over(double available, double needed) {
  return needed > 0 ? available / needed : std::numeric_limits<double>::infinity();
}

void TakeLeast(SizingMargins& fit) {
  fit.least =
      *std::min_element(fit.margins.begin(), fit.margins.end(),
                        [](const Margin& a, const Margin& b) { return a.factor < b.factor; });
}

}  // namespace

std::optional<RunDemand> DemandOf(const Trace& trace, const ExperimentSpec& experiment,
                                  const std::string& path, Diagnostics& out) {
  if (trace.time_s.size() < 2) {
    out.Error("trace.few_rows", {path, 0, 0}, "the trace has fewer than two rows");
    return std::nullopt;
  }
  RunDemand demand;
  demand.experiment = experiment.name;
  demand.from_s = trace.time_s.front();
  demand.to_s = trace.time_s.back();
  demand.rows = trace.time_s.size();
  const std::size_t errors_before = out.items().size();
  for (const CableDef& cable : experiment.robot.def.cables) {
    const std::string prefix = "cable/" + cable.name + "/";
    const auto* tension = Rows(trace, prefix + "tension_n", path, out);
    const auto* elastic = Rows(trace, prefix + "elastic_n", path, out);
    const auto* rest = Rows(trace, prefix + "rest_length_m", path, out);
    if (!tension || !elastic || !rest) continue;
    CableDemand d = OfRows(trace.time_s, *tension, *rest);
    d.cable = cable.name;
    d.actuated = cable.actuator.kind != ActuatorDef::Kind::kNone;
    d.stiffness_n_per_m = cable.stiffness_n_per_m;
    d.peak_elastic_n = *std::max_element(elastic->begin(), elastic->end());
    d.stretch_m = math::CableLaw{d.stiffness_n_per_m}.Stretch(d.peak_elastic_n);
    demand.cables.push_back(d);
  }
  if (out.items().size() != errors_before) return std::nullopt;
  return demand;
}

std::optional<RunDemand> DemandOfRun(const std::string& folder, Diagnostics& out) {
  const std::filesystem::path place(folder);
  const std::string path = (place / "trace.h5").string();
  const auto trace = ReadTraceOfRun(path, out);  // read first, since this may complete the files of
                                                 // a killed run
  const std::string inputs = (place / "inputs.yaml").string();
  std::error_code failed;
  if (std::filesystem::exists(inputs, failed) &&
      !std::filesystem::is_regular_file(inputs, failed)) {  // reading a pipe could block
    out.Error("run.inputs_not_regular", {inputs},
              "the file with the inputs of the run is not a regular file");
    return std::nullopt;
  }
  const auto experiment = LoadExperiment(inputs, {}, out);
  if (!experiment || !trace) return std::nullopt;
  auto demand = DemandOf(*trace, *experiment, path, out);
  if (!demand) return std::nullopt;
  const auto summary = ReadRunText((place / "summary.json").string());
  const nlohmann::json json =
      summary ? nlohmann::json::parse(*summary, nullptr, false) : nlohmann::json();
  demand->every_step = json.is_object() && TakeSummary(json, demand->cables);
  for (CableDemand& d : demand->cables) {
    d.stretch_m = math::CableLaw{d.stiffness_n_per_m}.Stretch(d.peak_elastic_n);
  }
  return demand;
}

SizingMargins SizingMarginsOf(const CatalogueMotor& motor, double spool_radius_m, double factor,
                              const CableDemand& cable) {
  // Conversion to the motor's shaft: torque per newton of tension, speed per m/s of the cable.
  const double arm_m = spool_radius_m / (motor.gear_ratio * motor.gear_efficiency);
  const double turn_per_m = motor.gear_ratio / spool_radius_m;
  SizingMargins fit;
  fit.name = motor.name;
  fit.margins = {{"peak torque", Over(motor.peak_torque_n_m, cable.peak_force_n * arm_m)},
                 {"rated torque", Over(motor.rated_torque_n_m, cable.rms_force_n * arm_m)},
                 {"speed", Over(motor.max_speed_rad_per_s, cable.peak_speed_m_per_s * turn_per_m)}};
  const auto power = [&](const char* of, const std::optional<double>& has_w, double needs_w) {
    if (has_w) fit.margins.push_back({of, Over(*has_w, needs_w / motor.gear_efficiency)});
  };
  power("peak power", motor.peak_power_w, cable.peak_power_w);
  power("rated power", motor.rated_power_w, cable.rms_power_w);
  TakeLeast(fit);
  fit.fits = fit.least.factor >= factor;
  fit.spool_turns = cable.wound_m / (2 * 3.14159265358979323846 * spool_radius_m);
  return fit;
}

SizingMargins SizingMarginsOf(const CatalogueSpring& spring, double factor,
                              double stiffness_tolerance, const CableDemand& cable) {
  SizingMargins fit;
  fit.name = spring.name;
  fit.margins = {
      {"force", Over(spring.largest_force_n, cable.peak_elastic_n)},
      {"travel", Over(spring.largest_travel_m, cable.peak_elastic_n / spring.stiffness_n_per_m)}};
  TakeLeast(fit);
  fit.stiffness_off = spring.stiffness_n_per_m / cable.stiffness_n_per_m - 1;
  fit.fits = fit.least.factor >= factor && std::fabs(fit.stiffness_off) <= stiffness_tolerance;
  return fit;
}

}  // namespace taut
