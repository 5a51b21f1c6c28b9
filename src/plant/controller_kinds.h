/// The controllers that an experiment may have. One a file, controller_*.cpp, and a line here.
#pragma once

#include <memory>
#include <vector>

#include "taut/plant.h"

namespace taut::plant {

/// Each makes what a controller of the experiment, number `index`, has of its kind; nothing if it
/// has none of it.
using MakeController = std::unique_ptr<Controller> (*)(const ControlSetup&, std::size_t index);

std::unique_ptr<Controller> MakeGait(const ControlSetup&, std::size_t index);
std::unique_ptr<Controller> MakeImpedance(const ControlSetup&, std::size_t index);
std::unique_ptr<Controller> MakePosition(const ControlSetup&, std::size_t index);

/// In the order in which they act at one time: a gait before the law that it feeds.
inline constexpr MakeController kControllerKinds[] = {MakeGait, MakeImpedance, MakePosition};

/// The controllers of an experiment, each with its kinds one after the other, then those that a
/// program brings.
inline std::vector<std::unique_ptr<Controller>> MakeControllers(const ControlSetup& setup,
                                                                const Brought& brought) {
  std::vector<std::unique_ptr<Controller>> made;
  for (std::size_t i = 0; i < setup.experiment.controllers.size(); ++i) {
    for (const MakeController make : kControllerKinds) {
      if (auto controller = make(setup, i)) made.push_back(std::move(controller));
    }
  }
  for (const auto& make : brought.controllers) made.push_back(make(setup));
  return made;
}

}  // namespace taut::plant
