/// Keys of experiment files except controllers, with the subset that resolved experiments contain.
#pragma once

#include "description/experiment/control_keys.h"
#include "description/experiment/environment_keys.h"
#include "description/experiment/experiment_text.h"
#include "description/experiment/load_keys.h"
#include "description/experiment/sensor_keys.h"
#include "description/model/model_keys.h"
#include "taut/time_limits.h"

namespace taut::description {

inline const Choices<StartKind> kStarts{{"as_described", StartKind::kAsDescribed},
                                        {"settled", StartKind::kSettled},
                                        {"settled_floating", StartKind::kSettledFloating}};
inline const Choices<ScaleSpec::Quantity> kScaledQuantities{
    {"friction", ScaleSpec::Quantity::kFriction},
    {"mass", ScaleSpec::Quantity::kMass},
    {"stiffness", ScaleSpec::Quantity::kStiffness},
    {"damping", ScaleSpec::Quantity::kDamping}};
inline const Choices<ReferenceSpec::Quantity> kReferenceQuantities{
    {"tension", ReferenceSpec::Quantity::kTension}, {"elastic", ReferenceSpec::Quantity::kElastic}};
inline const Choices<ReferenceSpec::Statistic> kReferenceStatistics{
    {"max", ReferenceSpec::Statistic::kMax},
    {"mean", ReferenceSpec::Statistic::kMean},
    {"min", ReferenceSpec::Statistic::kMin}};

inline const Choices<GoalFrame> kGoalFrames{{"body", GoalFrame::kOfBody},
                                            {"world", GoalFrame::kOfWorld}};

template <class Io, Either<PlaneDef, PlaneText> Plane>
void Keys(Io& io, Plane& p) {
  io.Map("plane", "terrain.plane",
         "Half space, solid below its surface. One of `height_m`, `normal` and `slope_rad` defines "
         "the surface.");
  io("name", p.name, kResolvedOnly);
  if constexpr (!Io::kResolved) {
    io.OneOf({"height_m", "normal", "slope_rad"});
    io.Rule(R"("dependentRequired": {"slope_rad": ["slope_direction"], )"
            R"("slope_direction": ["slope_rad"]})");
    io.Rule(R"("not": {"required": ["height_m", "point_m"]})");
    io("height_m", p.height_m, "Height of a horizontal surface.");
  }
  io("normal", p.normal, kDirection, kInherited, "Surface normal, out of the solid.");
  if constexpr (!Io::kResolved) {
    io("slope_rad", p.slope_rad,
       Bound{.least = 0.0,
             .most = 0.5 * 3.14159265358979323846,
             .below_most = true,
             .most_text = "pi / 2",
             .hint = "give a `normal` instead"},
       "Angle between the surface and the horizontal.");
    io("slope_direction", p.slope_direction, kDirection, "Horizontal direction of the ascent.");
  }
  io("point_m", p.point_m, "Point on the surface, for use with `normal` or `slope_rad`.");
  if constexpr (Io::kResolved) {
    io("material", p.material);
  } else {
    SurfaceKeys(io, p.surface);
  }
}
void Check(const MapReader& map, PlaneText& plane);

template <class Io, Either<TerrainBoxDef, TerrainBoxText> Box>
void Keys(Io& io, Box& b) {
  io.Map("box", "terrain.box", "Fixed box, such as a wall or a step.");
  io("name", b.name, kResolvedOnly);
  io("center_m", b.center_m, kNeeded, "Center of the box.");
  if constexpr (Io::kResolved) {
    io("orientation", b.orientation);
    io("half_extents_m", b.half_extents_m);
    io("material", b.material);
  } else {
    io("size_m", b.size_m, kNeeded, Bound::kPositive, "Edge lengths along the box's axes.");
    io("rotate", b.orientation, "Rotation about the center. Default: the world's axes.");
    SurfaceKeys(io, b.surface);
  }
}
void Check(const MapReader& map, TerrainBoxText& box);

template <class Io>
void Keys(Io& io, Like<TerrainText> auto& t) {
  io.Map("terrain", "terrain",
         "Terrain element: a plane, a box, many boxes, a height field or a mesh. Elements form one "
         "surface if the gap between them is at most 2e-7 of the larger element's extent.",
         R"({"name": "ground", "plane": {"height_m": 0, "friction": 0.5}})");
  io("name", t.name, kNeeded, kName, "Name of the element.");
  io.OneOf({"plane", "box", "scatter", "stairs", "height_field", "mesh"});
  io("plane", t.plane);
  io("box", t.box);
  io("scatter", t.scatter);
  io("stairs", t.stairs);
  io("height_field", t.height_field);
  io("mesh", t.mesh);
}
void Check(const MapReader& map, TerrainText& terrain);

template <class Io>
void Keys(Io& io, Like<PlaceText> auto& p) {
  io.Map(
      "place", "place",
      "Initial pose and velocity of the whole robot, including anchors: the robot is first rotated "
      "about the model's origin by "
      "`rotate`, then translated by `at_m`. The velocities are added to the "
      "model's velocities; they are not allowed with `start: settled` or `settled_floating`.",
      R"({"at_m": [0, 0, 1], "rotate": {"axis": "y", "angle_rad": "pi / 6"}})");
  io("at_m", p.at_m, "Position of the model's origin.");
  io("rotate", p.rotate, "Rotation about the model's origin.");
  io("velocity_m_per_s", p.velocity_m_per_s,
     "Velocity of the robot's center of mass, in the world frame.");
  io("angular_velocity_rad_per_s", p.angular_velocity_rad_per_s,
     "Angular velocity of the whole robot about its center of mass, in the world frame.");
}
void Check(const MapReader& map, PlaceText& place);

template <class Io, Either<PushSpec, PushText> Push>
void Keys(Io& io, Push& p) {
  io.Map("push", "timeline.events.push",
         "Force on a node over time, zero before the first and after the last point.",
         R"({"name": "push", "node": "segment_0.tip", "direction": [1, 0, 0], )"
         R"("force_n": [[30, 0], [35, 20], [40, 20], [45, 0]]})");
  io("name", p.name, kNeeded, kName,
     "Name of the push. Its force is the channel `push/NAME/force_n`.");
  if constexpr (Io::kResolved) {
    io("node", p.node);
  } else {
    io("node", p.node_name, kNeeded, "Node on which the force acts, such as segment_0.tip.");
  }
  io("direction", p.direction, kNeeded, kDirection, "Direction of the force, in the world frame.");
  io("scale", p.scale, "Factor on all forces in `force_n`.");
  io("force_n", p.force_n, kNeeded, "Points [[time_s, force_n], ...], linearly interpolated.");
}
void Check(const MapReader& map, PushText& push);

template <class Io, Either<DragSpec, DragText> Drag>
void Keys(Io& io, Drag& d) {
  io.Map("drag", "timeline.events.drag",
         "Pull by a spring scale: a spring and damper between a node and a point that starts at "
         "the node and moves at constant velocity.");
  io("name", d.name, kNeeded, kName,
     "Name of the drag. Its force is the channel `drag/NAME/force_n`.");
  if constexpr (Io::kResolved) {
    io("node", d.node);
  } else {
    io("node", d.node_name, kNeeded, "Dragged node.");
  }
  io("velocity_m_per_s", d.velocity_m_per_s, kNeeded,
     "Velocity of the point, in the world frame; must not be zero.");
  io("stiffness_n_per_m", d.stiffness_n_per_m, kNeeded, Bound::kPositive,
     "Stiffness of the spring.");
  io("damping_n_s_per_m", d.damping_n_s_per_m, Bound::kNonNegative, "Damping of the spring scale.");
  io("from_s", d.from_s, kNeeded, Bound::kNonNegative, "Start time of the drag.");
  io("to_s", d.to_s, kNeeded, Bound::kNonNegative, "End time of the drag, after `from_s`.");
}
void Check(const MapReader& map, DragText& drag);

template <class Io>
void Keys(Io& io, Like<EventText> auto& e) {
  io.Map("event", "timeline.events", "Event: a push or a drag.");
  io.OneOf({"push", "drag"});
  io("push", e.push);
  io("drag", e.drag);
}
void Check(const MapReader& map, EventText& event);

template <class Io>
void Keys(Io& io, Like<PhaseSpec> auto& p) {
  io("name", p.name);
  io("from_s", p.from_s);
  io("to_s", p.to_s);
}
template <class Io>
void Keys(Io& io, Like<TimelineText> auto& t) {
  io.Map("timeline", "timeline", "Events and phases.");
  io("phases", t.phases, kName,
     "Named time spans for the summary: name and [from, to] in seconds, within 0..duration_s.",
     Example{R"({"before": [25, 30], "during": [35, 40]})"});
  io("events", t.events, "Events, with unique names.");
}

template <class Io>
void Keys(Io& io, Like<ScaleSpec> auto& s) {
  io("quantity", s.quantity, kScaledQuantities);
  io("index", s.index);
  io("factor", s.factor);
}
template <class Io>
void Keys(Io& io, Like<ScaleText> auto& s) {
  io.Map("scale", "scale", "Factor on one model quantity.");
  io.OneOf({"friction", "mass", "stiffness", "damping"});
  io("friction", s.friction, Bound::kPositive, "Factor on all friction coefficients.");
  io("mass", s.mass, Bound::kPositive, "Factor on masses and inertias of bodies.");
  io("stiffness", s.stiffness, Bound::kPositive, "Factor on the stiffness of cables.");
  io("damping", s.damping, Bound::kPositive, "Factor on the damping of cables.");
  io("bodies", s.bodies,
     "Bodies to which `mass` applies, by name; `*` stands for any text. Default: all.",
     Example{R"("segment_0")"});
  io("cables", s.cables, "Cables to which `stiffness` or `damping` applies. Default: all.");
}
void Check(const MapReader& map, ScaleText& scale);

template <class Io>
void Keys(Io& io, Like<StartNoise> auto& n) {
  io.Map("", "start_noise",
         "Random deviations of the start, uniformly distributed and drawn from the seed.");
  io("place_m", n.place_m, LaterThan{0.0}, Bound::kNonNegative,
     "Largest displacement of the whole robot along x and along y, in both directions. The robot "
     "moves up "
     "or down with the ground, so that its clearance does not decrease; on large terrain each "
     "start has different ground. With `start: settled` the robot settles at the new place. A "
     "`goal` is displaced by the same vector.");
  io("position_m", n.position_m, Bound::kNonNegative,
     "Largest displacement of each body along x and y in both directions, and upward. Bodies "
     "connected by joints are displaced together; bodies connected to the world are not "
     "displaced.");
  io("heading_rad", n.heading_rad, Bound::kNonNegative,
     "Largest rotation of the robot about the vertical, in both directions.");
  io("goal_rad", n.goal_rad, LaterThan{0.0}, Bound::kNonNegative,
     "Largest rotation of the `goal` about the vertical through the world's origin, in both "
     "directions.");
  io("any_pose", n.any_pose, kLater,
     "Random orientation about the robot's center of mass, uniform over all orientations. Place "
     "the robot high enough that it does not touch the ground in any orientation; the robot then "
     "falls.");
}

template <class Io, Either<GoalSpec, GoalText> Goal>
void Keys(Io& io, Goal& g) {
  io.Map("goal", "goal",
         "Goal of the robot and sensor of the goal's direction. Used by gaits with a "
         "`goal_network` or "
         "`toward_goal`, and by the measure `nearer` of a study's objective.",
         R"({"at_m": [3.5, 0, 0], "body": "segment_2"})");
  io("at_m", g.at_m, kNeeded, "Goal point; the height (z) is ignored.");
  if constexpr (Io::kResolved) {
    io("body", g.body);
  } else {
    io("body", g.body_name, kNeeded, "Tracked body; its center of mass is to approach the goal.");
  }
  io("ahead", g.ahead, kDirection, kInherited,
     "Forward direction of the tracked body at the start, in the world frame, after `place`; it "
     "turns with the body. Default: [1, 0, 0].");
  io("frame", g.frame, kGoalFrames,
     "Frame of the sensed unit vector toward the goal. `body`: x along the horizontal part of "
     "`ahead`, y to its left, as a camera sees a beacon. `world`: x and y of the world, as with a "
     "compass.");
  io("period_s", g.period_s, Bound::kPositive, "Time between two readings of the goal sensor.");
}

template <class Io>
void Keys(Io& io, Like<ReferenceSpec::Value> auto& v) {
  io("cable", v.cable);
  io("force_n", v.force_n);
}
template <class Io, Either<ReferenceSpec, ReferenceText> Reference>
void Keys(Io& io, Reference& r) {
  io.Map("reference", "reference",
         "Reference values of one quantity for some cables, from one source.",
         R"({"source": "the robot", "cables_n": {"inner_top_1": 34.4}})");
  io("source", r.source, kNeeded, "Source of the values.");
  io("quantity", r.quantity, kReferenceQuantities,
     "`tension`: force of spring and damper together, as measured by a load cell. `elastic`: "
     "spring force k (l - L) alone.");
  io("statistic", r.statistic, kReferenceStatistics, "Statistic of the quantity over the phase.");
  if constexpr (Io::kResolved) {
    io("phase", r.phase);
    io("values", r.values);
  } else {
    io("phase", r.phase_text, "Phase of the timeline. Default: the whole run, with `max` only.");
    io("cables_n", r.cables_n, kNeeded, "Values by cable name.",
       Example{R"({"inner_top_1": 34.4, "inner_left_1": 18.1})"});
  }
}
void Check(const MapReader& map, ReferenceText& reference);

template <class Io, Either<RecordSpec, RecordText> Record>
void Keys(Io& io, Record& r) {
  io.Map("record", "record", "Content of the trace.");
  io("rate_hz", r.rate_hz, Bound::kNonNegative, "Rows per second; with 0, every step is recorded.");
  if constexpr (Io::kResolved) {
    io("channels", r.channels);
  } else {
    io("channels", r.channel_texts,
       "Names of the recorded channels; `*` stands for any text. Each name must match a channel of "
       "the run. "
       "Default: all except `node/*`, `strut/*` and `anchor/*`, which are recorded on request only "
       "(docs/formats/trace.md).",
       Example{R"(["cable/*/tension_n", "strut/*", "system/*"])"});
  }
  io("contacts", r.contacts, kLater, Bound{.least = 0, .most = 1000},
     "Number of contact points per row, channels `contact/*`. If there are more contact points, "
     "those with the "
     "largest forces are recorded, and the summary contains the number of the omitted ones.");
}
void Check(const MapReader& map, RecordText& record);

template <class Io, Either<ExperimentSpec, ExperimentText> Experiment>
void Keys(Io& io, Experiment& e) {
  io.Map("", "Experiment file",
         "An experiment file defines the initial state, terrain, controllers, events and recorded "
         "channels of a robot.");
  HeadKeys(io, e,
           {"Name of the experiment in reports and traces. Required unless the `base` file has it.",
            "Purpose of the experiment, in a sentence or two.",
            "Another experiment file to inherit from, relative to this file's folder. Each key of "
            "this file replaces the whole key of the base, except that `parameters` and `set` are "
            "merged by name.",
            R"("push_20n.yaml")",
            "Named numbers for expressions in this file. Parameters may refer to each other, in "
            "any order; `--set name=value` on the command line overrides them.",
            R"({"push_n": "2.3 * 9.81"})"});
  if constexpr (!Io::kResolved) {
    io("model", e.model, kNeeded,
       "Model file of the robot, relative to this file's folder. Required unless the `base` file "
       "has it.",
       Example{R"("../models/tetraspine3.yaml")"});
    io("set", e.set,
       "Model parameters that this experiment overrides. Values may be expressions over the "
       "experiment's parameters; `--set` on the command line takes precedence.",
       Example{R"({"segments": 12, "friction": "ground_friction / 2"})"});
    io("model_options", e.model_options);
    io("gravity_m_per_s2", e.gravity_m_per_s2,
       "Gravity in the world frame. Default: the model's gravity.");
    io("terrain", e.terrain, "Terrain elements. Default: none; the robot floats or falls.");
    io("place", e.place);
    io("motion", e.motions,
       "Kinematic bodies with prescribed motion: shakers, turntables, platforms. Default: none.");
  }
  io("step_s", e.step_s,
     Bound{.least = kShortestStep_s, .most = kLongestStep_s, .least_text = "1e-9"},
     "Longest step of the integrator. Steps also end at ticks of controllers and at corner points "
     "of events.");
  io("duration_s", e.duration_s, kNeeded,
     Bound{.least = 0, .most = kLongestTime_s, .most_text = "1e9"},
     "Simulated time; with 0 the trace contains only the start. Required unless the `base` file "
     "has it.",
     Example{"60"});
  io("start", e.start, kStarts,
     "State at t = 0. `as_described`: the described pose, with nodes at the model's positions. "
     "`settled`: static "
     "equilibrium under cables, gravity and contact. `settled_floating`: static equilibrium of the "
     "cables alone, without gravity and terrain. Settling does not change the rest lengths of the "
     "model.");
  io("seed", e.seed, Bound{.least = 0, .most = 2'147'483'647},
     "Seed of all random numbers of the run.");
  if constexpr (Io::kResolved) {
    io("record", e.record);
    io("compare_with", e.compare_with);
    io("phases", e.phases);
    io("references", e.references, kLater);
    io("pushes", e.pushes);
    io("drags", e.drags);
    io("scale", e.scales, kLater);
    io("load_cases", e.load_cases, kLater);
    io("environment", e.environment, kLater);
  } else {
    io("record", e.record_text);
    io("compare_with", e.compare_file,
       "Trace (.h5, .csv or .csv.gz) with which the result of the run is compared, relative to "
       "this file's "
       "folder.");
    io("reference", e.reference_texts,
       "Cable forces of a robot or another simulator, for comparison in the summary and the "
       "report.");
    io("timeline", e.timeline);
    io("scale", e.scale_texts,
       "Factors on model quantities, for sensitivity studies. Several factors on one quantity are "
       "multiplied.");
    io("load_cases", e.load_case_texts, "Static loads for `taut analyze`.");
    io("load_combinations", e.load_combinations,
       "Sums of load cases with partial factors, also for `taut analyze`.");
    io("environment", e.environment_text);
  }
  io("start_noise", e.start_noise, kLater);
  if constexpr (Io::kResolved) {
    io("goal", e.goal, kLater);
  } else {
    io("goal", e.goal_text);
  }
  if constexpr (Io::kResolved) {
    io("sensors", e.sensors, kLater);
    io("controllers", e.controllers);
    io("robot", e.robot);
  } else {
    io("sensors", e.sensor_text);
    io("controllers", e.controller_texts,
       "Controllers of the cables' actuators. Each cable has at most one controller; cables "
       "without a controller keep their rest length.");
    io("boards", e.boards_text);
  }
}

}  // namespace taut::description
