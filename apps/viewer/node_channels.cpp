#include "node_channels.h"

namespace taut::viewer {
namespace {

/// Rotates v by the unit quaternion q: v + 2 w (u x v) + 2 u x (u x v), where u is its vector part.
Vec3 Turned(const Quat& q, const Vec3& v) {
  const Vec3 t{2 * (q.y * v.z - q.z * v.y), 2 * (q.z * v.x - q.x * v.z),
               2 * (q.x * v.y - q.y * v.x)};
  return {v.x + q.w * t.x + q.y * t.z - q.z * t.y, v.y + q.w * t.y + q.z * t.x - q.x * t.z,
          v.z + q.w * t.z + q.x * t.y - q.y * t.x};
}

}  // namespace

NodeChannels::NodeChannels(const ModelDef& def) {
  static const char* const kNames[] = {"/position_x_m", "/position_y_m", "/position_z_m"};
  for (const NodeDef& node : def.nodes) {
    if (node.body == kWorld) continue;  // the node is fixed in the world
    // at t = 0 the axes of bodies are parallel to W
    const Vec3& c = def.bodies[static_cast<std::size_t>(node.body)].com_m;
    const Vec3& p = node.position_m;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string name = "node/" + node.name + kNames[axis];
      channels_.push_back({name, "m"});
      places_[name] = {node.body, axis, {p.x - c.x, p.y - c.y, p.z - c.z}};
    }
  }
}

std::optional<NodeChannels::Place> NodeChannels::Find(const std::string& name) const {
  const auto at = places_.find(name);
  if (at == places_.end()) return std::nullopt;
  return at->second;
}

std::vector<double> NodeChannels::Column(const Place& place, const Poses& poses) {
  std::vector<double> column(poses[0]->size());
  for (std::size_t row = 0; row < column.size(); ++row) {
    const auto at = [&](std::size_t value) { return (*poses[value])[row]; };
    const Vec3 turned = Turned({at(3), at(4), at(5), at(6)}, place.p_BN);
    const double offset[] = {turned.x, turned.y, turned.z};
    column[row] = at(static_cast<std::size_t>(place.axis)) + offset[place.axis];
  }
  return column;
}

}  // namespace taut::viewer
