#include "description/gait/gait_sine.h"

#include <map>

namespace taut::description {

void Check(const MapReader& map, SineGait& sine) {
  CheckTwice(sine.waves, "waves", map.scope());
  if (map.Has("waves") && sine.waves.empty() && map.scope().out.ok()) {
    map.Error("gait.no_waves", "waves", "sine.waves needs at least one entry");
  }
}

void CheckNumbers(const SineGait&, const SourceRef&, Diagnostics&) {}

void Resolve(const SineGait& sine, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out) {
  std::map<int, std::pair<ResolvedGait::Wave, const SineWave*>> by_cable;
  for (const SineWave& wave : sine.waves) {
    std::string twice;
    for (const int cable : FindCables(wave.cables, "wave " + wave.name, wave.at, robot, out)) {
      const std::string& name = robot.def.cables[static_cast<std::size_t>(cable)].name;
      const auto place = PlaceInChain(name);
      if (!place && wave.phase_per_segment_rad != 0.0) {
        out.Error("gait.cable_without_number", wave.at,
                  "wave " + wave.name +
                      ": phase_per_segment_rad needs cable names that end in a number, got " + name,
                  "such as outer_top_2");
      }
      const int index = static_cast<int>(&wave - sine.waves.data());
      const auto [other, fresh] =
          by_cable.insert({cable, {{index, place ? place->number - 1 : 0}, &wave}});
      if (!fresh && twice.empty()) {
        twice = name + " already has the wave " + other->second.second->name;
      }
    }
    if (!twice.empty()) {
      out.Error("gait.cable_matched_twice", wave.at, "wave " + wave.name + ": " + twice,
                "a cable can have only one wave");
    }
  }
  for (const auto& [cable, wave] : by_cable) {
    resolved.cables.push_back(cable);
    resolved.waves.push_back(wave.first);
  }
}

}  // namespace taut::description
