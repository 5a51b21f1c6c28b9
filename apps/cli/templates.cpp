// Templates of files for `taut new`.
#include "templates.h"

#include <fmt/format.h>

namespace taut::cli {
namespace {

/// Returns the head of a file: format, name, schema.
std::string Head(const std::string& kind, const std::string& name, const std::string& schema) {
  const std::string editor =
      schema.empty() ? "" : "# yaml-language-server: $schema=" + schema + "\n";
  return fmt::format("{0}taut: 1\nkind: {1}\nname: {2}\n", editor, kind, name);
}

/// Quotes a path for YAML, with any characters.
std::string Quoted(const std::string& path) {
  std::string out = "'";
  for (const char c : path) out += c == '\'' ? "''" : std::string(1, c);
  return out + "'";
}

}  // namespace

std::string NewModel(const std::string& name, const std::string& schema) {
  return Head("model", name, schema) + R"(description: Three struts and nine cables, a prism.

# Parameters of the expressions below. `--set radius_m=0.2` changes one for a single command.
parameters:
  radius_m: 0.1
  height_m: 0.2
  stiffness_n_per_m: 1000

# A part is defined once and placed any number of times. A pair connects two nodes; builders select
# pairs by their tags.
parts:
  strut:
    nodes:
      bottom: [radius_m, 0, 0]
      top: [radius_m * cos(5 / 6 * pi), radius_m * sin(5 / 6 * pi), height_m]
    pairs:
      - {nodes: [bottom, top], tags: [rod]}

# Three copies in a ring, each rotated by a third of a turn, connected to the next one by cables.
structure:
  - part: strut
    copies: 3
    step_rotate: {axis: z, angle_rad: 2 / 3 * pi}
    ring: true
    connect:
      - {name: lower, nodes: [bottom, bottom], tags: [cable]}
      - {name: upper, nodes: [top, top], tags: [cable]}
      - {name: side, nodes: [top, bottom], tags: [cable]}

# Builders turn nodes and pairs with a tag into rods, cables, spheres ... A cable is a spring and a
# damper that pull and never push; its rest length is 0.9 of its length here.
builders:
  - {match: rod, rod: {radius_m: 0.005, mass_kg: 0.03, friction: 0.5}}
  - {match: cable, cable: {stiffness_n_per_m: stiffness_n_per_m, damping_n_s_per_m: 5, rest_length_ratio: 0.9}}
)";
}

std::string NewExperiment(const std::string& name, const std::string& schema,
                          const std::string& from) {
  return Head("experiment", name, schema) +
         "description: The robot falls onto the ground and comes to rest.\n\n"
         "# The robot's model file, relative to this file's folder. `set: {PARAMETER: VALUE}` "
         "changes\n"
         "# its parameters.\n"
         "model: " +
         Quoted(from) + R"(

# Start pose: rotated, then moved. The ground is level, at height 0.
place: {at_m: [0, 0, 0.3], rotate: {axis: x, angle_rad: 0.5}}
terrain:
  - {name: ground, plane: {height_m: 0, friction: 0.5}}

duration_s: 3

# The table of `taut run` has a column for each phase. Pushes and drags are timeline `events`:
#   events:
#     - push: {name: tap, node: NODE, direction: [1, 0, 0], force_n: [[1, 0], [1.1, 5], [1.2, 0]]}
timeline:
  phases: {falling: [0, 0.2], at_rest: [2, 3]}

# Contents of the trace: rows per second, and `channels` by pattern (default: all).
record:
  rate_hz: 100
)";
}

std::string NewStudy(const std::string& name, const std::string& schema, const std::string& from) {
  return Head("study", name, schema) +
         "description: Phases of the cables' waves that move the robot far.\n\n"
         "# Experiment with the parameters to vary, relative to this file's folder.\n"
         "# `taut learn --parameters EXPERIMENT` lists them all.\n"
         "experiment: " +
         Quoted(from) + R"(
seed: 1

# `each` varies every match separately, `all` gives all matches one common value.
vary:
  - {name: frequency, each: motion.sine.frequency_hz, low: 0.2, high: 2, scale: log}
  - {name: amplitude, all: motion.sine.*.amplitude_m_per_s, low: 0.02, high: 0.3}
  - {each: motion.sine.*.phase_rad, low: -pi, high: pi}

# Score to maximize.
objective:
  measure: distance
  from_s: 2
  fall: {max_tilt_rad: 1.2, penalty: 0.5}

# Each candidate runs in `count` worlds with random differences; its score is the mean.
worlds: {count: 2, friction: 0.2}

# Stages, each from the best candidate of the stages before. 1000 evaluations find a gait.
search:
  - {method: monte_carlo, evaluations: 32, batch: 16}
  - {method: hill_climbing, evaluations: 32, batch: 16, deviation: 0.1}
)";
}

}  // namespace taut::cli
