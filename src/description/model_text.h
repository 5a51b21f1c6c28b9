/// A model file as read, before anything is placed or built: names, tags and numbers with their
/// places in the file.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "description/merged_file.h"
#include "description/parameters.h"
#include "description/reader.h"
#include "taut/spec.h"

namespace taut::description {

inline constexpr int kMaxModelNodes = 100'000;
inline constexpr int kMaxModelEnds = 400'000;  ///< Nodes of all pairs together.
inline constexpr int kMaxTags = 32;            ///< Of one node, pair or placement.
inline constexpr int kMaxCopies = 10'000;
inline constexpr int kMaxBuilders = 1'000;

/// A text and where it stands.
struct Placed {
  std::string text;
  SourceRef at;
};

struct NodeText {
  std::string name;
  SourceRef at;
  Vec3 at_m;  ///< In the part's frame.
  Tags tags;
  Placed fixed_to;  ///< Another node of the part whose body this one belongs to; may be empty.
};

struct PairText {
  std::string name;  ///< Empty: made from the nodes.
  SourceRef at;
  std::vector<Placed> nodes;  ///< 2 or more.
  Tags tags;
};

struct PartText {
  std::string name;
  std::vector<NodeText> nodes;
  std::vector<PairText> pairs;
};

/// An entry of `structure:`.
struct PlacementText {
  std::string name;
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
  std::vector<PairText> connect;  ///< Node k of a pair is on copy i + k.
  bool ring = false;              ///< Copy 0 follows the last one.
};

/// A mass as files may give it.
struct MassText {
  enum class Kind { kTotal, kDensity, kPerLength };
  Kind kind = Kind::kTotal;
  double value = NAN;  ///< [kg], [kg/m^3] or [kg/m]; NaN after a complaint.
};

struct RodBuilder {
  double radius_m = 0.0;
  MassText mass;
  Material material;
  bool collides = true;
};
/// A box along a pair.
struct BeamBuilder {
  double width_m = 0.0, height_m = 0.0;
  MassText mass;
  Material material;
  bool collides = true;
};
struct CableBuilder {
  enum class Rest { kPrestress, kLength, kRatio };
  double stiffness_n_per_m = 0.0, damping_n_s_per_m = 0.0;
  Rest rest = Rest::kLength;
  double rest_value = NAN;  ///< [N], [m] or 1; NaN after a complaint.
  SourceRef rest_at;
  DampingLaw damping_law = DampingLaw::kExact;
  bool ends_on_surface = false;
  SourceRef ends_at;
  ActuatorDef actuator;
};
struct SphereBuilder {
  double radius_m = 0.0;
  MassText mass;
  Material material;
  bool collides = true;
};
struct PointMassBuilder {
  double mass_kg = 0.0;
  double radius_m = 0.0;  ///< Of the solid sphere that gives it its inertia; touches nothing.
};
/// A box at a node.
struct BoxBuilder {
  Vec3 size_m;
  MassText mass;
  Material material;
  bool collides = true;
};
struct AnchorBuilder {};

using Match = std::vector<std::vector<std::string>>;

/// An entry of `builders:`: what becomes of the pairs or nodes that carry the tags.
struct BuilderText {
  SourceRef at;
  SourceRef match_at;
  Match match;
  std::string kind;  ///< As written: "rod", "cable" ...
  std::variant<RodBuilder, BeamBuilder, CableBuilder, SphereBuilder, PointMassBuilder, BoxBuilder,
               AnchorBuilder>
      build;

  /// True for what goes on pairs, false for what goes on nodes.
  bool on_pairs() const { return build.index() <= 2; }
};

struct ModelText {
  std::string name, description;
  SourceRef at;
  Vec3 gravity_m_per_s2{0.0, 0.0, -9.81};
  CombineRule friction_combine = CombineRule::kGeometricMean;
  CombineRule restitution_combine = CombineRule::kMaximum;
  FrictionLaw friction_law = FrictionLaw::kCone;
  bool bounding_box_inertia = false;
  bool allow_disconnected = false;
  PartText loose;  ///< The nodes and pairs at the top of the file.
  std::vector<PartText> parts;
  std::vector<PlacementText> structure;
  std::vector<BuilderText> builders;
  bool builders_complete = true;  ///< False: at least one could not be read.
  bool nodes_complete = true;  ///< False: at least one node, part or placement could not be read.
  bool pairs_complete = true;  ///< False: at least one pair could not be read.
};

/// Reads the top of a model file, bases merged in (`ReadMergedFile(path, "model", out)`).
ModelText ReadModelText(const Value& root, const Scope& scope);

// The blocks of the file, each in a file of its own.
void ReadNodesAndPairs(const MapReader& map, PartText& part, ModelText& model);
std::vector<PairText> ReadPairs(const Value* list, const std::string& what, bool placed_names,
                                const Scope& scope);
std::vector<PlacementText> ReadStructure(const Value* list, ModelText& model, const Scope& scope);
std::vector<BuilderText> ReadBuilders(const Value* list, DampingLaw damping_law, bool& complete,
                                      const Scope& scope);

}  // namespace taut::description
