/// Contents of a model file after parsing: names, tags and numbers with file positions. Nothing is
/// placed or built yet.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "description/model/surface_keys.h"
#include "description/yaml/file_parameters.h"
#include "description/yaml/head_keys.h"
#include "description/yaml/keys.h"
#include "description/yaml/merged_file.h"
#include "description/yaml/reader.h"
#include "math/triangles.h"
#include "taut/spec.h"

namespace taut::description {

inline constexpr int kMaxModelNodes = 100'000;
inline constexpr int kMaxModelEnds = 400'000;  ///< Limit of the number of nodes, summed over all
                                               ///< pairs.
inline constexpr int kMaxTags = 32;            ///< Limit of tags of one node, pair or placement.
inline constexpr int kMaxCopies = 10'000;
inline constexpr int kMaxBuilders = 1'000;

struct NodeText {
  std::string name;
  SourceRef at;  ///< Position of the name in the file.
  Vec3 at_m;     ///< Position in the part's frame.
  Tags tags;
  Placed fixed_to;  ///< Another node of the part, whose body includes this node. May be empty.
};

/// Element of a pair's `route:`, which belongs to a routed cable: eyelet, pulley or drum.
struct RouteText {
  SourceRef at;
  Placed eyelet, pulley, drum;  ///< Name of the node; exactly one of the three is set.
  double friction = 0;
  Vec3 axis;  ///< In the part's frame.
  double radius_m = NAN;
  bool left = false;  ///< Whether the wheel is on the left of the cable, seen with the axis
                      ///< pointing up.
  double turns = 0;

  const Placed& node() const {
    return !pulley.text.empty() ? pulley : !drum.text.empty() ? drum : eyelet;
  }
  bool is_pulley() const { return !pulley.text.empty(); }
  bool is_drum() const { return !drum.text.empty(); }
};

/// One pair. An entry of `pairs:` may define several.
struct PairText {
  std::string name;  ///< Empty: composed of the node names.
  SourceRef at;
  std::vector<Placed> nodes;  ///< At least two.
  Tags tags;
  std::vector<RouteText> route = {};  ///< Empty, or one element per node.
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

/// Entry of `pairs:`.
struct PairsText {
  SourceRef at;
  std::string name;
  Raw<NodeListForm> nodes;
  Raw<NodeListsForm> each;
  std::vector<RouteText> route;
  Tags tags;
  bool good = true;  ///< Whether the entry has no errors.
};

/// Nodes and pairs of a part, or of the top level of the file.
struct PartText {
  std::string name;
  Named<NodeText> nodes_text;
  std::vector<PairsText> pairs_text;
  std::vector<NodeText> nodes;
  std::vector<PairText> pairs;
  bool nodes_complete = true, pairs_complete = true;
};

/// Entry of `structure:`.
struct PlacementText {
  std::string name;  ///< Default: the name of the part.
  SourceRef at;
  Placed part;
  int copies = 1;
  bool copies_known = true;         ///< False: `copies` is invalid.
  bool numbered = false;            ///< True if `copies` is given: copies are named name_0, name_1,
                                    ///< ...
  Vec3 at_m;                        ///< Origin of copy 0 in W.
  Quat rotate;                      ///< Rotation q_WPart of copy 0, from the part's frame to W.
  Vec3 step_m;                      ///< Translation from each copy's origin to the next, in W.
  Quat step_rotate;                 ///< Rotation from each copy to the next, about axes of W.
  Vec3 velocity_m_per_s;            ///< Velocity of a copy's center of mass, in W.
  Vec3 angular_velocity_rad_per_s;  ///< Angular velocity of a copy about its center of mass, in W.
  Tags tags;
  std::vector<PairsText> connect_text;
  std::vector<PairText> connect;  ///< Node k of each pair belongs to copy i + k.
  bool ring = false;              ///< Whether the last copy is also connected to copy 0.
  bool nodes_complete = true, pairs_complete = true;
};

/// Mass as given in the file. Exactly one field is set; none after an error.
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

// Parameters of builders. Each struct extends its base, the result. The fields name, body and
// positions differ for each copy and are set later.

/// Ball joint of a class-k rod, with the units of `JointDef`.
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
  double radius_m = 0.0;  ///< Radius of the solid sphere that defines the inertia. It does not
                          ///< collide.
  /// Alternative to the sphere's inertia: about the node, in the part's axes. Empty, or xx, yy, zz
  /// and optionally xy, xz, yz (default 0).
  std::vector<double> inertia_kg_m2;
};
/// Box at a node, or along a pair.
struct BoxText : BoxDef {
  Vec3 size_m;
  double width_m = NAN, height_m = NAN;  ///< Cross section of a box along a pair.
  Quat rotate;                           ///< Rotation of a box at a node, from box to part.
  MassText mass;
  SurfaceText surface;
  bool along_pair = false;
};
/// Convex solid at a node, made of the objects of a mesh file or of the hull of given corners.
struct ConvexText : HullDef {
  struct Part {
    std::vector<Vec3> hull_m;  ///< Corners of the collision shape.
    std::vector<Vec3> corners_m;
    math::Triangles triangles;  ///< Surface of the solid that defines mass and inertia, as indices
                                ///< into `corners_m`.
  };
  Placed file;
  double scale_m = 1.0;
  MassText mass;
  SurfaceText surface;
  std::vector<Part> parts;  ///< In the part's frame, relative to the node. Empty after an error.
  std::string read_file;    ///< Path of the mesh file.
};
struct ActuatorText : ActuatorDef {
  ActuatorText();  ///< Sets infinite limits.
  bool ideal = false;
};
/// Cable. One of three keys determines the rest length; none is set after an error. NaN marks an
/// invalid value, or a stiffness to be computed from the section.
struct CableText : CableDef {
  CableText() { rest_length_m = stiffness_n_per_m = NAN; }
  std::optional<double> prestress_n, rest_length_ratio, density_kg_per_m3;
  SourceRef rest_at;
  bool own_damping_law = false;
  bool ends_on_surface = false;
  SourceRef ends_at;
  std::optional<ActuatorText> actuator_text;
};
/// Bar. At most one of three keys determines the rest length, which defaults to the described
/// length.
struct BarText {
  std::optional<double> stiffness_n_per_m;
  double damping_n_s_per_m = 0.0;
  std::optional<double> rest_length_m, rest_length_ratio, prestress_n;
  std::optional<double> density_kg_per_m3;
  MemberDef member;
  SourceRef rest_at;
};
struct AnchorText {};
/// Joint between the bodies of a pair's nodes, or support between the world and a node's body. The
/// axis is in the part's frame.
struct JointText : JointDef {};

using Match = std::vector<std::vector<std::string>>;

/// Entry of `builders:`. Builds one element per pair or node that matches the selector. Exactly one
/// of the optional fields is set.
struct BuilderText {
  SourceRef at;
  Match match;
  SourceRef match_at;
  std::string kind;  ///< Key in the file: "rod", "cable", ... Empty after an error.
  std::optional<RodText> rod;
  std::optional<SphereText> sphere;
  std::optional<PointMassText> point_mass;
  std::optional<BoxText> box;
  std::optional<ConvexText> convex;
  std::optional<CableText> cable;
  std::optional<BarText> bar;
  std::optional<AnchorText> anchor;
  std::optional<JointText> joint, support;

  /// Returns whether the builder uses pairs (true) or nodes (false).
  bool on_pairs() const { return rod || cable || bar || joint || (box && box->along_pair); }
};

/// Laws of a model that an experiment may replace.
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
  ModelDef def;  ///< Laws and gravity of the whole model.
  InertiaLaw inertia = InertiaLaw::kExact;
  DampingLaw damping_law = DampingLaw::kExact;  ///< Default for cables without `damping_law`.
  std::optional<ActuatorText> actuator_text;    ///< Replaces the actuators of all cables.
  bool allow_disconnected = false;
  PartText loose;  ///< Nodes and pairs at the top level of the file.
  Named<PartText> parts_text;
  std::vector<PartText> parts;
  std::vector<PlacementText> structure;
  std::vector<BuilderText> builders;
  std::vector<std::vector<std::string>> apart;
  SourceRef apart_at;
  bool builders_complete = true;  ///< False: at least one builder could not be read.
  bool nodes_complete = true;  ///< False: at least one node, part or placement could not be read.
  bool pairs_complete = true;  ///< False: at least one pair could not be read.
};

/// Reads a model file with merged bases (`ReadMergedFile(path, "model", out)`).
ModelText ReadModelText(const Value& root, const Scope& scope);

// Final checks after all keys of a block have been read.
void FinishNodesAndPairs(const MapReader& map, bool loose, PartText& part);
void FinishStructure(const MapReader& map, ModelText& model);
void FinishBuilders(const MapReader& map, ModelText& model);

}  // namespace taut::description
