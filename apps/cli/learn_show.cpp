// Best results of a study's folder, as table, JSON and replay.
#include "learn_show.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/viewer/report.h"
#include "member_groups.h"
#include "output.h"
#include "standard_streams.h"
#include "taut/learn.h"
#include "taut/summary.h"
#include "taut/version.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;

void PrintValues(const StudyResult& study, const Evaluation& best) {
  for (std::size_t i = 0; i < study.parameters.size(); ++i) {
    fmt::print("  {:<58} {:>14.8g} {}\n", study.parameters[i].name, best.values[i],
               study.parameters[i].unit);
  }
}

nlohmann::json EvaluationJson(const StudyResult& study, const Evaluation& evaluation) {
  nlohmann::json values, worlds;
  for (std::size_t i = 0; i < study.parameters.size(); ++i) {
    values[study.parameters[i].name] = evaluation.values[i];
  }
  for (const RolloutResult& w : evaluation.worlds) {
    nlohmann::json world{
        {"score", w.score},       {"distance_m", w.distance_m},       {"along_m", w.along_m},
        {"energy_j", w.energy_j}, {"max_tension_n", w.max_tension_n}, {"tracking_n", w.tracking_n}};
    if (w.fell_s) world["fell_s"] = *w.fell_s;
    worlds.push_back(std::move(world));
  }
  return {{"evaluation", evaluation.id},
          {"search", evaluation.search},
          {"score", evaluation.score},
          {"values", std::move(values)},
          {"worlds", std::move(worlds)}};
}

}  // namespace

void WarnOfDamage(const std::string& folder, const std::vector<std::string>& skipped) {
  for (const std::string& what : skipped) {
    fmt::print(stderr, "warning: {}: skipped: {}\n", folder, what);
  }
}

int ReplayBest(const std::string& folder, bool skip_damaged, bool tables, bool quiet) {
  Diagnostics found;
  const auto study = ReadStudyFolder(folder, found, skip_damaged);
  if (!study) return Fail(found, kBadInput);
  WarnOfDamage(folder, study->skipped);
  const Evaluation* best = study->best();
  if (best == nullptr) {
    fmt::print(stderr, "{}: no evaluation has succeeded yet\n", folder);
    return kFailed;
  }
  const ExperimentSpec experiment = study->ExperimentWith(best->values);
  std::vector<std::string> gaits;
  std::vector<GaitSpec> learned;
  for (const ControllerSpec& controller : experiment.controllers) {
    const GaitInputSpec* input = GaitInputOf(controller);
    if (!input) continue;
    gaits.push_back(controller.name + ".gait.yaml");
    learned.push_back(input->gait);
    learned.back().name = study->name;
    for (const GaitSpec& other : input->others) {
      gaits.push_back(controller.name + "." + other.name + ".gait.yaml");
      learned.push_back(other);
    }
  }
  const auto out = RunFolder::Open((fs::path(folder) / "best").string(), gaits, found);
  if (!out) return Fail(found, kFailed);
  OutputIsNews();
  const auto summary = RunInto(*out, experiment, {}, false, found);
  if (!summary || !found.ok()) return Fail(found, kFailed);
  for (std::size_t i = 0; i < gaits.size(); ++i) {
    learned[i].description = fmt::format("Learned: evaluation {} of the study {}, score {:.6g}.",
                                         best->id, study->name, best->score);
    SaveGait(learned[i], out->Path(gaits[i]), found);
  }
  viewer::WriteReport(out->Path("trace.h5"), {}, out->Path("report.html"), found);
  if (!quiet) {
    fmt::print("{}: evaluation {} of {}, score {:.8g}\n", study->name, best->id,
               study->evaluations.size(), best->score);
    if (tables) {
      PrintValues(*study, *best);
      fmt::print("{}", SummaryTable(*summary));
    } else {
      PrintRun(*summary, experiment.robot);
    }
    fmt::print("Trace, inputs, summary, gait and report: {}\n", out->Path(""));
    SayNext({"view", (fs::path(folder) / "best").string()});
  }
  if (!best->worlds.empty() && best->worlds[0].state_hash != summary->state_hash) {
    if (study->taut_version == kVersion) {
      found.Error("replay.different_state", {folder},
                  "the replay ends in a different state than the logged run",
                  "results can differ between builds of taut");
    } else {
      found.Warning("replay.different_state", {folder},
                    fmt::format("the replay ends in a different state than the run of taut {}",
                                study->taut_version),
                    fmt::format("results of taut {} differ, see CHANGELOG.md", kVersion));
    }
  }
  return Pass(found, false) ? kOk : Fail(found, kFailed);
}

int PrintTop(const std::string& folder, int count, bool skip_damaged, bool json) {
  Diagnostics found;
  const auto study = ReadStudyFolder(folder, found, skip_damaged);
  if (!study) return Fail(found, kBadInput);
  WarnOfDamage(folder, study->skipped);
  const auto top = study->top(static_cast<std::size_t>(count));
  if (json) {
    nlohmann::json list = nlohmann::json::array();
    for (const Evaluation* evaluation : top) list.push_back(EvaluationJson(*study, *evaluation));
    // Texts in records may contain invalid UTF-8, which JSON does not allow.
    fmt::print("{}\n", list.dump(1, ' ', false, nlohmann::json::error_handler_t::replace));
    return kOk;
  }
  std::size_t failed = 0;
  for (const Evaluation& evaluation : study->evaluations) failed += !evaluation.failed.empty();
  fmt::print("{}: {} evaluations, {} failed\n\n", study->name, study->evaluations.size(), failed);
  fmt::print("{:>10} {:>12} {:>12} {:>9} {:>10} {:>15} {:>6}\n", "evaluation", "score",
             "distance [m]", "along [m]", "energy [J]", "max tension [N]", "falls");
  for (const Evaluation* evaluation : top) {
    double distance = 0, along = 0, energy = 0, tension = 0;
    int fell = 0;
    const auto n = static_cast<double>(evaluation->worlds.size());
    for (const RolloutResult& w : evaluation->worlds) {
      distance += w.distance_m / n;
      along += w.along_m / n;
      energy += w.energy_j / n;
      tension = std::max(tension, w.max_tension_n);
      fell += w.fell_s.has_value();
    }
    fmt::print("{:>10} {:>12.6g} {:>12.4f} {:>9.4f} {:>10.3f} {:>15.2f} {:>6}\n", evaluation->id,
               evaluation->score, distance, along, energy, tension, fell);
  }
  if (!top.empty() && top[0]->worlds.size() > 1) {
    fmt::print(
        "\nmeans of {} worlds; max tension: largest of all worlds; falls: number of worlds\n",
        top[0]->worlds.size());
  }
  SayNext({"learn", "--best", folder});
  return kOk;
}

}  // namespace taut::cli
