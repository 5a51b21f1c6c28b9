// Static equilibrium: checks inputs, searches in up to three ways and returns an `Equilibrium`.
#include <algorithm>
#include <cmath>

#include "analysis/load_share.h"
#include "analysis/minimum.h"
#include "base/brief.h"
#include "base/fixed.h"
#include "math/vec.h"
#include "sim/batch/named_shape.h"
#include "taut/analysis.h"

namespace taut {
namespace analysis {
namespace {

using base::Brief;

std::string Text(const Vec3& a) {
  return "(" + Brief(a.x) + ", " + Brief(a.y) + ", " + Brief(a.z) + ")";
}

/// Returns an error message for options or loads that the model does not allow; empty if all are
/// valid.
std::string WrongWith(const ModelDef& def, const LoadCaseSpec& loads,
                      const EquilibriumOptions& options) {
  const auto outside = [](int index, std::size_t count) {
    return index < 0 || static_cast<std::size_t>(index) >= count;
  };
  for (const auto& force : loads.forces) {
    if (outside(force.node, def.nodes.size()))
      return "the load case has a force on a node that does not exist";
  }
  for (const auto& longer : loads.cables) {
    if (outside(longer.index, def.cables.size()))
      return "the load case lengthens a cable that does not exist";
  }
  for (const auto& longer : loads.bars) {
    if (outside(longer.index, def.joints.size()))
      return "the load case lengthens a bar that does not exist";
    const JointDef& joint = def.joints[static_cast<std::size_t>(longer.index)];
    if (!IsBar(joint))
      return "the load case lengthens joint \"" + joint.name + "\", which is not a bar";
  }
  for (const auto& settled : loads.settlements) {
    if (outside(settled.joint, def.joints.size()))
      return "the load case moves a support that does not exist";
    const JointDef& joint = def.joints[static_cast<std::size_t>(settled.joint)];
    if (!base::IsFixed(def, joint.body_a) && !base::IsFixed(def, joint.body_b)) {
      return "the load case moves joint \"" + joint.name + "\", which is not a support";
    }
  }
  if (!options.from) return "";
  if (options.from->bodies.size() != def.bodies.size() ||
      options.from->rest_lengths_m.size() != def.cables.size()) {
    return "the start pose belongs to another model";
  }
  return "";
}

class Finder {
 public:
  Finder(ModelDef def, const LoadCaseSpec& loads, const EquilibriumOptions& options)
      : def_(std::move(def)),
        loads_(loads),
        options_(options),
        structure_(def_, loads_, options.contact) {
    limits_.tolerance = options.tolerance;
    limits_.most_iterations = options.most_iterations;
  }

  Equilibrium Run() {
    Begin();
    const std::string impossible = Impossible();
    if (impossible.empty()) Find();
    Equilibrium e = Found();
    if (!impossible.empty()) e.why = impossible;
    e.found = e.why.empty();
    return e;
  }

 private:
  void Begin() {
    search_.at = structure_.start;
    search_.holding.rows = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(structure_.rows.size()));
    search_.holding.touches =
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(structure_.touches.size()));
    for (std::size_t b = 0; options_.from && b < structure_.bodies.size(); ++b) {
      const BodyState& body = options_.from->bodies[static_cast<std::size_t>(structure_.bodies[b])];
      search_.at.center_m[b] = body.position_m;
      search_.at.turn[b] = body.orientation;
    }
    Lower();
  }

  /// Lowers an unsupported robot onto the plane. The equilibrium does not depend on the initial
  /// height.
  void Lower() {
    if (structure_.held_by_world || def_.planes.size() != 1 || structure_.touches.empty()) return;
    double least_m = structure_.GapAt(0, search_.at).value;
    for (std::size_t t = 1; t < structure_.touches.size(); ++t) {
      least_m = std::min(least_m, structure_.GapAt(t, search_.at).value);
    }
    if (least_m <= 0) return;
    for (Vec3& center : search_.at.center_m) center = center - least_m * def_.planes[0].normal;
  }

  /// Returns an error message if the resultant of weight and loads cannot be balanced in any pose.
  std::string Impossible() const {
    Vec3 sum;
    double largest = 0;
    const auto add = [&](const Vec3& force) {
      sum = sum + force;
      largest = std::max(largest, std::sqrt(Dot(force, force)));
    };
    for (const Vec3& weight : structure_.weight_n) add(weight);
    for (const Structure::Load& load : structure_.loads) add(load.force_n);
    if (structure_.held_by_world) return "";
    const double least = 1e-9 * largest, size = std::sqrt(Dot(sum, sum));
    if (size <= least) return "";
    const std::string resultant = "weight and loads have the resultant " + Text(sum) + " N, and ";
    if (structure_.touches.empty()) {
      const bool other_ground = !def_.terrain_boxes.empty() || !def_.height_fields.empty() ||
                                !def_.terrain_meshes.empty();
      return resultant + "no support holds the robot in the world" +
             (other_ground ? ": statics supports planes as ground, no other terrain" : "");
    }
    if (def_.planes.size() > 1) return "";
    const Vec3& n = def_.planes[0].normal;
    const double into = -Dot(n, sum);
    if (into <= least) return resultant + "the plane can push only in the opposite direction";
    const Vec3 along = sum + into * n;
    if (std::sqrt(Dot(along, along)) > std::max(least, 1e-9 * into)) {
      return resultant + "no support holds the robot along the plane: statics ignores friction";
    }
    return "";
  }

  void Find() {
    const Search begin = search_;
    Minimise(structure_, limits_, search_);
    if (search_.balanced || search_.runs_away) return;
    const Search first = search_;
    way_ = EquilibriumWay::kLoadSteps;
    search_ = begin;
    InSteps();
    if (search_.balanced) return;
    way_ = EquilibriumWay::kRelaxation;
    const int used = search_.iterations;
    search_ = begin;
    Relax(structure_, kRelaxationSteps, search_);
    search_.iterations = used;
    Again();
    if (search_.balanced) return;
    way_ = EquilibriumWay::kNewton;
    search_ = first;
  }

  /// Runs `Minimise` from the current state, with the full iteration limit in addition to the
  /// iterations already used.
  void Again() {
    SearchLimits limits = limits_;
    limits.most_iterations += search_.iterations;
    Minimise(structure_, limits, search_);
  }

  /// Adds loads, settlements and lengthenings in steps. A failed step is halved.
  void InSteps() {
    double done = 0, by = 0.1;
    Search last = search_;
    while (done < 1 && by > 1e-3) {
      const double share = std::min(1.0, done + by);
      const LoadCaseSpec part = ShareOf(loads_, share);
      const Structure structure(def_, part, options_.contact);
      Search next = last;
      SearchLimits limits = limits_;
      limits.most_iterations += last.iterations;
      Minimise(structure, limits, next);
      last.iterations = next.iterations;
      if (next.balanced) {
        last = next, done = share, by *= 1.5;
      } else {
        by *= 0.5;
      }
    }
    search_ = last;
    search_.balanced = done >= 1;
  }

  Equilibrium Found() {
    Equilibrium e;
    e.left_out = structure_.left_out;
    e.iterations = search_.iterations;
    e.way = way_;
    e.residual_n = search_.left_n;
    for (const BodyDef& body : def_.bodies) e.pose.bodies.push_back({body.com_m, {}, {}, {}});
    for (std::size_t b = 0; b < structure_.bodies.size(); ++b) {
      BodyState& body = e.pose.bodies[static_cast<std::size_t>(structure_.bodies[b])];
      body.position_m = search_.at.center_m[b];
      body.orientation = search_.at.turn[b];
    }
    for (const Structure::Cable& cable : structure_.cables) {
      e.pose.rest_lengths_m.push_back(cable.rest_m);
      e.cable_tension_n.push_back(
          structure_.Tension(cable, cable.path.At(search_.at, false).value));
    }
    AddJoints(e);
    AddContacts(e);
    e.why = search_.balanced ? Entered(e.pose) : Why();
    return e;
  }

  /// Returns an error message if shapes overlap in the equilibrium more than in the described pose.
  /// Such a pose is invalid: statics has contact forces only between bodies and planes.
  std::string Entered(const Pose& pose) const {
    if (!options_.contact) return "";
    constexpr double kDeeper_m = 1e-6;
    const auto overlaps = [](const ModelDef& def) {
      Diagnostics out;
      const auto model = Model::CompileForExperiment(def, out);
      return model == nullptr ? std::vector<Overlap>() : WorldBatch(model, {}).Overlaps(0);
    };
    const std::vector<Overlap> before = overlaps(def_);
    for (const Overlap& now : overlaps(ModelAt(def_, pose))) {
      if (now.b.list == ShapeRef::List::kPlanes) continue;
      double depth = kDeeper_m;
      for (const Overlap& was : before) {
        if (was.body_a == now.body_a && was.body_b == now.body_b) depth += was.depth_m;
      }
      if (now.depth_m <= depth) continue;
      return sim::ShapeText(def_, now.a) + " and " + sim::ShapeText(def_, now.b) + " overlap by " +
             Brief(now.depth_m) + " m in equilibrium: statics supports contact with planes only";
    }
    return "";
  }

  void AddJoints(Equilibrium& e) const {
    for (const PlacedJoint& joint : structure_.joints) {
      double force = 0;
      if (IsBar(joint.def)) {
        force = joint.def.stiffness * (DistanceAt(joint, search_.at).value - joint.def.rest);
      }
      e.bar_force_n.push_back(force);
      e.joint_loads.emplace_back();
      if (joint.def.stiffness > 0) {
        AddLoad(joint, SpringEnergyAt(joint, search_.at), -1, e.joint_loads.back());
      }
    }
    for (std::size_t r = 0; r < structure_.rows.size(); ++r) {
      const std::size_t j = structure_.rows[r].joint;
      AddLoad(structure_.joints[j], structure_.RowAt(r, search_.at),
              -search_.holding.rows[static_cast<Eigen::Index>(r)], e.joint_loads[j]);
    }
  }
  void AddLoad(const PlacedJoint& joint, const Coordinate& c, double force, JointLoad& sum) const {
    const Wrench load = LoadOf(joint, c, force, search_.at);
    sum.force_n = sum.force_n + load.force;
    sum.torque_n_m = sum.torque_n_m + load.torque;
  }

  void AddContacts(Equilibrium& e) const {
    for (std::size_t t = 0; t < structure_.touches.size(); ++t) {
      const double push = search_.holding.touches[static_cast<Eigen::Index>(t)];
      if (push <= 0) continue;
      const Structure::Touch& touch = structure_.touches[t];
      const Vec3 place = PlaceOf(touch.point, search_.at) - touch.radius_m * touch.normal;
      e.contacts.push_back({structure_.bodies[static_cast<std::size_t>(touch.point.body)], kWorld,
                            place, touch.normal, push * touch.normal,
                            structure_.GapAt(t, search_.at).value});
    }
    if (!e.contacts.empty()) {
      e.left_out.emplace_back(
          "friction on the ground: with it, the ground forces would not be unique");
    }
  }

  std::string Why() const {
    if (search_.runs_away)
      return "the robot moves away without limit: no support or cable stops it";
    Eigen::VectorXd gradient;
    structure_.Energy(search_.at, gradient, nullptr);
    structure_.AddReactions(search_.at, search_.holding, gradient, nullptr);
    std::size_t worst = 0;
    double most = -1;
    for (std::size_t b = 0; b < structure_.bodies.size(); ++b) {
      const double left = gradient.segment<3>(6 * static_cast<Eigen::Index>(b)).norm();
      if (left > most) most = left, worst = b;
    }
    std::string text = "no equilibrium was found";
    if (most >= 0) {
      const std::size_t body = static_cast<std::size_t>(structure_.bodies[worst]);
      text += ": after " + std::to_string(search_.iterations) +
              " linear systems the residual force on body \"" + def_.bodies[body].name + "\" is " +
              Brief(most) + " N";
    }
    return text;
  }

  static constexpr int kRelaxationSteps = 4000;
  const ModelDef def_;
  const LoadCaseSpec& loads_;
  const EquilibriumOptions& options_;
  Structure structure_;
  SearchLimits limits_;
  Search search_;
  EquilibriumWay way_ = EquilibriumWay::kNewton;
};

}  // namespace
}  // namespace analysis

Equilibrium FindEquilibrium(const ModelDef& def, const LoadCaseSpec& loads,
                            const EquilibriumOptions& options) {
  Equilibrium refused;
  refused.why = analysis::WrongWith(def, loads, options);
  if (!refused.why.empty()) return refused;
  ModelDef with = def;
  if (options.from) {
    for (std::size_t c = 0; c < with.cables.size(); ++c) {
      with.cables[c].rest_length_m = options.from->rest_lengths_m[c];
    }
  }
  return analysis::Finder(std::move(with), loads, options).Run();
}

ModelDef ModelAt(const ModelDef& def, const Pose& pose) {
  RobotSpec robot;
  robot.def = def;
  return RobotAt(robot, pose).def;
}

}  // namespace taut
