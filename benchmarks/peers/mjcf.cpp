/// MuJoCo model (MJCF) as text: compiled by mujoco.cpp, and readable by programs with other
/// versions of MuJoCo. Needs no MuJoCo.
#include "benchmarks/peers/adapters.h"
#include "mjcf/write.h"

namespace taut::peers {

std::vector<float> MujocoHeights(const HeightFieldDef& field) {
  const mechanics::HeightRange range = mechanics::HeightsOf(field);
  std::vector<float> heights;
  for (const double z : field.height_m) {
    heights.push_back(static_cast<float>((z - range.least_m) / mjcf::RiseOf(range)));
  }
  return heights;
}

std::string Mjcf(const ModelDef& def, const Options& options) {
  mjcf::WriteOptions as;
  as.keyframe = true;
  as.elliptic = options.elliptic;
  as.as_peer = true;
  return mjcf::Text(def, as);
}

}  // namespace taut::peers
