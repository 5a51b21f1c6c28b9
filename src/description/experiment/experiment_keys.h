/// The keys of an experiment file but for controllers, and what of them is in a resolved one.
#pragma once

#include "description/experiment/control_keys.h"
#include "description/experiment/environment_keys.h"
#include "description/experiment/experiment_text.h"
#include "description/experiment/load_keys.h"
#include "description/experiment/sensor_keys.h"
#include "description/model/model_keys.h"

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
         "A half space, solid below its surface. One of `height_m`, `normal` and `slope_rad` says "
         "how it lies.");
  io("name", p.name, kResolvedOnly);
  if constexpr (!Io::kResolved) {
    io.OneOf({"height_m", "normal", "slope_rad"});
    io.Rule(R"("dependentRequired": {"slope_rad": ["slope_direction"], )"
            R"("slope_direction": ["slope_rad"]})");
    io.Rule(R"("not": {"required": ["height_m", "point_m"]})");
    io("height_m", p.height_m, "Height of a level surface.");
  }
  io("normal", p.normal, kDirection, kInherited, "Direction out of the solid.");
  if constexpr (!Io::kResolved) {
    io("slope_rad", p.slope_rad,
       Bound{.least = 0.0,
             .most = 0.5 * 3.14159265358979323846,
             .below_most = true,
             .most_text = "pi / 2",
             .hint = "give a `normal` instead"},
       "Angle between the surface and the horizontal.");
    io("slope_direction", p.slope_direction, kDirection,
       "Horizontal direction in which the slope rises.");
  }
  io("point_m", p.point_m, "Any point of the surface, with `normal` or `slope_rad`.");
  if constexpr (Io::kResolved) {
    io("material", p.material);
  } else {
    SurfaceKeys(io, p.surface);
  }
}
void Check(const MapReader& map, PlaneText& plane);

template <class Io, Either<TerrainBoxDef, TerrainBoxText> Box>
void Keys(Io& io, Box& b) {
  io.Map("box", "terrain.box", "A fixed box: a wall, a step.");
  io("name", b.name, kResolvedOnly);
  io("center_m", b.center_m, kNeeded, "Its centre.");
  if constexpr (Io::kResolved) {
    io("orientation", b.orientation);
    io("half_extents_m", b.half_extents_m);
    io("material", b.material);
  } else {
    io("size_m", b.size_m, kNeeded, Bound::kPositive, "Its edge lengths along its own axes.");
    io("rotate", b.orientation,
       "Turns the box about its centre. Its axes are the world's if absent.");
    SurfaceKeys(io, b.surface);
  }
}
void Check(const MapReader& map, TerrainBoxText& box);

template <class Io>
void Keys(Io& io, Like<TerrainText> auto& t) {
  io.Map("terrain", "terrain",
         "A part of the terrain: a plane, a box, many boxes, a height field or a mesh. Parts form "
         "one surface if they meet within 2e-7 of the larger part's extent.",
         R"({"name": "ground", "plane": {"height_m": 0, "friction": 0.5}})");
  io("name", t.name, kNeeded, kName, "Name of the part.");
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
  io.Map("place", "place",
         "Where the whole robot is at the start, and how it moves: turned about the model's origin "
         "by `rotate`, then moved by `at_m`; all that the model describes moves along, anchors "
         "included. The velocities are added to the model's own and do not go with `start: "
         "settled` or `settled_floating`.",
         R"({"at_m": [0, 0, 1], "rotate": {"axis": "y", "angle_rad": "pi / 6"}})");
  io("at_m", p.at_m, "Where the model's origin goes.");
  io("rotate", p.rotate, "Turns the robot about the model's origin.");
  io("velocity_m_per_s", p.velocity_m_per_s,
     "Velocity of the robot's centre of mass, in the world frame.");
  io("angular_velocity_rad_per_s", p.angular_velocity_rad_per_s,
     "Angular velocity of the robot as a whole, about its centre of mass, in the world frame.");
}
void Check(const MapReader& map, PlaceText& place);

template <class Io, Either<PushSpec, PushText> Push>
void Keys(Io& io, Push& p) {
  io.Map("push", "timeline.events.push",
         "A force on a node against time, zero before the first point and after the last one.",
         R"({"name": "push", "node": "segment_0.tip", "direction": [1, 0, 0], )"
         R"("force_n": [[30, 0], [35, 20], [40, 20], [45, 0]]})");
  io("name", p.name, kNeeded, kName,
     "Name of the push; its force is the channel `push/NAME/force_n`.");
  if constexpr (Io::kResolved) {
    io("node", p.node);
  } else {
    io("node", p.node_name, kNeeded, "The node that it acts on, such as segment_0.tip.");
  }
  io("direction", p.direction, kNeeded, kDirection, "Direction in the world frame.");
  io("scale", p.scale, "Factor on all of `force_n`.");
  io("force_n", p.force_n, kNeeded,
     "Points [[time_s, force_n], ...] with straight lines between them.");
}
void Check(const MapReader& map, PushText& push);

template <class Io, Either<DragSpec, DragText> Drag>
void Keys(Io& io, Drag& d) {
  io.Map("drag", "timeline.events.drag",
         "A hand with a spring scale: a spring and damper pulls a node towards a point that starts "
         "at the node's place and moves steadily.");
  io("name", d.name, kNeeded, kName,
     "Name of the drag; its force is the channel `drag/NAME/force_n`.");
  if constexpr (Io::kResolved) {
    io("node", d.node);
  } else {
    io("node", d.node_name, kNeeded, "The node that is dragged.");
  }
  io("velocity_m_per_s", d.velocity_m_per_s, kNeeded,
     "Velocity of the moving point, in the world frame; not zero.");
  io("stiffness_n_per_m", d.stiffness_n_per_m, kNeeded, Bound::kPositive,
     "Stiffness of the scale's spring.");
  io("damping_n_s_per_m", d.damping_n_s_per_m, Bound::kNonNegative, "Damping of the scale.");
  io("from_s", d.from_s, kNeeded, Bound::kNonNegative, "When the drag begins.");
  io("to_s", d.to_s, kNeeded, Bound::kNonNegative, "When it ends, after `from_s`.");
}
void Check(const MapReader& map, DragText& drag);

template <class Io>
void Keys(Io& io, Like<EventText> auto& e) {
  io.Map("event", "timeline.events", "One event: a push or a drag.");
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
  io.Map("timeline", "timeline", "What happens when.");
  io("phases", t.phases, kName,
     "Named spans of time for the summary: a name, then [from, to] in seconds, within "
     "0..duration_s.",
     Example{R"({"before": [25, 30], "during": [35, 40]})"});
  io("events", t.events, "What is done to the robot. Names are unique.");
}

template <class Io>
void Keys(Io& io, Like<ScaleSpec> auto& s) {
  io("quantity", s.quantity, kScaledQuantities);
  io("index", s.index);
  io("factor", s.factor);
}
template <class Io>
void Keys(Io& io, Like<ScaleText> auto& s) {
  io.Map("scale", "scale", "A factor on one kind of number.");
  io.OneOf({"friction", "mass", "stiffness", "damping"});
  io("friction", s.friction, Bound::kPositive, "Factor on all coefficients of friction.");
  io("mass", s.mass, Bound::kPositive, "Factor on masses and inertias of bodies.");
  io("stiffness", s.stiffness, Bound::kPositive, "Factor on the stiffness of cables.");
  io("damping", s.damping, Bound::kPositive, "Factor on the damping of cables.");
  io("bodies", s.bodies, "Which bodies `mass` is for, by name, `*` for any letters. All if absent.",
     Example{R"("segment_0")"});
  io("cables", s.cables, "Which cables `stiffness` or `damping` is for. All if absent.");
}
void Check(const MapReader& map, ScaleText& scale);

template <class Io>
void Keys(Io& io, Like<StartNoise> auto& n) {
  io.Map("", "start_noise",
         "How far the start may be from what is described, drawn evenly from the seed.");
  io("place_m", n.place_m, LaterThan{0.0}, Bound::kNonNegative,
     "The whole robot is moved by up to this along x and along y, either way, and up or down with "
     "the ground: on a terrain larger than the robot each start then has ground of its own. "
     "Nothing of it comes nearer to what is below it than it was; with `start: settled` it settles "
     "there. A `goal` goes along.");
  io("position_m", n.position_m, Bound::kNonNegative,
     "Each body is moved by up to this along x and y, and upwards. Bodies that joints tie to each "
     "other are moved together; those that are tied to the world stay.");
  io("heading_rad", n.heading_rad, Bound::kNonNegative,
     "The robot is turned about the vertical by up to this either way.");
  io("goal_rad", n.goal_rad, LaterThan{0.0}, Bound::kNonNegative,
     "The `goal` is turned about the vertical through the world's origin by up to this either "
     "way.");
  io("any_pose", n.any_pose, kLater,
     "The robot is turned about its centre of mass to a pose drawn evenly from all: it must be "
     "placed so high that no pose reaches into the ground, and it falls.");
}

template <class Io, Either<GoalSpec, GoalText> Goal>
void Keys(Io& io, Goal& g) {
  io.Map("goal", "goal",
         "Where the robot is to go, and how it senses in which direction that is. Gaits with a "
         "`goal_network` and gaits `toward_goal` hear it; the measure `nearer` of a study's "
         "objective scores it.",
         R"({"at_m": [3.5, 0, 0], "body": "segment_2"})");
  io("at_m", g.at_m, kNeeded, "A point. Its height does not count.");
  if constexpr (Io::kResolved) {
    io("body", g.body);
  } else {
    io("body", g.body_name, kNeeded,
       "The body that is watched: its centre of mass is to come near.");
  }
  io("ahead", g.ahead, kDirection, kInherited,
     "Where that body looks: a direction in the world frame, of the robot as it is placed at the "
     "start, from where on it turns with the body. [1, 0, 0] if absent.");
  io("frame", g.frame, kGoalFrames,
     "What the unit vector towards the goal is sensed in. `body`: x is the horizontal part of "
     "`ahead`, y is to the left of it, as a camera sees a beacon. `world`: x and y of the world, "
     "which takes a compass.");
  io("period_s", g.period_s, Bound::kPositive, "Time between two readings.");
}

template <class Io>
void Keys(Io& io, Like<ReferenceSpec::Value> auto& v) {
  io("cable", v.cable);
  io("force_n", v.force_n);
}
template <class Io, Either<ReferenceSpec, ReferenceText> Reference>
void Keys(Io& io, Reference& r) {
  io.Map("reference", "reference", "What one source says about one quantity of some cables.",
         R"({"source": "the robot", "cables_n": {"inner_top_1": 34.4}})");
  io("source", r.source, kNeeded, "Who says so.");
  io("quantity", r.quantity, kReferenceQuantities,
     "`tension`: spring and damper, what a load cell feels. `elastic`: k (l - L) alone.");
  io("statistic", r.statistic, kReferenceStatistics, "Of that quantity over the phase.");
  if constexpr (Io::kResolved) {
    io("phase", r.phase);
    io("values", r.values);
  } else {
    io("phase", r.phase_text,
       "A phase of the timeline. The whole run if absent; that goes with `max` only.");
    io("cables_n", r.cables_n, kNeeded, "The value of each cable, by its name.",
       Example{R"({"inner_top_1": 34.4, "inner_left_1": 18.1})"});
  }
}
void Check(const MapReader& map, ReferenceText& reference);

template <class Io, Either<RecordSpec, RecordText> Record>
void Keys(Io& io, Record& r) {
  io.Map("record", "record", "What a trace holds.");
  io("rate_hz", r.rate_hz, Bound::kNonNegative, "Rows a second; 0 records every step.");
  if constexpr (Io::kResolved) {
    io("channels", r.channels);
  } else {
    io("channels", r.channel_texts,
       "Names of the channels to record; `*` stands for any text. Each must fit a channel of the "
       "run. All if absent, but for those that are recorded on request only: `node/*`, `strut/*` "
       "and `anchor/*` (docs/formats/trace.md).",
       Example{R"(["cable/*/tension_n", "strut/*", "system/*"])"});
  }
  io("contacts", r.contacts, kLater, Bound{.least = 0, .most = 1000},
     "For how many touching points a row has channels, `contact/*`. Where more touch, those with "
     "the largest forces are recorded, and the summary says so.");
}
void Check(const MapReader& map, RecordText& record);

template <class Io, Either<ExperimentSpec, ExperimentText> Experiment>
void Keys(Io& io, Experiment& e) {
  io.Map("", "Experiment file",
         "What is done with a robot: where it stands, what drives it, what happens to it, and what "
         "is recorded.");
  HeadKeys(io, e,
           {"Name of the experiment, for reports and traces. Needed unless `base` has it.",
            "What the experiment is for, in a sentence or two.",
            "Another experiment file, seen from this file's folder. This file then holds only what "
            "differs: each of its keys replaces the base's as a whole, except that `parameters` "
            "and `set` are merged by name.",
            R"("push_20n.yaml")",
            "Named numbers for expressions in this file. They may refer to each other, in any "
            "order; `--set name=value` on the command line replaces them.",
            R"({"push_n": "2.3 * 9.81"})"});
  if constexpr (!Io::kResolved) {
    io("model", e.model, kNeeded,
       "The robot's model file, seen from this file's folder. Needed unless `base` has it.",
       Example{R"("../models/tetraspine3.yaml")"});
    io("set", e.set,
       "Parameters of the model whose value this experiment changes. The values may be expressions "
       "over the experiment's own parameters; `--set` on the command line wins over them.",
       Example{R"({"segments": 12, "friction": "ground_friction / 2"})"});
    io("model_options", e.model_options);
    io("gravity_m_per_s2", e.gravity_m_per_s2,
       "Gravity in the world frame. What the model says if absent; [0, 0, -9.81] if that says "
       "nothing either.");
    io("terrain", e.terrain,
       "What the robot stands on and runs against. Nothing if absent: the robot floats or falls.");
    io("place", e.place);
    io("motion", e.motions,
       "Bodies that a program moves: shakers, turntables, platforms. Nothing moves so if absent.");
  }
  io("step_s", e.step_s, Bound{.least = 1e-9, .most = 1.0, .least_text = "1e-9"},
     "Longest step of the integrator. Steps also land on the ticks of controllers and on the "
     "corners of events.");
  io("duration_s", e.duration_s, kNeeded, Bound::kNonNegative,
     "Simulated time; 0 records the start alone. Needed unless `base` has it.", Example{"60"});
  io("start", e.start, kStarts,
     "The state at t = 0. `as_described`: nodes where the model says. `settled`: at rest in the "
     "static equilibrium under cables, gravity and contact. `settled_floating`: at rest in the "
     "static equilibrium of the cables alone, without gravity and terrain. Rest lengths stay as "
     "the model gives them.");
  io("seed", e.seed, Bound{.least = 0, .most = 2'147'483'647},
     "Seed of everything random in the run.");
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
       "A trace (.h5, .csv or .csv.gz), seen from this file's folder, that the result is set "
       "beside.");
    io("reference", e.reference_texts,
       "Numbers of others, a robot's or another simulator's, that the summary and the report show "
       "ours beside.");
    io("timeline", e.timeline);
    io("scale", e.scale_texts,
       "Factors on the model's numbers, to see what changes if they are not quite right. Several "
       "that meet multiply.");
    io("load_cases", e.load_case_texts, "Loads that stand still, for `taut analyze`.");
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
       "What drives the cables' actuators. A cable is driven by one controller at most; cables "
       "that none drives keep their rest length.");
  }
}

}  // namespace taut::description
