// Summary of a run as JSON.
#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "report/facts.h"
#include "report/reference.h"
#include "taut/run_folder.h"
#include "taut/summary.h"
#include "taut/version.h"

namespace taut {
namespace {

using Json = nlohmann::ordered_json;  // keeps the order of keys; writes NaN as null

Json ToJson(const Range& range) {
  return {{"mean_n", range.mean}, {"min_n", range.min}, {"max_n", range.max}};
}

/// Returns the largest value after the first 5 s. Null if the run ended before.
Json AfterStart(double value, const RunSummary& run) {
  return run.simulated_s > 5 ? Json(value) : Json();
}

Json ToJson(const CableSummary::Quantity& quantity, const RunSummary& run) {
  Json phases = Json::object();
  for (std::size_t i = 0; i < run.phases.size() && i < quantity.phases.size(); ++i) {
    phases[run.phases[i].name] =
        report::Complete(run, run.phases[i]) ? ToJson(quantity.phases[i]) : Json();
  }
  return {{"max_n", quantity.max_n},
          {"max_after_start_n", AfterStart(quantity.max_after_start_n, run)},
          {"phases", phases}};
}

Json ToJson(const CableSummary& cable, const RunSummary& run) {
  Json json = {{"name", cable.name},
               {"tension", ToJson(cable.tension, run)},
               {"elastic", ToJson(cable.elastic, run)},
               {"actuator",
                {{"max_force_n", cable.max_force_n},
                 {"max_speed_m_per_s", cable.max_speed_m_per_s},
                 {"max_power_w", cable.max_power_w},
                 {"energy_j", cable.energy_j},
                 {"net_energy_j", cable.net_energy_j}}}};
  if (cable.motor) {
    json["motor"] = {{"energy_from_supply_j", cable.motor->energy_from_supply_j},
                     {"energy_to_cable_j", cable.motor->energy_to_cable_j},
                     {"energy_in_winding_j", cable.motor->energy_in_winding_j},
                     {"max_current_a", cable.motor->max_current_a},
                     {"max_winding_temperature_c", cable.motor->max_winding_temperature_c}};
  }
  return json;
}

Json ToJson(const ReferenceSpec& reference, const RunSummary& run) {
  Json cables = Json::array();
  for (const ReferenceSpec::Value& value : reference.values) {
    cables.push_back({{"name", run.cables[static_cast<std::size_t>(value.cable)].name},
                      {"reference_n", value.force_n},
                      {"ours_n", report::OurValue(run, reference, value.cable)}});
  }
  return {{"source", reference.source},
          {"quantity", report::QuantityName(reference)},
          {"statistic", report::StatisticName(reference)},
          {"phase", reference.phase.empty() ? Json() : Json(reference.phase)},
          {"cables", cables}};
}

Json ToJson(const StartChange& start) {
  Json contacts = Json::array();
  for (const auto& [a, b] : start.new_contacts) contacts.push_back(Json::array({a, b}));
  return {{"slack_cables", start.slack_cables},
          {"described_taut_cables", start.taut_cables},
          {"max_tension_n", start.max_tension_n},
          {"described_max_tension_n", start.described_max_tension_n},
          {"largest_displacement_m", start.largest_displacement_m},
          {"displaced_node", start.displaced_node},
          {"size_m", start.size_m},
          {"new_contacts", contacts}};
}

}  // namespace

std::string SummaryJson(const RunSummary& summary) {
  Json json;
  json["format_version"] = 1;
  json["taut_version"] = kVersion;
  json["experiment"] = summary.experiment;
  json[kRunIdKey] = summary.run.empty() ? Json() : Json(summary.run);
  json["simulated_s"] = summary.simulated_s;
  json["wall_s"] = summary.wall_s;
  json["real_time_factor"] = report::RealTimeFactor(summary);
  json["interrupted"] = summary.interrupted;
  json["status"] = report::StatusText(summary);
  json["status_bits"] = summary.status.bits;
  json["state_hash"] = fmt::format("{:016x}", summary.state_hash);  // too long for a JSON number
  json["start"] = summary.start ? ToJson(*summary.start) : Json();
  json["contacts_left_out"] = summary.left_out.contacts;
  json["system_max_tension_n"] = summary.system_max_tension_n;
  json["system_max_tension_cable"] = summary.system_max_tension_cable;
  json["system_max_elastic_n"] = summary.system_max_elastic_n;
  json["system_max_elastic_after_start_n"] =
      AfterStart(summary.system_max_elastic_after_start_n, summary);
  json["phases"] = Json::array();
  for (const PhaseSpec& phase : summary.phases) {
    json["phases"].push_back(
        {{"name", phase.name}, {"from_s", phase.from_s}, {"to_s", phase.to_s}});
  }
  json["cables"] = Json::array();
  for (const CableSummary& cable : summary.cables) json["cables"].push_back(ToJson(cable, summary));
  json["struts"] = Json::array();
  for (const StrutSummary& strut : summary.struts) {
    json["struts"].push_back({{"name", strut.name},
                              {"axial_least_n", strut.least_n},
                              {"axial_greatest_n", strut.greatest_n}});
  }
  json["anchors"] = Json::array();
  for (const AnchorSummary& anchor : summary.anchors) {
    json["anchors"].push_back({{"name", anchor.name},
                               {"max_force_n", anchor.max_force_n},
                               {"max_torque_n_m", anchor.max_torque_n_m}});
  }
  json["overloads"] = Json::array();
  for (const Overload& one : summary.overloads) {
    json["overloads"].push_back({{"kind", NameOf(one.kind)},
                                 {"name", one.name},
                                 {"limit", NameOf(one.limit)},
                                 {"bears_n", one.bears_n},
                                 {"carried_n", one.carried_n},
                                 {"first_time_s", one.first_time_s}});
  }
  json["drags"] = Json::array();
  for (const DragSummary& drag : summary.drags) {
    json["drags"].push_back({{"name", drag.name}, {"force", ToJson(drag.force_n)}});
  }
  json["references"] = Json::array();
  for (const ReferenceSpec& reference : summary.references) {
    json["references"].push_back(ToJson(reference, summary));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace taut
