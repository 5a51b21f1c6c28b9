/// What the adapters of the engines share.
#pragma once

#include <vector>

#include "benchmarks/peers/peer.h"

namespace taut::peers {

/// A rotation matrix, row major.
struct Rotation {
  double m[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
};
Vec3 operator*(const Rotation& r, const Vec3& x);
Rotation operator*(const Rotation& a, const Rotation& b);
Rotation Transposed(const Rotation& r);
Rotation RotationOf(const Quat& q);
Quat QuatOf(const Rotation& r);
/// Turns z onto the unit vector `axis`.
Rotation RotationFromZ(const Vec3& axis);
/// r diag(moments) r^T.
Inertia Turned(const Rotation& r, const Vec3& moments);

/// A sphere, a capsule or a box, relative to its body's centre of mass in axes parallel to W at the
/// start. What it need not be tested with, mechanics/contact_roles.h says.
struct Shape {
  enum class Kind { kSphere, kCapsule, kBox };
  Kind kind = Kind::kSphere;
  int body = 0;
  Vec3 center_m;
  Rotation turn{};  ///< From the axes of the shape; a capsule lies along z.
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

/// A body as the springs see it.
struct Pose {
  Rotation r;  ///< From the axes of the start to those of now.
  Vec3 p, v, w;
};
struct Load {
  Vec3 force_n, torque_n_m;  ///< About the centre of mass, in W.
};

/// Cables as forces for engines without them (paper eq. 1): T = k (l - L) + b dl/dt while l > L,
/// never negative, otherwise 0.
class Springs {
 public:
  explicit Springs(const ModelDef& def);
  void SetRestLength(int cable, double rest_length_m);
  CableState State(int cable, const std::vector<Pose>& poses) const;
  /// What all cables do to the bodies.
  void Pull(const std::vector<Pose>& poses, std::vector<Load>& loads) const;

 private:
  struct Point {
    int body = kWorld;
    Vec3 p;  ///< Of a body: from its centre of mass, in axes of the start. Of the world: in W.
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

// One file each; nothing if the engine is not there.
std::unique_ptr<World> MakeMujoco(const ModelDef& def, const Options& options);
std::unique_ptr<World> MakeBullet(const ModelDef& def, const Options& options);
std::unique_ptr<World> MakeOde(const ModelDef& def, const Options& options);
std::string MujocoVersion();
std::string BulletVersion();
std::string OdeVersion();

}  // namespace taut::peers
