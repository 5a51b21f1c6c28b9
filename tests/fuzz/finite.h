/// Search for non-finite numbers in all observable values of a world.
#pragma once

#include <cmath>
#include <string>

#include "taut/world_batch.h"

namespace taut::fuzz {

inline bool Finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Returns the name of a non-finite observable value; empty if all are finite.
inline std::string NotFinite(const WorldBatch& batch, int world) {
  const ModelDef& def = batch.model().def();
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    const BodyState s = batch.Body(world, static_cast<int>(b));
    const double turned = s.orientation.w + s.orientation.x + s.orientation.y + s.orientation.z;
    const bool good = Finite(s.position_m) && Finite(s.velocity_m_per_s) &&
                      Finite(s.angular_velocity_rad_per_s) && std::isfinite(turned);
    if (!good) return def.bodies[b].name;
  }
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const CableState s = batch.Cable(world, static_cast<int>(c));
    const bool good = std::isfinite(s.length_m) && std::isfinite(s.rate_m_per_s) &&
                      std::isfinite(s.rest_length_m) && std::isfinite(s.tension_n) &&
                      std::isfinite(s.elastic_n);
    if (!good) return def.cables[c].name;
  }
  for (const ContactState& c : batch.Contacts(world)) {
    if (!Finite(c.point_m) || !Finite(c.normal) || !Finite(c.force_n)) return "a contact";
  }
  return {};
}

}  // namespace taut::fuzz
