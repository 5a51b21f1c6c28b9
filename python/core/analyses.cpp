// What holds a structure up.
#include "taut/analysis.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/alone.h"
#include "taut/start.h"
#include "text.h"

namespace taut::python {
namespace {

struct Analysis {
  RobotSpec robot;  ///< As described.
  LoadCaseSpec loads;
  Equilibrium at;
  RobotSpec there;  ///< As it stands.
  std::optional<Modes> modes;
  std::optional<double> least_stiffness_n_per_m;
  Move move;
  Tangent tangent;
  ForceAnalysis forces;
};

LoadCaseSpec CaseOf(const ExperimentSpec& experiment, const std::string& name, Diagnostics& said) {
  for (const LoadCaseSpec& one : experiment.load_cases) {
    if (one.name == name) return one;
  }
  const std::vector<std::string> names = NamesOf(experiment.load_cases);
  said.Error({experiment.files.empty() ? "" : experiment.files[0]},
             "there is no load case \"" + name + "\"",
             names.empty() ? "load_cases of an experiment" : DidYouMean(name, names));
  return {};
}

/// Needs no GIL and lets it go.
void Solve(const ExperimentSpec& experiment, Analysis& found) {
  const Released others;
  found.forces = AnalyseForces(experiment.robot.def);
  found.at = FindEquilibrium(experiment.robot.def, found.loads);
  found.there = RobotAt(experiment.robot, found.at.pose);
  LoadCaseSpec there = found.loads;
  there.cables.clear();  // the pose has these rest lengths
  found.tangent = FindTangent(found.there.def, there);
  if (!found.at.found) return;
  found.modes = FindModes(found.there.def, there);
  found.least_stiffness_n_per_m = LeastStiffness(found.there.def, there);
  found.move = LargestMove(experiment.robot.def, found.at.pose);
}

std::shared_ptr<Analysis> Analyse(const ExperimentSpec& experiment,
                                  const std::optional<std::string>& load_case) {
  Diagnostics said;
  auto found = std::make_shared<Analysis>();
  found->robot = experiment.robot;
  found->loads = load_case ? CaseOf(experiment, *load_case, said) : OwnWeight(experiment.robot.def);
  if (said.ok()) CheckStart(experiment.robot, StartKind::kSettled, said);
  const SourceRef file{experiment.files.empty() ? "" : experiment.files[0]};
  const std::string named = "load case " + found->loads.name + ": ";
  if (said.ok()) {
    const SupportCheck supports = CheckSupports(experiment.robot.def, found->loads);
    if (!supports.missing.empty()) said.Error(file, named + supports.missing, supports.fix);
  }
  Tell(said);
  Solve(experiment, *found);
  Diagnostics after;
  if (!found->move.Warning().empty()) after.Warning(file, named + found->move.Warning());
  Tell(after);
  return found;
}

/// (kind, name, part), as docs/python.md has it.
py::list MembersOf(const Analysis& a) {
  const ModelDef& def = a.robot.def;
  py::list members;
  for (const StaticMember& member : a.forces.members) {
    const auto i = static_cast<std::size_t>(member.index);
    const bool joint =
        member.kind == StaticMember::Kind::kBar || member.kind == StaticMember::Kind::kHeld;
    const std::string& name = joint                                       ? def.joints[i].name
                              : member.kind == StaticMember::Kind::kCable ? def.cables[i].name
                                                                          : def.planes[i].name;
    members.append(py::make_tuple(NameOf(member.kind), name,
                                  member.kind == StaticMember::Kind::kBar ? 0 : member.part));
  }
  return members;
}

/// A row a motion, of what `of` takes from it: (motions, bodies, 3).
Rows<double> MotionsOf(const std::vector<Mode>& modes, std::size_t bodies,
                       std::vector<Vec3> Mode::*of) {
  Rows<double> a(
      {static_cast<py::ssize_t>(modes.size()), static_cast<py::ssize_t>(bodies), py::ssize_t{3}});
  double* to = a.mutable_data();
  for (const Mode& mode : modes) {
    for (const Vec3& v : mode.*of) Put(v, to), to += 3;
  }
  return a;
}

/// A row a state of self-stress: (states, members).
Rows<double> StatesOf(const ForceAnalysis& forces, std::vector<double> SelfStress::*of) {
  Rows<double> a({static_cast<py::ssize_t>(forces.self_stress.size()),
                  static_cast<py::ssize_t>(forces.members.size())});
  double* to = a.mutable_data();
  for (const SelfStress& state : forces.self_stress) {
    to = std::copy((state.*of).begin(), (state.*of).end(), to);
  }
  return a;
}

using Type = py::class_<Analysis, std::shared_ptr<Analysis>>;

void AddEquilibrium(Type& type) {
  type.def_property_readonly(
      "found", [](const Analysis& a) { return a.at.found; }, "Whether there is an equilibrium.");
  type.def_property_readonly(
      "why", [](const Analysis& a) { return a.at.why; }, "If there is none; else empty.");
  type.def_property_readonly("load_case", [](const Analysis& a) { return a.loads.name; });
  type.def_property_readonly(
      "left_out", [](const Analysis& a) { return a.at.left_out; },
      "What of the model takes no part, in words.");
  type.def_property_readonly(
      "robot", [](const Analysis& a) { return std::make_shared<RobotSpec>(a.there); },
      "The `Robot` as it stands in equilibrium.");
  type.def_property_readonly(
      "body_position_m",
      [](const Analysis& a) {
        std::vector<Vec3> all;
        for (const BodyState& b : a.at.pose.bodies) all.push_back(b.position_m);
        return ArrayOf(all);
      },
      "(bodies, 3) float64: of the centres of mass, in W [m].");
  type.def_property_readonly(
      "body_orientation",
      [](const Analysis& a) {
        Rows<double> all({static_cast<py::ssize_t>(a.at.pose.bodies.size()), py::ssize_t{4}});
        double* to = all.mutable_data();
        for (const BodyState& b : a.at.pose.bodies) {
          const Quat& q = b.orientation;
          for (const double x : {q.w, q.x, q.y, q.z}) *to++ = x;
        }
        return all;
      },
      "(bodies, 4) float64: w, x, y, z from the orientation as described, in W.");
  type.def_property_readonly(
      "tension_n", [](const Analysis& a) { return ArrayOf(a.at.cable_tension_n); },
      "(cables,) float64 [N]; of one that friction parts, of its first span.");
  type.def_property_readonly(
      "bar_force_n", [](const Analysis& a) { return ArrayOf(a.at.bar_force_n); },
      "(joints,) float64: tension > 0; 0 of joints that are no bars [N].");
  type.def_property_readonly(
      "joint_force_n",
      [](const Analysis& a) {
        std::vector<Vec3> all;
        for (const JointLoad& load : a.at.joint_loads) all.push_back(load.force_n);
        return ArrayOf(all);
      },
      "(joints, 3) float64: on a joint's second body, in W; of a support what holds the robot "
      "[N].");
  type.def_property_readonly(
      "joint_torque_n_m",
      [](const Analysis& a) {
        std::vector<Vec3> all;
        for (const JointLoad& load : a.at.joint_loads) all.push_back(load.torque_n_m);
        return ArrayOf(all);
      },
      "(joints, 3) float64: about the joint's point on that body [N m].");
  type.def_property_readonly(
      "contacts", [](const Analysis& a) { return ContactsOf(a.at.contacts); },
      "What bears on the ground, as of `Batch.contacts`; normal forces alone.");
  type.def_property_readonly(
      "residual_n", [](const Analysis& a) { return a.at.residual_n; },
      "The largest force that is left on a body [N].");
  type.def_property_readonly(
      "largest_move_m", [](const Analysis& a) { return a.move.distance_m; },
      "The largest distance between a node or a center of mass as described and in equilibrium, of "
      "`largest_move_of` [m]; without the rigid motion that fits best where nothing holds the "
      "robot "
      "in the world.");
  type.def_property_readonly("largest_move_of", [](const Analysis& a) { return a.move.name; });
  type.def_property_readonly(
      "least_stiffness_n_per_m", [](const Analysis& a) { return a.least_stiffness_n_per_m; },
      "The smallest u^T K u over the sum of the squared displacements of all points, over all "
      "free motions u "
      "except rigid motions [N/m]; negative: unstable. None without equilibrium "
      "or such a motion.");
  type.def_property_readonly(
      "stiffness", [](const Analysis& a) { return ArrayOf(a.tangent.stiffness); },
      "(6 * moving, 6 * moving) float64: minus the derivative of the forces there, by x, y, z of "
      "the "
      "centre of mass and turns about W's axes, body by body of those that move [N/m, N, N "
      "m/rad].");
  type.def_property_readonly(
      "mass", [](const Analysis& a) { return ArrayOf(a.tangent.mass); },
      "Of the same shape and order [kg, kg m, kg m^2].");
  type.def_property_readonly(
      "moving_bodies", [](const Analysis& a) { return a.tangent.bodies; },
      "Numbers of the bodies that `stiffness` and `mass` are of.");
}

void AddModes(Type& type) {
  static const std::vector<Mode> kNone;
  const auto modes = [](const Analysis& a) -> const std::vector<Mode>& {
    return a.modes ? a.modes->modes : kNone;
  };
  type.def_property_readonly(
      "mode_frequency_hz",
      [=](const Analysis& a) {
        std::vector<double> all;
        for (const Mode& mode : modes(a)) all.push_back(mode.frequency_hz);
        return ArrayOf(all);
      },
      "(modes,) float64: of small undamped vibrations about the equilibrium [Hz]; 0 of rigid ones "
      "and mechanisms, less than 0 of unstable ones. Rigid ones first, then rising.");
  type.def_property_readonly(
      "mode_kinds",
      [=](const Analysis& a) {
        py::list kinds;
        for (const Mode& mode : modes(a)) kinds.append(NameOf(mode.kind));
        return kinds;
      },
      "\"rigid\", \"mechanism\", \"elastic\" or \"unstable\", by mode.");
  type.def_property_readonly(
      "mode_translation_m",
      [=](const Analysis& a) {
        return MotionsOf(modes(a), a.robot.def.bodies.size(), &Mode::translation_m);
      },
      "(modes, bodies, 3) float64: scaled so that the largest of a mode is 1 m; a turn by a body's "
      "reach counts as one.");
  type.def_property_readonly(
      "mode_turn_rad",
      [=](const Analysis& a) {
        return MotionsOf(modes(a), a.robot.def.bodies.size(), &Mode::turn_rad);
      },
      "(modes, bodies, 3) float64, to the same scale.");
}

void AddForces(Type& type) {
  type.def_property_readonly("members", &MembersOf,
                             "(kind, name, part) of all that can carry a force, as described: "
                             "\"cable\" and its span, \"bar\", \"joint\" and which of its "
                             "directions, \"ground\" and the body.");
  type.def_property_readonly(
      "member_force_n",
      [](const Analysis& a) {
        std::vector<double> all;
        for (const StaticMember& member : a.forces.members) all.push_back(member.force_n);
        return ArrayOf(all);
      },
      "(members,) float64: as described, not in equilibrium [N], [N m].");
  type.def_property_readonly(
      "equilibrium_matrix", [](const Analysis& a) { return ArrayOf(a.forces.matrix); },
      "(motions, members) float64: times forces gives loads; its transpose says how fast members "
      "get "
      "longer [1], [m].");
  type.def_property_readonly(
      "rank", [](const Analysis& a) { return a.forces.rank.rank; }, "Of `equilibrium_matrix`.");
  type.def_property_readonly(
      "rigid", [](const Analysis& a) { return a.forces.rigid; },
      "Number of rigid motions that no member resists; motions of an anchored point are "
      "mechanisms.");
  type.def_property_readonly(
      "self_stress_n", [](const Analysis& a) { return StatesOf(a.forces, &SelfStress::force_n); },
      "(states, members) float64: independent forces that members have among themselves without "
      "loads; tension > 0. A feasible one first, if there is any.");
  type.def_property_readonly(
      "self_stress_density_n_per_m",
      [](const Analysis& a) { return StatesOf(a.forces, &SelfStress::density_n_per_m); },
      "(states, members) float64: by length, of cables and bars; else 0.");
  type.def_property_readonly(
      "self_stress_feasible",
      [](const Analysis& a) {
        py::array_t<bool> all(static_cast<py::ssize_t>(a.forces.self_stress.size()));
        bool* to = all.mutable_data();
        for (const SelfStress& state : a.forces.self_stress) *to++ = state.feasible;
        return all;
      },
      "(states,) bool: all cables in tension, no contact that pulls.");
  type.def_property_readonly(
      "mechanism_translation_m",
      [](const Analysis& a) {
        return MotionsOf(a.forces.mechanisms, a.robot.def.bodies.size(), &Mode::translation_m);
      },
      "(mechanisms, bodies, 3) float64: ways to move without any member changing its length, but "
      "as "
      "a whole; scaled like modes.");
  type.def_property_readonly(
      "mechanism_turn_rad",
      [](const Analysis& a) {
        return MotionsOf(a.forces.mechanisms, a.robot.def.bodies.size(), &Mode::turn_rad);
      },
      "(mechanisms, bodies, 3) float64.");
  type.def_property_readonly(
      "mechanism_stiffness_n_per_m",
      [](const Analysis& a) { return ArrayOf(a.forces.mechanism_stiffness); },
      "(mechanisms,) float64: what the first feasible self-stress gives them to resist with, "
      "rising; "
      "all positive: stable by prestress. Empty without a feasible state.");
}

}  // namespace

void AddAnalyses(py::module_& module) {
  Type type(
      module, "Analysis",
      "What `taut.analyze` gives: where a robot stands under a load, how it swings there, what "
      "its members can carry by themselves as described.");
  AddEquilibrium(type);
  AddModes(type);
  AddForces(type);
  type.def("__repr__", [](const Analysis& a) {
    return "<taut.Analysis \"" + a.robot.def.name + "\" under " + a.loads.name +
           (a.at.found ? ">" : ": no equilibrium>");
  });
  const char* const words =
      "The statics of a structure, as `taut analyze` computes them. `load_case`: a name of the "
      "experiment's `load_cases`; None: the robot's weight, or no load if nothing holds the robot "
      "in the world. Other Python threads run meanwhile.";
  module.def("analyze", &Analyse, py::arg("experiment"), py::arg("load_case") = py::none(), words);
  module.def(
      "analyze",
      [](const RobotSpec& robot) { return Analyse(ExperimentWith(robot), std::nullopt); },
      py::arg("robot"), words);
}

}  // namespace taut::python
