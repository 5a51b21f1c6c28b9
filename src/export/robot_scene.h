/// Recorded robot as Foxglove messages: frames of its bodies, shapes, cables.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "taut/model_def.h"
#include "taut/trace.h"

namespace taut::exporting {

/// Channels of a body's pose: position x, y, z and orientation w, x, y, z.
struct BodyChannels {
  std::string name;
  std::array<std::size_t, 3> place;
  std::array<std::size_t, 4> turn;

  Vec3 PlaceAt(const Trace& trace, std::size_t row) const;
  Quat TurnAt(const Trace& trace, std::size_t row) const;
  bool IsFiniteAt(const Trace& trace, std::size_t row) const;
};
/// Returns the pose channels of all recorded bodies, in the order of the trace.
std::vector<BodyChannels> BodiesOf(const Trace& trace);

/// Returns foxglove.FrameTransforms from the world frame to the body frames. Body frames have their
/// origin at the center of mass and are parallel to W in the described pose.
std::string FramesAt(const Trace& trace, const std::vector<BodyChannels>& bodies, std::size_t row,
                     std::uint64_t time_ns);

/// Returns foxglove.SceneUpdate with the shapes of each body in the body's frame.
std::string RobotShapes(const ModelDef& def, std::uint64_t time_ns);

/// Cable lines that follow the recorded poses of bodies.
class CableLines {
 public:
  /// Returns nothing if a moving body has no channels, or if there are no cables.
  static std::optional<CableLines> Of(const ModelDef& def, const Trace& trace,
                                      const std::vector<BodyChannels>& bodies);
  /// Returns foxglove.SceneUpdate with all cables as lines in W.
  std::string At(const Trace& trace, std::size_t row, std::uint64_t time_ns) const;

 private:
  explicit CableLines(const ModelDef& def) : def_(&def) {}
  Vec3 Moved(int body, const Vec3& point_m, const Trace& trace, std::size_t row) const;
  CableDef CableAt(const CableDef& cable, const Trace& trace, std::size_t row) const;

  const ModelDef* def_;
  std::vector<std::optional<BodyChannels>> bodies_;  ///< Per body of the model; nothing if it was
                                                     ///< not recorded.
  std::vector<std::optional<std::size_t>> tension_;  ///< Tension channel of each cable; nothing if
                                                     ///< it was not recorded.
};

/// Return the JSON schemas of both messages, limited to the used fields.
std::string FramesSchema();
std::string SceneSchema();

}  // namespace taut::exporting
