#include "tests/mechanics/known_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace taut::mechanics {
namespace {

std::vector<SceneEntry>& Registry() {
  static std::vector<SceneEntry> scenes;
  return scenes;
}

}  // namespace

bool Finding::Holds() const {
  return is_bound ? measured <= expected : std::abs(measured - expected) <= tolerance;
}

void Report::Near(std::string quantity, std::string unit, double measured, double expected,
                  double tolerance) {
  findings_.push_back({std::move(quantity), std::move(unit), expected, measured, tolerance, false});
}

void Report::AtMost(std::string quantity, std::string unit, double measured, double bound) {
  findings_.push_back({std::move(quantity), std::move(unit), bound, measured, 0, true});
}

void Report::Order(std::string quantity, double coarse_error, double fine_error,
                   double ratio_of_steps, double least_order) {
  const double order = std::log(coarse_error / fine_error) / std::log(ratio_of_steps);
  // Reported as a bound on the shortfall, so that a higher order passes.
  AtMost(std::move(quantity) + ", order below " + std::to_string(least_order).substr(0, 4), "1",
         std::max(0.0, least_order - order), 0);
}

SceneEntry::SceneEntry(const char* subject_in, const char* name_in, const char* oracle_in,
                       void (*run_in)(Report&))
    : subject(subject_in), name(name_in), oracle(oracle_in), run(run_in) {
  Registry().push_back(*this);
}

std::vector<SceneEntry> AllScenes() {
  std::vector<SceneEntry> scenes = Registry();
  std::sort(scenes.begin(), scenes.end(), [](const SceneEntry& a, const SceneEntry& b) {
    const int by_subject = std::strcmp(a.subject, b.subject);
    return by_subject != 0 ? by_subject < 0 : std::strcmp(a.name, b.name) < 0;
  });
  return scenes;
}

}  // namespace taut::mechanics
