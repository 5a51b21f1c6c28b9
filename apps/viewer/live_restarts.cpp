#include "live_restarts.h"

#include <fmt/format.h>

#include <utility>

namespace taut::viewer {

std::optional<Restarts::Start> Restarts::Make(const ExperimentSpec& present,
                                              Clock::time_point deadline,
                                              const std::function<bool()>& go_on) {
  do {
    if (groups_.empty() && !asked_.empty()) groups_.push_back(std::exchange(asked_, {}));
    if (groups_.empty()) return std::exchange(found_, std::nullopt);
    Group group = std::move(groups_.front());
    groups_.pop_front();
    Try(std::move(group), present, go_on);
  } while (go_on() && (!pending() || Clock::now() < deadline));
  return std::nullopt;
}

void Restarts::Try(Group group, const ExperimentSpec& present, const std::function<bool()>& go_on) {
  Overrides overrides = inputs_.overrides;
  bool changed = false;
  for (const Change& change : group) {
    if (change.parameter.empty()) continue;
    changed = true;
    std::erase_if(overrides, [&](const auto& set) { return set.first == change.parameter; });
    overrides.emplace_back(change.parameter, fmt::format("{}", change.value));
  }
  Diagnostics wrong;
  std::optional<ExperimentSpec> experiment;
  if (changed) {
    experiment = LoadExperiment(inputs_.path, overrides, wrong);
    if (experiment && inputs_.step_s > 0) experiment->step_s = inputs_.step_s;
    if (experiment && inputs_.start) experiment->start = *inputs_.start;
  } else {
    experiment = found_ ? found_->experiment : present;
  }
  auto run = experiment ? LiveRun::Start(*experiment, wrong, go_on) : nullptr;
  if (run) {
    found_ = Start{std::move(run), std::move(*experiment), Sorted(wrong.warnings())};
    inputs_.overrides = std::move(overrides);
  } else if (group.size() == 1) {
    refused_.push_back({group.front().client, wrong.Format()});
  } else {
    const auto half = group.begin() + static_cast<std::ptrdiff_t>(group.size() / 2);
    groups_.emplace_front(half, group.end());
    groups_.emplace_front(group.begin(), half);
  }
}

}  // namespace taut::viewer
