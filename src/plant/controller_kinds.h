/// Registry of controllers. Each kind has a file controller_*.cpp and an entry in kControllerKinds.
#pragma once

#include <memory>
#include <vector>

#include "taut/plant.h"

namespace taut::plant {

/// Creates one kind of controller for controller `index` of the experiment. Returns null if the
/// experiment's controller does not have this kind.
using MakeController = std::unique_ptr<Controller> (*)(const ControlSetup&, std::size_t index);

std::unique_ptr<Controller> MakeGait(const ControlSetup&, std::size_t index);
std::unique_ptr<Controller> MakeImpedance(const ControlSetup&, std::size_t index);
std::unique_ptr<Controller> MakePosition(const ControlSetup&, std::size_t index);

/// Order in which they act at a common tick: gaits precede the control laws that use their signals.
inline constexpr MakeController kControllerKinds[] = {MakeGait, MakeImpedance, MakePosition};

/// Returns all controllers: for each controller of the experiment its kinds, then the custom
/// controllers of the calling program.
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
