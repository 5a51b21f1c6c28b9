#include "description/cable_shape.h"

#include "description/follow_route.h"
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

  /// The radius of a node's sphere. In the world there is none and the end stays at the node.
  double SurfaceRadius(int node, const PlacedPair& pair, const CableText& builder) {
    for (const int b : in_.assignment.of_node[node]) {
      if (in_.model.builders[b].sphere) return in_.model.builders[b].sphere->radius_m;
    }
    if (BodyOf(node) != kWorld) {
      once_(builder.ends_at,
            "cable.ends: the node \"" + in_.assembly.nodes[node].name + "\" of the cable \"" +
                pair.name + "\" has no sphere",
            "give the node a sphere, or write `ends: node`");
    }
    return 0.0;
  }

  void MoveEndsToSurface(const PlacedPair& pair, const CableText& builder, CableDef& cable) {
    const std::vector<AttachmentDef> nodes = cable.attachments;
    const std::size_t last = nodes.size() - 1;
    const auto move = [&](std::size_t end, std::size_t next) {
      const Vec3 leg = nodes[next].position_m - nodes[end].position_m;
      const double length = LengthBetween(nodes[end], nodes[next]);
      const double radius = SurfaceRadius(pair.nodes[end], pair, builder);
      if (length < kShortestLeg_m) return radius;
      cable.attachments[end].position_m = nodes[end].position_m + (radius / length) * leg;
      return radius;
    };
    const auto ends_here = [&](std::size_t end) {
      return pair.route.empty() || !pair.route[end].is_drum();
    };
    const double first_radius = ends_here(0) ? move(0, 1) : 0.0;
    const double last_radius = ends_here(last) ? move(last, last - 1) : 0.0;
    if (last == 1 && LengthBetween(nodes[0], nodes[1]) < first_radius + last_radius) {
      once_(pair.at, "the spheres at the ends of the cable \"" + pair.name + "\" overlap",
            "nothing is left for the cable between their surfaces");
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
