// Text that identifies a study, to detect changes of its file.
#include "description/study/key_line.h"
#include "description/yaml/reader.h"
#include "taut/study.h"

namespace taut {
namespace {

using description::KeyLine, description::Shown;

std::string SearchLine(const SearchSpec& search) {
  std::string out;
  const auto add = [&](const std::string& word) { out += (out.empty() ? "" : " ") + word; };
  if (std::holds_alternative<MonteCarloSpec>(search.method)) add("monte_carlo");
  if (const auto* hill = std::get_if<HillClimbingSpec>(&search.method)) {
    add("hill_climbing deviation " + Shown(hill->deviation));
    add(hill->adapt ? "adapt" : "fixed");
  }
  if (const auto* nlopt = std::get_if<NloptSpec>(&search.method)) {
    add("nlopt " + nlopt->algorithm + " initial_step " + Shown(nlopt->initial_step));
  }
  if (const auto* cma = std::get_if<CmaEsSpec>(&search.method)) {
    add("cma_es deviation " + Shown(cma->deviation));
  }
  add("batch " + std::to_string(search.batch));
  return out;
}

std::string ObjectiveText(const ObjectiveSpec& objective) {
  const char* const names[] = {"distance", "heading",  "distance_per_energy",
                               "nearer",   "tracking", "none"};
  const Vec3& d = objective.direction;
  std::string out =
      KeyLine("objective measure", names[static_cast<int>(objective.measure)]) +
      KeyLine("objective direction", Shown(d.x) + " " + Shown(d.y) + " " + Shown(d.z)) +
      KeyLine("objective from_s", Shown(objective.from_s)) +
      KeyLine("objective max_speed_m_per_s", Shown(objective.max_speed_m_per_s));
  if (const auto& limit = objective.tension_limit) {
    out += KeyLine("objective tension_limit",
                   Shown(limit->limit_n) + " N, penalty_per_n " + Shown(limit->penalty_per_n));
  }
  if (const auto& fall = objective.fall) {
    const auto shown = [](const std::optional<double>& x) { return x ? Shown(*x) : "none"; };
    out += KeyLine("objective fall", "max_tilt_rad " + Shown(fall->max_tilt_rad) +
                                         " min_height_m " + shown(fall->min_height_m) +
                                         " max_height_m " + shown(fall->max_height_m) +
                                         " penalty " + Shown(fall->penalty));
  }
  return out;
}

}  // namespace

std::string StudyText(const StudySpec& study) {
  std::string out = KeyLine("study", study.name) + KeyLine("seed", std::to_string(study.seed));
  for (const StudyParameter& p : study.parameters) {
    std::string targets;
    for (const std::string& target : p.targets) targets += " " + target;
    out += KeyLine("parameter " + p.name, Shown(p.low) + ".." + Shown(p.high) + " " + p.unit +
                                              (p.log ? " log" : "") + " targets" + targets);
  }
  out += ObjectiveText(study.objective);
  const PerturbationSpec& w = study.perturbation;
  out += KeyLine("worlds", std::to_string(w.worlds) + (w.worst ? " worst" : " mean") +
                               (w.redraw ? " redrawn" : " the same for all"));
  out += KeyLine(
      "worlds friction mass stiffness damping",
      Shown(w.friction) + " " + Shown(w.mass) + " " + Shown(w.stiffness) + " " + Shown(w.damping));
  out += KeyLine(
      "worlds start",
      Shown(w.start.position_m) + " m, " + Shown(w.start.heading_rad) + " rad" +
          (w.start.goal_rad > 0 ? ", goal " + Shown(w.start.goal_rad) + " rad" : "") +
          (w.start.any_pose ? ", any pose" : "") +
          (w.start.place_m > 0 ? ", anywhere within " + Shown(w.start.place_m) + " m" : ""));
  for (std::size_t i = 0; i < study.searches.size(); ++i) {
    out += KeyLine("search " + std::to_string(i), SearchLine(study.searches[i]));
    // The evaluations of the last search are excluded, because they affect no other search.
    if (i + 1 < study.searches.size()) {
      out += KeyLine("search " + std::to_string(i) + " evaluations",
                     std::to_string(study.searches[i].evaluations));
    }
  }
  return out;
}

}  // namespace taut
