#include "plant/member_watch.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace taut::plant {
namespace {

Vec3 PlaceOn(const World& world, int lane, int body, const Vec3& arm_m) {
  return body == kWorld ? arm_m : PlaceOf({body, arm_m}, world.Body(lane, body));
}

void TakeLimit(Overload& of, double time_s, double carried_n) {
  if (!(of.bears_n > 0) || !(carried_n > of.bears_n)) return;
  if (of.carried_n == 0) of.first_time_s = time_s;
  of.carried_n = std::max(of.carried_n, carried_n);
}

}  // namespace

MemberWatch::MemberWatch(const ModelDef& def) : joints_(JointsByArms(def)), forces_(def) {
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const CableDef& cable = def.cables[c];
    if (Add(MemberKind::kCable, static_cast<int>(c), cable.name, cable.member, 0)) {
      members_.back().parted = HasFriction(cable);
    }
  }
  for (std::size_t j = 0; j < def.joints.size(); ++j) {
    const JointDef& bar = def.joints[j];
    if (!IsBar(bar)) continue;
    Add(MemberKind::kBar, static_cast<int>(j), bar.name, bar.member, Length(bar.to_m - bar.from_m));
  }
  for (int b = 0; b < static_cast<int>(def.bodies.size()); ++b) {
    const auto strut = mechanics::StrutOf(def, b);
    if (!strut) continue;
    const auto rod = std::find_if(def.capsules.begin(), def.capsules.end(),
                                  [b](const CapsuleDef& c) { return c.body == b; });
    if (Add(MemberKind::kRod, static_cast<int>(struts_.size()),
            def.bodies[static_cast<std::size_t>(b)].name, rod->member,
            Length(rod->to_m - rod->from_m))) {
      struts_.push_back(*strut);
    }
  }
}

bool MemberWatch::Add(MemberKind kind, int index, const std::string& name, const MemberDef& member,
                      double length_m) {
  const MemberLimits bears = LimitsOf(member, kind, length_m);
  if (!bears.strength_n && !bears.yield_n && !bears.buckling_n) return false;
  Watched& watched = members_.emplace_back();
  watched.kind = kind;
  watched.index = index;
  const auto limit = [&](MemberLimit which, const std::optional<double>& bears_n) {
    return Overload{kind, name, which, bears_n.value_or(0), 0, 0};
  };
  watched.limits = {limit(MemberLimit::kStrength, bears.strength_n),
                    limit(MemberLimit::kYield, bears.yield_n),
                    limit(MemberLimit::kBuckling, bears.buckling_n)};
  return true;
}

void MemberWatch::Take(Watched& member, double time_s, double least_n, double greatest_n) {
  TakeLimit(member.limits[0], time_s, greatest_n);
  TakeLimit(member.limits[1], time_s, std::max(-least_n, greatest_n));
  TakeLimit(member.limits[2], time_s, -least_n);
}

void MemberWatch::Take(double time_s, const Observation& exact, const World* world, int lane) {
  const std::vector<BodyForce>* forces = nullptr;
  for (Watched& member : members_) {
    if (member.kind == MemberKind::kCable) {
      double tension_n = exact.Cable(member.index, lane).tension_n;
      if (member.parted && world != nullptr) {
        for (const double span_n : world->CableSpanTensions(lane, member.index)) {
          tension_n = std::max(tension_n, span_n);
        }
      }
      Take(member, time_s, tension_n, tension_n);
      continue;
    }
    if (world == nullptr) return;
    if (member.kind == MemberKind::kBar) {
      const JointDef& bar = joints_[static_cast<std::size_t>(member.index)];
      const Vec3 along = PlaceOn(*world, lane, bar.body_b, bar.to_m) -
                         PlaceOn(*world, lane, bar.body_a, bar.from_m);
      const double length_m = Length(along);
      if (!(length_m > 0)) continue;
      const double tension_n = -Dot(world->Joint(lane, member.index).force_n, along) / length_m;
      Take(member, time_s, tension_n, tension_n);
      continue;
    }
    if (forces == nullptr) forces = &forces_.Gather(exact, *world, lane);
    const mechanics::Strut& strut = struts_[static_cast<std::size_t>(member.index)];
    const AxialForce axial = mechanics::AxialForceOf(strut, world->BodyMass(lane, strut.body),
                                                     MomentOf(*world, strut.body, lane), *forces);
    Take(member, time_s, axial.least_n, axial.greatest_n);
  }
}

std::vector<Overload> MemberWatch::Overloads() const {
  std::vector<Overload> out;
  for (const Watched& member : members_) {
    for (const Overload& limit : member.limits) {
      if (limit.carried_n > 0) out.push_back(limit);
    }
  }
  return out;
}

}  // namespace taut::plant
