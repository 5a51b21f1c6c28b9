/// A model file as read, before anything is placed or built: names, tags and numbers with their
/// places in the file.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "description/model/surface_keys.h"
#include "description/yaml/head_keys.h"
#include "description/yaml/keys.h"
#include "description/yaml/merged_file.h"
#include "description/yaml/parameters.h"
#include "description/yaml/reader.h"
#include "math/triangles.h"
#include "taut/spec.h"

namespace taut::description {

inline constexpr int kMaxModelNodes = 100'000;
inline constexpr int kMaxModelEnds = 400'000;  ///< Nodes of all pairs together.
inline constexpr int kMaxTags = 32;            ///< Of one node, pair or placement.
inline constexpr int kMaxCopies = 10'000;
inline constexpr int kMaxBuilders = 1'000;

struct NodeText {
  std::string name;
  SourceRef at;  ///< Of its name.
  Vec3 at_m;     ///< In the part's frame.
  Tags tags;
  Placed fixed_to;  ///< Another node of the part whose body this one belongs to; may be empty.
};

/// One pair; an entry of `pairs:` may make several.
/// An element of a pair's `route:`: what a cable runs through or round.
struct RouteText {
  SourceRef at;
  Placed eyelet, pulley, drum;  ///< Its node; one of them.
  double friction = 0;
  Vec3 axis;  ///< In the part's frame.
  double radius_m = NAN;
  bool left = false;  ///< It is on the cable's left, with the axis upwards.
  double turns = 0;

  const Placed& node() const {
    return !pulley.text.empty() ? pulley : !drum.text.empty() ? drum : eyelet;
  }
  bool is_pulley() const { return !pulley.text.empty(); }
  bool is_drum() const { return !drum.text.empty(); }
};

struct PairText {
  std::string name;  ///< Empty: made from the nodes.
  SourceRef at;
  std::vector<Placed> nodes;  ///< 2 or more.
  Tags tags;
  std::vector<RouteText> route = {};  ///< Empty, or one a node.
};

struct NodeListForm {
  static constexpr const char* kSchema =
      R"("type": "array", "title": "[node, node]", "items": {"type": "string"}, "minItems": 2)";
};
struct NodeListsForm {
  static constexpr const char* kSchema =
      R"("type": "array", "items": {"type": "array", "title": "[node, node]", )"
      R"("items": {"type": "string"}, "minItems": 2})";
};

/// An entry of `pairs:`.
struct PairsText {
  SourceRef at;
  std::string name;
  Raw<NodeListForm> nodes;
  Raw<NodeListsForm> each;
  std::vector<RouteText> route;
  Tags tags;
  bool good = true;  ///< Nothing was wrong with it.
};

/// Nodes and pairs: those of a part, or those at the top of the file.
struct PartText {
  std::string name;
  Named<NodeText> nodes_text;
  std::vector<PairsText> pairs_text;
  std::vector<NodeText> nodes;
  std::vector<PairText> pairs;
  bool nodes_complete = true, pairs_complete = true;
};

/// An entry of `structure:`.
struct PlacementText {
  std::string name;  ///< The part's, if there is none.
  SourceRef at;
  Placed part;
  int copies = 1;
  bool numbered = false;            ///< `copies` was given: the copies are name_0, name_1, ...
  Vec3 at_m;                        ///< Origin of copy 0 in W.
  Quat rotate;                      ///< q_WPart of copy 0.
  Vec3 step_m;                      ///< From one copy's origin to the next, in W.
  Quat step_rotate;                 ///< From one copy's orientation to the next, about axes of W.
  Vec3 velocity_m_per_s;            ///< Of the centre of mass of a copy.
  Vec3 angular_velocity_rad_per_s;  ///< Of a copy as a whole, about that centre.
  Tags tags;
  std::vector<PairsText> connect_text;
  std::vector<PairText> connect;  ///< Node k of a pair is on copy i + k.
  bool ring = false;              ///< Copy 0 follows the last one.
  bool nodes_complete = true, pairs_complete = true;
};

/// A mass as files may give it: one of these, none after a complaint.
struct MassText {
  std::optional<double> mass_kg, density_kg_per_m3, mass_kg_per_m;

  double Of(double volume_m3, double length_m) const {
    if (mass_kg) return *mass_kg;
    if (density_kg_per_m3) return *density_kg_per_m3 * volume_m3;
    return mass_kg_per_m ? *mass_kg_per_m * length_m : NAN;
  }
  SolidMass AsWritten() const {
    if (mass_kg) return {SolidMass::Per::kWhole, *mass_kg};
    if (density_kg_per_m3) return {SolidMass::Per::kVolume, *density_kg_per_m3};
    return {SolidMass::Per::kLength, mass_kg_per_m.value_or(NAN)};
  }
};

// What builders say. The structs that they build on are what is built but for its place: each copy
// gets name, body and positions.

/// As those of a ball in `JointDef`.
struct PinText {
  double friction = 0.0, stiffness = 0.0, damping = 0.0;
};
struct RodText : CapsuleDef {
  bool class_k = false;
  std::optional<PinText> pins;
  MassText mass;
  SurfaceText surface;
};
struct SphereText : SphereDef {
  MassText mass;
  SurfaceText surface;
};
struct PointMassText {
  double mass_kg = 0.0;
  double radius_m = 0.0;  ///< Of the solid sphere that gives it its inertia; touches nothing.
  /// In place of that sphere's: about the node, in the part's axes. Empty, or xx, yy, zz, and xy,
  /// xz, yz where they are not 0.
  std::vector<double> inertia_kg_m2;
};
/// At a node, or along a pair.
struct BoxText : BoxDef {
  Vec3 size_m;
  double width_m = NAN, height_m = NAN;  ///< Along a pair.
  Quat rotate;                           ///< q_PartBox, at a node.
  MassText mass;
  SurfaceText surface;
  bool along_pair = false;
};
/// At a node. Its parts are those of the file, or the one that the corners span.
struct ConvexText : HullDef {
  struct Part {
    std::vector<Vec3> hull_m;  ///< Corners of what touches.
    std::vector<Vec3> corners_m;
    math::Triangles triangles;  ///< What has mass, by those.
  };
  Placed file;
  double scale_m = 1.0;
  MassText mass;
  SurfaceText surface;
  std::vector<Part> parts;  ///< In the part's frame, from the node; none after a complaint.
  std::string read_file;    ///< Where they come from.
};
struct ActuatorText : ActuatorDef {
  ActuatorText();  ///< Without limits.
  bool ideal = false;
};
/// Its rest length is one of three, none after a complaint; NaN stands for one that is wrong. So it
/// does for a stiffness that follows from the section.
struct CableText : CableDef {
  CableText() { rest_length_m = stiffness_n_per_m = NAN; }
  std::optional<double> prestress_n, rest_length_ratio, density_kg_per_m3;
  SourceRef rest_at;
  bool own_damping_law = false;
  bool ends_on_surface = false;
  SourceRef ends_at;
  std::optional<ActuatorText> actuator_text;
};
/// At most one of the three says how long it is without stress: as long as described if none.
struct BarText {
  std::optional<double> stiffness_n_per_m;
  double damping_n_s_per_m = 0.0;
  std::optional<double> rest_length_m, rest_length_ratio, prestress_n;
  std::optional<double> density_kg_per_m3;
  MemberDef member;
  SourceRef rest_at;
};
struct AnchorText {};
/// Between the bodies of a pair's nodes, the axis in the part's frame; or, as a support, between
/// the world and a node's body.
struct JointText : JointDef {};

using Match = std::vector<std::vector<std::string>>;

/// An entry of `builders:`: what becomes of the pairs or nodes that carry the tags. One of the
/// kinds is there.
struct BuilderText {
  SourceRef at;
  Match match;
  SourceRef match_at;
  std::string kind;  ///< As written: "rod", "cable" ... Empty after a complaint.
  std::optional<RodText> rod;
  std::optional<SphereText> sphere;
  std::optional<PointMassText> point_mass;
  std::optional<BoxText> box;
  std::optional<ConvexText> convex;
  std::optional<CableText> cable;
  std::optional<BarText> bar;
  std::optional<AnchorText> anchor;
  std::optional<JointText> joint, support;

  /// True for what goes on pairs, false for what goes on nodes.
  bool on_pairs() const { return rod || cable || bar || joint || (box && box->along_pair); }
};

/// Laws of the model that an experiment may replace.
struct ModelOptions {
  InertiaLaw inertia = InertiaLaw::kExact;
  DampingLaw damping_law = DampingLaw::kExact;
  ModelDef def;
};

struct ModelForm {
  static constexpr const char* kSchema = R"("const": "model")";
};

struct ModelText {
  Head<ModelForm> head;
  std::string name, description;
  SourceRef at;
  ModelDef def;  ///< What the file says of the model as a whole: its laws.
  InertiaLaw inertia = InertiaLaw::kExact;
  DampingLaw damping_law = DampingLaw::kExact;  ///< Of cables that have none of their own.
  std::optional<ActuatorText> actuator_text;    ///< In place of that of every cable that has one.
  bool allow_disconnected = false;
  PartText loose;  ///< The nodes and pairs at the top of the file.
  Named<PartText> parts_text;
  std::vector<PartText> parts;
  std::vector<PlacementText> structure;
  std::vector<BuilderText> builders;
  std::vector<std::vector<std::string>> apart;
  SourceRef apart_at;
  bool builders_complete = true;  ///< False: at least one could not be read.
  bool nodes_complete = true;  ///< False: at least one node, part or placement could not be read.
  bool pairs_complete = true;  ///< False: at least one pair could not be read.
};

/// Reads the top of a model file, bases merged in (`ReadMergedFile(path, "model", out)`).
ModelText ReadModelText(const Value& root, const Scope& scope);

// What is left to do when the keys of a block are read, each in the file of the block.
void FinishNodesAndPairs(const MapReader& map, bool loose, PartText& part);
void FinishStructure(const MapReader& map, ModelText& model);
void FinishBuilders(const MapReader& map, ModelText& model);

}  // namespace taut::description
