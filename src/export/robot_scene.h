/// Recorded robot in Foxglove messages: frames of its bodies, shapes, cables.
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

/// A body's channels: position in x, y, z, orientation in w, x, y, z.
struct BodyChannels {
  std::string name;
  std::array<std::size_t, 3> place;
  std::array<std::size_t, 4> turn;

  Vec3 PlaceAt(const Trace& trace, std::size_t row) const;
  Quat TurnAt(const Trace& trace, std::size_t row) const;
  bool IsFiniteAt(const Trace& trace, std::size_t row) const;
};
/// Returns the channels of all bodies with such channels, in the order of the trace.
std::vector<BodyChannels> BodiesOf(const Trace& trace);

/// Returns foxglove.FrameTransforms from the world's frame to the bodies' frames, whose axes
/// coincide with W in the described pose and whose origins are centers of mass.
std::string FramesAt(const Trace& trace, const std::vector<BodyChannels>& bodies, std::size_t row,
                     std::uint64_t time_ns);

/// Returns foxglove.SceneUpdate, for each body its shapes in its frame.
std::string RobotShapes(const ModelDef& def, std::uint64_t time_ns);

/// Cables at the poses of bodies.
class CableLines {
 public:
  /// Returns nothing if a body that moves has no channels, or there are no cables.
  static std::optional<CableLines> Of(const ModelDef& def, const Trace& trace,
                                      const std::vector<BodyChannels>& bodies);
  /// Returns foxglove.SceneUpdate with all cables as lines in W.
  std::string At(const Trace& trace, std::size_t row, std::uint64_t time_ns) const;

 private:
  explicit CableLines(const ModelDef& def) : def_(&def) {}
  Vec3 Moved(int body, const Vec3& point_m, const Trace& trace, std::size_t row) const;
  CableDef CableAt(const CableDef& cable, const Trace& trace, std::size_t row) const;

  const ModelDef* def_;
  std::vector<std::optional<BodyChannels>> bodies_;  ///< Per body of the model.
  std::vector<std::optional<std::size_t>> tension_;  ///< Per cable, its channel.
};

/// Return the JSON schemas of the used parts of the two messages.
std::string FramesSchema();
std::string SceneSchema();

}  // namespace taut::exporting
