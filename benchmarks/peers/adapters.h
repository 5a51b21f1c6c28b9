/// Shared parts of the adapters to other physics engines.
#pragma once

#include <vector>

#include "benchmarks/peers/peer.h"

namespace taut::peers {

/// Rotation matrix, row major.
struct Rotation {
  double m[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
};
Vec3 operator*(const Rotation& r, const Vec3& x);
Rotation operator*(const Rotation& a, const Rotation& b);
Rotation Transposed(const Rotation& r);
Rotation RotationOf(const Quat& q);
Quat QuatOf(const Rotation& r);
/// Returns a rotation that maps z to the unit vector `axis`.
Rotation RotationFromZ(const Vec3& axis);
/// Returns r diag(moments) r^T.
Inertia Turned(const Rotation& r, const Vec3& moments);

/// Sphere, capsule or box, relative to its body's center of mass in axes parallel to W at the
/// start. mechanics/contact_roles.h defines the pairs that need no test.
struct Shape {
  enum class Kind { kSphere, kCapsule, kBox };
  Kind kind = Kind::kSphere;
  int body = 0;
  Vec3 center_m;
  Rotation turn{};  ///< Rotation from the shape's axes to the body's; a capsule lies along z.
  double half_length_m = 0, radius_m = 0;
  Vec3 half_extents_m{};
  bool meets_planes = true, meets_bodies = true;
};
std::vector<Shape> ShapesOf(const ModelDef& def);

/// Coefficients of contact. All shapes of a supported model have the same material.
struct Contact {
  double friction = 0, restitution = 0;
};
Contact BetweenBodies(const ModelDef& def);
Contact WithGround(const ModelDef& def, const Material& ground);

/// Pose and velocities of a body, for the springs.
struct Pose {
  Rotation r;  ///< From the axes at the start to the present axes.
  Vec3 p, v, w;
};
struct Load {
  Vec3 force_n, torque_n_m;  ///< About the center of mass, in W.
};

/// Cables as forces for engines without them (paper eq. 1): T = k (l - L) + b dl/dt while l > L,
/// never negative, otherwise 0.
class Springs {
 public:
  explicit Springs(const ModelDef& def);
  void SetRestLength(int cable, double rest_length_m);
  CableState State(int cable, const std::vector<Pose>& poses) const;
  /// Computes the loads of all cables on the bodies.
  void Pull(const std::vector<Pose>& poses, std::vector<Load>& loads) const;

 private:
  struct Point {
    int body = kWorld;
    Vec3 p;  ///< For bodies: from the center of mass, in axes of the start. For the world: in W.
  };
  struct Cable {
    int first = 0, count = 0;
    double k = 0, b = 0, rest_m = 0;
  };
  struct Place {
    Vec3 arm, p, v;
  };
  static Place Where(const Point& point, const std::vector<Pose>& poses);
  CableState Measure(const Cable& cable, const std::vector<Pose>& poses) const;
  std::vector<Cable> cables_;
  std::vector<Point> points_;
};

// Each is defined in a separate file and returns null if the engine is not built in.
std::unique_ptr<World> MakeMujoco(const ModelDef& def, const Options& options);
std::unique_ptr<World> MakeBullet(const ModelDef& def, const Options& options);
std::unique_ptr<World> MakeOde(const ModelDef& def, const Options& options);
std::string MujocoVersion();
std::string BulletVersion();
std::string OdeVersion();

}  // namespace taut::peers
