/// Positions of nodes as derived channels, computed from the recorded poses of bodies.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "taut/model_def.h"
#include "taut/trace.h"

namespace taut::viewer {

/// Channels node/<name>/position_{x,y,z}_m of all nodes on bodies.
class NodeChannels {
 public:
  NodeChannels() = default;
  explicit NodeChannels(const ModelDef& def);

  /// Pose of a body over time: position [m] and orientation (w, x, y, z).
  using Poses = std::array<const std::vector<double>*, 7>;

  struct Place {
    int body = 0;
    int axis = 0;
    Vec3 p_BN;  ///< Vector from the body's center of mass to the node, in the body's frame [m].
  };

  const std::vector<ChannelInfo>& channels() const { return channels_; }
  /// Returns nothing for other channel names.
  std::optional<Place> Find(const std::string& name) const;
  /// Returns the channel row by row: one component of p_WN = p_WB + q_WB p_BN.
  static std::vector<double> Column(const Place& place, const Poses& poses);

 private:
  std::vector<ChannelInfo> channels_;
  std::unordered_map<std::string, Place> places_;
};

}  // namespace taut::viewer
