/// Overload detection: compares member forces with their limits at every step.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "plant/body_forces.h"
#include "taut/plant.h"
#include "taut/safety.h"

namespace taut::plant {

/// Checks only members with a limit, so it has no cost without limits.
class MemberWatch {
 public:
  explicit MemberWatch(const ModelDef& def);

  /// Returns whether no member has a limit.
  bool empty() const noexcept { return members_.empty(); }

  /// Checks the current state of a lane. Without `world`, checks cables only. Forces are sensor
  /// values; for stiff cables, bars and contacts, these are means over the last step.
  void Take(double time_s, const Observation& exact, const World* world, int lane = 0);

  /// Returns the overloads of cables, bars and rods, in this order.
  std::vector<Overload> Overloads() const;

 private:
  struct Watched {
    MemberKind kind = MemberKind::kCable;
    int index = 0;        ///< Index of the cable or joint, or index into `struts_`.
    bool parted = false;  ///< Whether it is a cable with several spans (because of friction).
    std::array<Overload, 3> limits;
  };
  /// Adds a member. Returns false if it has no limit.
  bool Add(MemberKind kind, int index, const std::string& name, const MemberDef& member,
           double length_m);
  static void Take(Watched& member, double time_s, double least_n, double greatest_n);

  std::vector<Watched> members_;
  std::vector<JointDef> joints_;  ///< Result of `JointsByArms`.
  std::vector<mechanics::Strut> struts_;
  BodyForces forces_;
};

}  // namespace taut::plant
