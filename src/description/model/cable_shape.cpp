#include "description/model/cable_shape.h"

#include <cmath>
#include <limits>
#include <optional>

#include "description/model/follow_route.h"
#include "math/cable_path.h"
#include "math/vec.h"

namespace taut::description {
namespace {

double LengthBetween(const AttachmentDef& a, const AttachmentDef& b) {
  return MeasureThrough<Vec3>(2, [&](int i) { return (i == 0 ? a : b).position_m; }).l;
}

class CableShaper {
 public:
  CableShaper(const CableSurroundings& in, OncePerPlace& once) : in_(in), once_(once) {}

  void Run(const PlacedPair& pair, const CableText& builder, CableDef& cable) {
    for (const int node : pair.nodes) {
      cable.attachments.push_back({BodyOf(node), in_.assembly.nodes[node].position_m});
    }
    if (builder.ends_on_surface) MoveEndsToSurface(pair, builder, cable);
    if (!pair.route.empty()) FollowRoute(pair, in_.assembly, cable, once_);
  }

 private:
  int BodyOf(int node) const { return in_.body_of_node ? (*in_.body_of_node)[node] : kWorld; }

  const SphereText* SphereAt(int node) const {
    for (const int b : in_.assignment.of_node[node]) {
      if (in_.model.builders[b].sphere) return &*in_.model.builders[b].sphere;
    }
    return nullptr;
  }

  /// Returns the point on a rod's surface at which the cable leaves `node`. It is next to the node,
  /// in the direction perpendicular to the rod, toward `next`. Returns the node itself if `next` is
  /// along the rod. If several rods end at the node, the shortest one counts; of equal ones, the
  /// first.
  std::optional<Vec3> OnRod(int node, const Vec3& next) const {
    std::optional<Vec3> on_rod;
    double nearest = std::numeric_limits<double>::infinity();
    const Vec3 at = in_.assembly.nodes[node].position_m;
    for (std::size_t i = 0; i < in_.assembly.pairs.size(); ++i) {
      const std::vector<int>& ends = in_.assembly.pairs[i].nodes;
      const int b = in_.assignment.of_pair[i];
      if (b < 0 || !in_.model.builders[b].rod || ends.size() != 2) continue;
      if (ends[0] != node && ends[1] != node) continue;
      const Vec3 along = in_.assembly.nodes[ends[0] == node ? ends[1] : ends[0]].position_m - at;
      const double length = std::sqrt(Dot(along, along));
      if (!(length >= kShortestLeg_m) || !(length < nearest * (1 - 1e-9))) continue;
      nearest = length;
      const Vec3 leg = next - at;
      const Vec3 out = leg - (Dot(along, leg) / (length * length)) * along;
      const double aside = std::sqrt(Dot(out, out));
      const double radius = in_.model.builders[b].rod->radius_m;
      on_rod = aside < kShortestLeg_m ? at : at + (radius / aside) * out;
    }
    return on_rod;
  }

  void MoveEndsToSurface(const PlacedPair& pair, const CableText& builder, CableDef& cable) {
    const std::vector<AttachmentDef> nodes = cable.attachments;
    const std::size_t last = nodes.size() - 1;
    const auto move = [&](std::size_t end, std::size_t next) {
      const int node = pair.nodes[end];
      const double length = LengthBetween(nodes[end], nodes[next]);
      if (const SphereText* const sphere = SphereAt(node)) {
        if (length < kShortestLeg_m) return;
        const Vec3 leg = nodes[next].position_m - nodes[end].position_m;
        cable.attachments[end].position_m =
            nodes[end].position_m + (sphere->radius_m / length) * leg;
      } else if (const auto on_rod = OnRod(node, nodes[next].position_m)) {
        cable.attachments[end].position_m = *on_rod;
      } else if (BodyOf(node) != kWorld) {  // no sphere or rod whose surface the cable could leave
        once_("cable.end_without_solid", builder.ends_at,
              "cable.ends: the node \"" + in_.assembly.nodes[node].name + "\" of the cable \"" +
                  pair.name + "\" has no sphere, and no rod ends there",
              "give the node a sphere, or write `ends: node`");
      }
    };
    const auto ends_here = [&](std::size_t end) {
      return pair.route.empty() || !pair.route[end].is_drum();
    };
    if (ends_here(0)) move(0, 1);
    if (ends_here(last)) move(last, last - 1);
    const Vec3 leg = nodes[last].position_m - nodes[0].position_m;
    const Vec3 left = cable.attachments[last].position_m - cable.attachments[0].position_m;
    if (last == 1 && LengthBetween(nodes[0], nodes[1]) >= kShortestLeg_m && Dot(leg, left) <= 0.0) {
      once_("cable.no_length", pair.at,
            "the solids at the ends of the cable \"" + pair.name +
                "\" overlap, so it has no length between their surfaces",
            "move the nodes apart, or make the solids smaller");
    }
  }

  const CableSurroundings& in_;
  OncePerPlace& once_;
};

}  // namespace

void ShapeCable(const CableSurroundings& in, const PlacedPair& pair, const CableText& builder,
                CableDef& cable, OncePerPlace& complain) {
  CableShaper(in, complain).Run(pair, builder, cable);
}

}  // namespace taut::description
