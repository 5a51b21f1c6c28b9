/// A ball that hangs on a cable with an actuator: the model of the fit tests
#pragma once

#include <string>

namespace taut::test {

inline const std::string kHangingModel = R"(taut: 1
kind: model
name: hanging
parameters: {k_n_per_m: 100, mass_kg: 0.5}
nodes: {top: [0, 0, 1], ball: [0, 0, 0]}
pairs: [{name: c, nodes: [top, ball], tags: [cable]}]
builders:
  - {match: top, anchor: {}}
  - {match: ball, point_mass: {mass_kg: mass_kg, radius_m: 0.01}}
  - {match: cable, cable: {stiffness_n_per_m: k_n_per_m, damping_n_s_per_m: 8, rest_length_m: 0.9, actuator: {ideal: true}}}
)";

}  // namespace taut::test
