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

# Numbers with names, for the expressions below. `--set radius_m=0.2` changes one for one run.
parameters:
  radius_m: 0.1
  height_m: 0.2
  stiffness_n_per_m: 1000

# A part is described once and placed as often as needed. A pair joins two nodes; its tags say
# what builders make of it.
parts:
  strut:
    nodes:
      bottom: [radius_m, 0, 0]
      top: [radius_m * cos(5 / 6 * pi), radius_m * sin(5 / 6 * pi), height_m]
    pairs:
      - {nodes: [bottom, top], tags: [rod]}

# Three copies in a ring, each a third of a turn further, joined to the next one by cables.
structure:
  - part: strut
    copies: 3
    step_rotate: {axis: z, angle_rad: 2 / 3 * pi}
    ring: true
    connect:
      - {name: lower, nodes: [bottom, bottom], tags: [cable]}
      - {name: upper, nodes: [top, top], tags: [cable]}
      - {name: side, nodes: [top, bottom], tags: [cable]}

# What carries a tag becomes a rod, a cable, a sphere ... A cable is a spring and a damper that
# pull and never push; without tension it has 0.9 of the length that it has here.
builders:
  - {match: rod, rod: {radius_m: 0.005, mass_kg: 0.03, friction: 0.5}}
  - {match: cable, cable: {stiffness_n_per_m: stiffness_n_per_m, damping_n_s_per_m: 5, rest_length_ratio: 0.9}}
)";
}

std::string NewExperiment(const std::string& name, const std::string& schema,
                          const std::string& from) {
  return Head("experiment", name, schema) +
         "description: The robot falls onto the ground and comes to rest.\n\n"
         "# The robot, seen from this file's folder. `set: {PARAMETER: VALUE}` changes its "
         "numbers.\n"
         "model: " +
         Quoted(from) + R"(

# Where it is at the start: turned, then moved. The ground is level, at height 0.
place: {at_m: [0, 0, 0.3], rotate: {axis: x, angle_rad: 0.5}}
terrain:
  - {name: ground, plane: {height_m: 0, friction: 0.5}}

duration_s: 3

# The table of `taut run` has a column for each phase. Pushes and drags are `events` beside them:
#   events:
#     - push: {name: tap, node: NODE, direction: [1, 0, 0], force_n: [[1, 0], [1.1, 5], [1.2, 0]]}
timeline:
  phases: {falling: [0, 0.2], at_rest: [2, 3]}

# What the trace holds: rows a second, and channels by pattern (all of them without `channels`).
record:
  rate_hz: 100
)";
}

std::string NewStudy(const std::string& name, const std::string& schema, const std::string& from) {
  return Head("study", name, schema) +
         "description: How long is each cable's wave to wait, for the robot to get far?\n\n"
         "# What is varied belongs to this experiment, seen from this file's folder.\n"
         "# `taut learn --parameters EXPERIMENT` lists all that can be.\n"
         "experiment: " +
         Quoted(from) + R"(
seed: 1

# `each` varies what fits one by one, `all` together.
vary:
  - {name: frequency, each: motion.sine.frequency_hz, low: 0.2, high: 2, scale: log}
  - {name: amplitude, all: motion.sine.*.amplitude_m_per_s, low: 0.02, high: 0.3}
  - {each: motion.sine.*.phase_rad, low: -pi, high: pi}

# What is to be large.
objective:
  measure: distance
  from_s: 2
  fall: {max_tilt_rad: 1.2, penalty: 0.5}

# Every candidate is tried in so many worlds, which differ by this much; its score is the mean.
worlds: {count: 2, friction: 0.2}

# One after the other, each from the best of those before. A thousand evaluations find a gait.
search:
  - {method: monte_carlo, evaluations: 32, batch: 16}
  - {method: hill_climbing, evaluations: 32, batch: 16, deviation: 0.1}
)";
}

}  // namespace taut::cli
