/// Small structures for the tests of taut/analysis.h
#pragma once

#include <string>

#include "taut/model_def.h"

namespace taut::test {

/// Adds a small body with a node of the same name. Returns the body's index.
inline int AddPoint(ModelDef& def, const std::string& name, const Vec3& at_m, double mass_kg) {
  BodyDef body;
  body.name = name;
  body.mass_kg = mass_kg;
  body.com_m = at_m;
  const double moment = 1e-4 * mass_kg;
  body.inertia_kg_m2 = {moment, moment, moment, 0, 0, 0};
  def.bodies.push_back(body);
  const int index = static_cast<int>(def.bodies.size()) - 1;
  def.nodes.push_back({name, index, at_m});
  return index;
}

/// Adds a cable between two attachments; if there are more, it slides through the inner ones with a
/// single tension.
inline CableDef& AddCable(ModelDef& def, const std::vector<AttachmentDef>& way, double stiffness,
                          double rest_m) {
  CableDef cable;
  cable.name = "cable" + std::to_string(def.cables.size());
  cable.attachments = way;
  cable.stiffness_n_per_m = stiffness;
  cable.rest_length_m = rest_m;
  def.cables.push_back(cable);
  return def.cables.back();
}

inline JointDef& AddJoint(ModelDef& def, JointKind kind, int body_a, const Vec3& from_m, int body_b,
                          const Vec3& to_m, const Vec3& axis = {0, 0, 1}) {
  JointDef joint;
  joint.name = "joint" + std::to_string(def.joints.size());
  joint.kind = kind;
  joint.body_a = body_a, joint.body_b = body_b;
  joint.from_m = from_m, joint.to_m = to_m;
  joint.axis = axis;
  def.joints.push_back(joint);
  return def.joints.back();
}

inline JointDef& AddBar(ModelDef& def, int body_a, const Vec3& from_m, int body_b, const Vec3& to_m,
                        double stiffness, double rest_m) {
  JointDef& bar = AddJoint(def, JointKind::kDistance, body_a, from_m, body_b, to_m);
  bar.stiffness = stiffness;
  bar.rest = rest_m;
  return bar;
}

/// A point in the middle of two horizontal cables of 1 m along x
inline ModelDef Rope(double mass_kg, double stiffness, double rest_m) {
  ModelDef def;
  AddPoint(def, "middle", {0, 0, 0}, mass_kg);
  AddCable(def, {{kWorld, {-1, 0, 0}}, {0, {0, 0, 0}}}, stiffness, rest_m);
  AddCable(def, {{0, {0, 0, 0}}, {kWorld, {1, 0, 0}}}, stiffness, rest_m);
  return def;
}

}  // namespace taut::test
