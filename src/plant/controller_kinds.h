/// Registry of the controllers of an experiment: one file per kind (controller_*.cpp) and one entry
/// here.
#pragma once

#include <memory>
#include <vector>

#include "taut/plant.h"

namespace taut::plant {

/// Each creates the controller of its kind for controller `index` of the experiment; null if that
/// has none.
using MakeController = std::unique_ptr<Controller> (*)(const ControlSetup&, std::size_t index);

std::unique_ptr<Controller> MakeGait(const ControlSetup&, std::size_t index);
std::unique_ptr<Controller> MakeImpedance(const ControlSetup&, std::size_t index);
std::unique_ptr<Controller> MakePosition(const ControlSetup&, std::size_t index);

/// In the order in which they act at the same time: a gait before the law that it feeds.
inline constexpr MakeController kControllerKinds[] = {MakeGait, MakeImpedance, MakePosition};

/// Returns the controllers of an experiment, each with its kinds in order, then the controllers
/// that the calling program adds.
inline std::vector<std::unique_ptr<Controller>> MakeControllers(const ControlSetup& setup,
                                                                const Extensions& extensions) {
  std::vector<std::unique_ptr<Controller>> made;
  for (std::size_t i = 0; i < setup.experiment.controllers.size(); ++i) {
    for (const MakeController make : kControllerKinds) {
      if (auto controller = make(setup, i)) made.push_back(std::move(controller));
    }
  }
  for (const auto& make : extensions.controllers) made.push_back(make(setup));
  return made;
}

}  // namespace taut::plant
