#include "plant/status_text.h"

namespace taut::plant {

std::string StatusText(const ModelDef& def, const WorldStatus& status) {
  const auto body_name = [&] { return def.bodies[static_cast<std::size_t>(status.body)].name; };
  const std::string when = std::to_string(status.first_time_s) + " s";
  if (status.bits == kStatusFellOff) {
    const auto ground = static_cast<std::size_t>(status.ground), fields = def.height_fields.size();
    return "body " + body_name() + " left the " +
           (ground < fields ? "height field " + def.height_fields[ground].name
                            : "mesh " + def.terrain_meshes[ground - fields].name) +
           " and is below all of the terrain at t = " + when;
  }
  std::string out;
  const auto add = [&](const char* text) { out += (out.empty() ? "" : "; ") + std::string(text); };
  if (status.bits & kStatusNonFinite) add("the state is no longer finite");
  if (status.bits & kStatusNotConverged)
    add("the contacts or stiff cables were not solved to the tolerance");
  if (status.bits & kStatusStepTooLong) {
    add(status.cable >= 0
            ? "the step is too long for the tension of a cable, for its vibration, or for its path "
              "around a rod that turns"
            : "the step is too long for the joint forces of a body, or for its rotation about a "
              "hinge away from its center of mass");
  }
  if (status.bits & kStatusContactOverflow) {
    add(status.cable >= 0 ? "a cable touches more edges and rods than it can bend around"
                          : "there are more contacts than the contact buffer holds");
  }
  if (status.bits & kStatusFellOff) add("a body is below all of the terrain");
  if (out.empty()) return out;
  if (status.body != kWorld) out += ", body " + body_name();
  if (status.cable >= 0)
    out += ", cable " + def.cables[static_cast<std::size_t>(status.cable)].name;
  return out + ", first at t = " + when;
}

}  // namespace taut::plant
