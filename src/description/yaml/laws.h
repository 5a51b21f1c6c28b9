/// Laws and enumerations that model files contain and experiments may override.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "taut/model_def.h"

namespace taut::description {

template <class E>
using Choices = std::vector<std::pair<std::string, E>>;

inline const Choices<CombineRule> kCombineRules{{"product", CombineRule::kProduct},
                                                {"geometric_mean", CombineRule::kGeometricMean},
                                                {"minimum", CombineRule::kMinimum},
                                                {"maximum", CombineRule::kMaximum}};
inline const Choices<FrictionLaw> kFrictionLaws{{"cone", FrictionLaw::kCone},
                                                {"along_slip", FrictionLaw::kAlongSlip}};
inline const Choices<DampingLaw> kDampingLaws{{"exact", DampingLaw::kExact},
                                              {"clamped", DampingLaw::kClamped}};
/// Method to compute the inertia of a body.
enum class InertiaLaw {
  kExact,        ///< Sum of the inertias of the parts.
  kBoundingBox,  ///< Solid box with the body's size and mass, like Bullet's compound shapes.
};
inline const Choices<InertiaLaw> kInertiaLaws{{"exact", InertiaLaw::kExact},
                                              {"bounding_box", InertiaLaw::kBoundingBox}};
inline const Choices<ActuatorDef::Kind> kActuatorKinds{{"none", ActuatorDef::Kind::kNone},
                                                       {"ideal", ActuatorDef::Kind::kIdeal},
                                                       {"limited", ActuatorDef::Kind::kLimited},
                                                       {"dc_motor", ActuatorDef::Kind::kDcMotor}};
inline const Choices<JointKind> kJointKinds = [] {
  Choices<JointKind> kinds;
  for (const JointKindRow& row : kJointKindRows) {
    kinds.emplace_back(row.name, static_cast<JointKind>(kinds.size()));
  }
  return kinds;
}();
inline const Choices<CableTouches> kCableTouches{{"none", CableTouches::kNone},
                                                 {"terrain", CableTouches::kTerrain},
                                                 {"rods", CableTouches::kRods},
                                                 {"all", CableTouches::kAll}};
inline const Choices<MemberMass> kMemberMasses{{"lumped", MemberMass::kLumped},
                                               {"consistent", MemberMass::kConsistent}};
inline const Choices<bool> kSides{{"left", true}, {"right", false}};
inline const Choices<bool> kCableEnds{{"node", false}, {"surface", true}};

}  // namespace taut::description
