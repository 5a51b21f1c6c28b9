// Statics of structures: `taut.analyze` and `taut.Analysis`.
#include "taut/analysis.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/minimal_experiment.h"
#include "taut/start.h"
#include "text.h"

namespace taut::python {
namespace {

struct Analysis {
  RobotSpec robot;  ///< Robot in the described pose.
  LoadCaseSpec loads;
  Equilibrium at;
  RobotSpec there;  ///< Robot in the equilibrium pose.
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
  said.Error("load_case.unknown", {experiment.files.empty() ? "" : experiment.files[0]},
             "there is no load case \"" + name + "\"",
             names.empty() ? "define `load_cases` in an experiment" : DidYouMean(name, names));
  return {};
}

/// Releases the GIL and computes the analysis.
void Solve(const ExperimentSpec& experiment, Analysis& found) {
  const Released others;
  found.forces = AnalyseForces(experiment.robot.def);
  found.at = FindEquilibrium(experiment.robot.def, found.loads);
  found.there = RobotAt(experiment.robot, found.at.pose);
  LoadCaseSpec there = found.loads;
  there.cables.clear();  // the equilibrium pose already contains the changes of cables
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
    if (!supports.missing.empty())
      said.Error("analysis.supports_missing", file, named + supports.missing, supports.fix);
  }
  Tell(said);
  Solve(experiment, *found);
  Diagnostics after;
  if (!found->move.Warning().empty())
    after.Warning("analysis.large_displacement", file, named + found->move.Warning());
  Tell(after);
  return found;
}

/// Returns the members as (kind, name, part), see docs/python.md.
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

/// Returns an array (motions, bodies, 3) with the data member `of` of each motion.
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

/// Returns an array (states, members) with the data member `of` of each state of self-stress.
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
      "found", [](const Analysis& a) { return a.at.found; }, "Whether an equilibrium was found.");
  type.def_property_readonly(
      "why", [](const Analysis& a) { return a.at.why; },
      "Reason if no equilibrium was found; otherwise empty.");
  type.def_property_readonly("load_case", [](const Analysis& a) { return a.loads.name; });
  type.def_property_readonly(
      "left_out", [](const Analysis& a) { return a.at.left_out; },
      "Parts of the model that the analysis ignores, in words.");
  type.def_property_readonly(
      "robot", [](const Analysis& a) { return WithoutExperiment(a.there); },
      "The `Robot` in its equilibrium pose.");
  type.def_property_readonly(
      "body_position_m",
      [](const Analysis& a) {
        std::vector<Vec3> all;
        for (const BodyState& b : a.at.pose.bodies) all.push_back(b.position_m);
        return ArrayOf(all);
      },
      "(bodies, 3) float64: positions of the centers of mass in W, in equilibrium [m].");
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
      "(bodies, 4) float64: rotations from the described pose to equilibrium, as unit quaternions "
      "w, x, y, z, in W.");
  type.def_property_readonly(
      "tension_n", [](const Analysis& a) { return ArrayOf(a.at.cable_tension_n); },
      "(cables,) float64: tensions [N]; of a cable with friction, the tension of its first span.");
  type.def_property_readonly(
      "bar_force_n", [](const Analysis& a) { return ArrayOf(a.at.bar_force_n); },
      "(joints,) float64: axial forces of bars, tension > 0 [N]; 0 for other joints.");
  type.def_property_readonly(
      "joint_force_n",
      [](const Analysis& a) {
        std::vector<Vec3> all;
        for (const JointLoad& load : a.at.joint_loads) all.push_back(load.force_n);
        return ArrayOf(all);
      },
      "(joints, 3) float64: forces on the second body of each joint, in W [N]; for a support, the "
      "force that holds the robot.");
  type.def_property_readonly(
      "joint_torque_n_m",
      [](const Analysis& a) {
        std::vector<Vec3> all;
        for (const JointLoad& load : a.at.joint_loads) all.push_back(load.torque_n_m);
        return ArrayOf(all);
      },
      "(joints, 3) float64: torques on the second body, about the joint's point on it, in W [N "
      "m].");
  type.def_property_readonly(
      "contacts", [](const Analysis& a) { return ContactsOf(a.at.contacts); },
      "Contacts that carry load, as a dict in the form of `Batch.contacts`; normal forces "
      "only.");
  type.def_property_readonly(
      "residual_n", [](const Analysis& a) { return a.at.residual_n; },
      "Largest residual force on a body [N].");
  type.def_property_readonly(
      "largest_move_m", [](const Analysis& a) { return a.move.distance_m; },
      "Largest displacement of a node or a center of mass, `largest_move_of`, from the described "
      "pose to equilibrium [m]. Without supports, the best-fitting rigid motion is subtracted.");
  type.def_property_readonly("largest_move_of", [](const Analysis& a) { return a.move.name; });
  type.def_property_readonly(
      "least_stiffness_n_per_m", [](const Analysis& a) { return a.least_stiffness_n_per_m; },
      "Least stiffness: smallest u^T K u divided by the sum of the squared displacements of all "
      "points, over all free motions u except rigid motions [N/m]. Negative: unstable. None "
      "without equilibrium or without such a motion.");
  type.def_property_readonly(
      "stiffness", [](const Analysis& a) { return ArrayOf(a.tangent.stiffness); },
      "(6 * moving, 6 * moving) float64: tangent stiffness matrix in equilibrium, the negative "
      "derivative of the forces; per moving body x, y, z of the center of mass and rotations about "
      "W's axes [N/m, N, N m/rad].");
  type.def_property_readonly(
      "mass", [](const Analysis& a) { return ArrayOf(a.tangent.mass); },
      "Mass matrix, in the order of `stiffness` [kg, kg m, kg m^2].");
  type.def_property_readonly(
      "moving_bodies", [](const Analysis& a) { return a.tangent.bodies; },
      "Indices of the bodies in `stiffness` and `mass`.");
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
      "(modes,) float64: natural frequencies of small undamped vibrations about the equilibrium "
      "[Hz]; 0 for rigid motions and mechanisms, negative for unstable modes. Rigid motions first, "
      "then ascending.");
  type.def_property_readonly(
      "mode_kinds",
      [=](const Analysis& a) {
        py::list kinds;
        for (const Mode& mode : modes(a)) kinds.append(NameOf(mode.kind));
        return kinds;
      },
      "Kind of each mode: \"rigid\", \"mechanism\", \"elastic\" or \"unstable\".");
  type.def_property_readonly(
      "mode_translation_m",
      [=](const Analysis& a) {
        return MotionsOf(modes(a), a.robot.def.bodies.size(), &Mode::translation_m);
      },
      "(modes, bodies, 3) float64: translations of the mode shapes [m]. The largest displacement "
      "of a mode is 1 m; rotations count as angle times the body's reach.");
  type.def_property_readonly(
      "mode_turn_rad",
      [=](const Analysis& a) {
        return MotionsOf(modes(a), a.robot.def.bodies.size(), &Mode::turn_rad);
      },
      "(modes, bodies, 3) float64: rotations of the mode shapes, at the same scale [rad].");
}

void AddForces(Type& type) {
  type.def_property_readonly(
      "members", &MembersOf,
      "Members in the described pose, as (kind, name, part): \"cable\" with its span, \"bar\", "
      "\"joint\" with one of its directions, \"ground\" with the body.");
  type.def_property_readonly(
      "member_force_n",
      [](const Analysis& a) {
        std::vector<double> all;
        for (const StaticMember& member : a.forces.members) all.push_back(member.force_n);
        return ArrayOf(all);
      },
      "(members,) float64: member forces in the described pose, not in equilibrium [N, N m].");
  type.def_property_readonly(
      "equilibrium_matrix", [](const Analysis& a) { return ArrayOf(a.forces.matrix); },
      "(motions, members) float64: equilibrium matrix, which maps member forces to loads; its "
      "transpose maps motions to elongations of members [1, m].");
  type.def_property_readonly(
      "rank", [](const Analysis& a) { return a.forces.rank.rank; },
      "Rank of `equilibrium_matrix`.");
  type.def_property_readonly(
      "rigid", [](const Analysis& a) { return a.forces.rigid; },
      "Number of rigid motions that no member resists. Motions of an anchored point count as "
      "mechanisms.");
  type.def_property_readonly(
      "self_stress_n", [](const Analysis& a) { return StatesOf(a.forces, &SelfStress::force_n); },
      "(states, members) float64: independent states of self-stress, member forces in equilibrium "
      "without loads; tension > 0 [N, N m]. The first is feasible if a feasible one exists.");
  type.def_property_readonly(
      "self_stress_density_n_per_m",
      [](const Analysis& a) { return StatesOf(a.forces, &SelfStress::density_n_per_m); },
      "(states, members) float64: force densities of cables and bars, force over length [N/m]; 0 "
      "for other members.");
  type.def_property_readonly(
      "self_stress_feasible",
      [](const Analysis& a) {
        py::array_t<bool> all(static_cast<py::ssize_t>(a.forces.self_stress.size()));
        bool* to = all.mutable_data();
        for (const SelfStress& state : a.forces.self_stress) *to++ = state.feasible;
        return all;
      },
      "(states,) bool: whether all cables are in tension and no contact pulls.");
  type.def_property_readonly(
      "mechanism_translation_m",
      [](const Analysis& a) {
        return MotionsOf(a.forces.mechanisms, a.robot.def.bodies.size(), &Mode::translation_m);
      },
      "(mechanisms, bodies, 3) float64: translations of the infinitesimal mechanisms, motions that "
      "change no member's length, without rigid motions [m]; scaled as mode shapes.");
  type.def_property_readonly(
      "mechanism_turn_rad",
      [](const Analysis& a) {
        return MotionsOf(a.forces.mechanisms, a.robot.def.bodies.size(), &Mode::turn_rad);
      },
      "(mechanisms, bodies, 3) float64: rotations of the mechanisms, at the same scale [rad].");
  type.def_property_readonly(
      "mechanism_stiffness_n_per_m",
      [](const Analysis& a) { return ArrayOf(a.forces.mechanism_stiffness); },
      "(mechanisms,) float64: stiffness of the mechanisms under the first feasible self-stress, "
      "ascending [N/m]; all positive: prestress stability. Empty without a feasible state.");
}

}  // namespace

void AddAnalyses(py::module_& module) {
  Type type(module, "Analysis",
            "Result of `taut.analyze`: equilibrium under a load case with its modes; self-stresses "
            "and mechanisms of the described pose.");
  AddEquilibrium(type);
  AddModes(type);
  AddForces(type);
  type.def("__repr__", [](const Analysis& a) {
    return "<taut.Analysis \"" + a.robot.def.name + "\" under " + a.loads.name +
           (a.at.found ? ">" : ": no equilibrium>");
  });
  const char* const words =
      "Analyzes the statics of a structure, as `taut analyze` does: equilibrium, least stiffness, "
      "modes, self-stresses, mechanisms. `load_case`: name of one of the experiment's "
      "`load_cases`; None: the robot's weight, or no load if nothing holds the robot in the world. "
      "Returns a `taut.Analysis`. Other Python threads run meanwhile.";
  module.def("analyze", &Analyse, py::arg("experiment"), py::arg("load_case") = py::none(), words);
  module.def(
      "analyze",
      [](const RobotSpec& robot) { return Analyse(MinimalExperiment(robot), std::nullopt); },
      py::arg("robot"), words);
}

}  // namespace taut::python
