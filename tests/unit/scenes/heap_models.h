/// Small robots that settle: a prism that keeps its shape, and a model that collapses
#pragma once

namespace taut::test {

/// A prism of three struts at the twist at which prestress alone holds it: 150 degrees. `turn_rad`
/// deviates from this twist; then the prism rotates back, and its side cables, which are shortest
/// at 150 degrees, are too long.
inline constexpr const char* kPrism = R"(taut: 1
kind: model
name: prism
parameters:
  turn_rad: 0
  radius_m: 0.1
  twist_rad: 5 * pi / 6 + turn_rad
  side_n: 20
  base_n: side_n / sqrt(0.04 + 2 * radius_m^2 * (1 - cos(pi / 6))) * radius_m
parts:
  strut:
    nodes:
      bottom: {at_m: [radius_m, 0, 0], tags: [end]}
      top: {at_m: [radius_m * cos(twist_rad), radius_m * sin(twist_rad), 0.2], tags: [end]}
    pairs:
      - {nodes: [bottom, top], tags: [strut]}
structure:
  - part: strut
    copies: 3
    at_m: [0, 0, 0.005]
    step_rotate: {axis: z, angle_rad: 2 * pi / 3}
    ring: true
    connect:
      - {name: lower, nodes: [bottom, bottom], tags: [base]}
      - {name: upper, nodes: [top, top], tags: [base]}
      - {name: side, nodes: [top, bottom], tags: [side]}
builders:
  - {match: strut, rod: {radius_m: 0.005, mass_kg_per_m: 0.15, friction: 0.5}}
  - {match: base, cable: {stiffness_n_per_m: 1000, damping_n_s_per_m: 10, prestress_n: base_n}}
  - {match: side, cable: {stiffness_n_per_m: 1000, damping_n_s_per_m: 10, prestress_n: side_n}}
)";

inline constexpr const char* kSettledPrism = R"(taut: 1
kind: experiment
name: stands
model: prism.yaml
terrain:
  - {name: ground, plane: {height_m: 0, friction: 0.5}}
duration_s: 1
start: settled
)";

}  // namespace taut::test
