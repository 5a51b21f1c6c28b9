/// Watch over the forces of members against their limits, step by step.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "plant/body_forces.h"
#include "taut/plant.h"
#include "taut/safety.h"

namespace taut::plant {

/// Looks only at members with a limit, so robots without any pay nothing.
class MemberWatch {
 public:
  explicit MemberWatch(const ModelDef& def);

  /// Whether no member has a limit.
  bool empty() const noexcept { return members_.empty(); }

  /// Takes a moment of a lane in. Bars and rods need `world`; without one, only cables are looked
  /// at. Forces are as sensors read them: those of stiff cables, bars and contacts are means over
  /// the last step.
  void Take(double time_s, const Observation& exact, const World* world, int lane = 0);

  /// Cables first, then bars, then rods.
  std::vector<Overload> Overloads() const;

 private:
  struct Watched {
    MemberKind kind = MemberKind::kCable;
    int index = 0;        ///< The cable, the joint or the place in `struts_`.
    bool parted = false;  ///< A cable of several tensions.
    std::array<Overload, 3> limits;
  };
  /// False if it has no limit.
  bool Add(MemberKind kind, int index, const std::string& name, const MemberDef& member,
           double length_m);
  static void Take(Watched& member, double time_s, double least_n, double greatest_n);

  std::vector<Watched> members_;
  std::vector<JointDef> joints_;  ///< By arms.
  std::vector<mechanics::Strut> struts_;
  BodyForces forces_;
};

}  // namespace taut::plant
