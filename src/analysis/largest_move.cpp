// Largest displacement of a node or center of mass from the described pose to another one.
#include <Eigen/LU>
#include <Eigen/SVD>
#include <string>
#include <vector>

#include "analysis/structure.h"
#include "base/brief.h"
#include "math/vec.h"
#include "taut/analysis.h"

namespace taut {

Move LargestMove(const ModelDef& def, const Pose& pose) {
  using namespace analysis;  // NOLINT(google-build-using-namespace): this function alone
  LoadCaseSpec nothing;
  nothing.weight = false;
  const Structure s(def, nothing, true);
  Move out;
  out.size_m = s.size_m;
  std::vector<std::string> names;
  std::vector<Vec3> before, after;
  const auto add = [&](const std::string& name, int body, const Vec3& place) {
    if (s.Moving(body) < 0) return;
    const std::size_t b = static_cast<std::size_t>(body);
    const BodyState& there = pose.bodies[b];
    names.push_back(name), before.push_back(place);
    after.push_back(there.position_m + Rotate(there.orientation, place - def.bodies[b].com_m));
  };
  for (const NodeDef& node : def.nodes)
    add("node \"" + node.name + "\"", node.body, node.position_m);
  for (const int body : s.bodies) {
    const BodyDef& one = def.bodies[static_cast<std::size_t>(body)];
    add("body \"" + one.name + "\"", body, one.com_m);
  }
  if (before.empty()) return out;
  Vec3 middle, moved;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (!s.held_by_world) {
    // Statics does not determine the rigid motion of an unsupported structure. Subtract the best
    // fit (Kabsch): centroid to centroid, and the rotation nearest to sum(after before^T).
    const double share = 1.0 / static_cast<double>(before.size());
    for (const Vec3& p : before) middle = middle + share * p;
    for (const Vec3& p : after) moved = moved + share * p;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < before.size(); ++i) {
      sum += Of(after[i] - moved) * Of(before[i] - middle).transpose();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d sign(1, 1,
                         (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
    turn = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  }
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double distance_m = (Of(after[i] - moved) - turn * Of(before[i] - middle)).norm();
    if (distance_m > out.distance_m) out.distance_m = distance_m, out.name = names[i];
  }
  return out;
}

std::string Move::Warning() const {
  if (distance_m <= kFar * size_m) return "";
  return name + " moves by " + base::Brief(distance_m) +
         " m, more than a quarter of the structure's size of " + base::Brief(size_m) + " m";
}

}  // namespace taut
