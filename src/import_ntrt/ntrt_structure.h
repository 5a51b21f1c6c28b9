/// NTRT structure as its files describe it: assembled but not built. In NTRT's frame (y up) and the
/// units of the files.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "import_ntrt/tag_set.h"
#include "math/vec.h"
#include "taut/diagnostics.h"
#include "taut/import_ntrt.h"

namespace taut::import_ntrt {

inline constexpr std::size_t kMostItems = 20000;  ///< Limit of nodes, and of pairs.
/// Limit of tag comparisons and node moves per structure, a few seconds of one core.
inline constexpr std::uint64_t kMostComparisons = 200'000'000;

struct Node {
  Words tags;  ///< The first tag is its name.
  SourceRef at;
  int structure = 0;
  Vec3 in_file;  ///< Position in the file, with all scale factors applied.
  Vec3 place;
};

struct Pair {
  int from = 0, to = 0;  ///< Ends of the pair: indices of nodes.
  Words tags;
  SourceRef at;
  int structure = 0;  ///< Structure that contains the pair. Its nodes may belong to substructures.
  bool removed = false;
};

/// File placed in the model: `place = shift + turn(in_file)` for its direct nodes.
struct Structure {
  Words tags;  ///< Words of its name; empty for the top-level structure.
  int parent = -1;
  std::vector<int> children, nodes, pairs;
  std::string file;
  SourceRef at;
  Quat turn;
  Vec3 shift;
};

enum class Class { kRod, kBox, kSphere, kBasic, kBasicContact, kKinematic, kKinematicContact };
const char* NameOf(Class kind);
inline bool IsSolid(Class kind) { return kind <= Class::kSphere; }

/// NTRT's parameters of all builder classes, with the defaults of its YAML reader
/// (TensegrityModel.h).
struct Parameters {
  double radius = 0.5, density = 1.0, friction = 1.0, roll_friction = 0.0, restitution = 0.2;
  double width = 1.0, height = 1.0;  ///< Half extents of a box.
  double stiffness = 1000.0, damping = 10.0, pretension = 0.0, history = 0.0;
  double max_tension = 1000.0, target_velocity = 100.0;
  double min_actual_length = 0.1, min_rest_length = 0.1, rotation = 0.0;
  double motor_radius = 1.0, motor_friction = 0.0, motor_inertia = 1.0, back_drivable = 0.0;
  bool move_from_to_edge = true, move_to_to_edge = true;
};

/// Builder of the pairs or nodes that have all tags in `search`. If several builders match, the
/// last one applies.
struct Builder {
  Words search;
  Class kind = Class::kRod;
  Parameters is;
  std::map<std::string, SourceRef> written;  ///< Parameters in the file, with their positions.
  SourceRef at;
};

/// Structure tree of all files. References are indices, not pointers.
struct Model {
  std::vector<Structure> structures;  ///< The top-level structure is first.
  std::vector<Node> nodes;
  std::vector<Pair> pairs;
  std::vector<Builder> builders;
  NtrtCounts counts;
  bool full = false;  ///< A limit was exceeded and reported, so nothing more is added.
  /// Number of comparisons of tags and positions, and of node moves. Searches for names, bonds and
  /// builders are linear, so a small file could take hours. Beyond kMostComparisons, searches find
  /// nothing and the structure is rejected.
  mutable std::uint64_t comparisons = 0;

  /// Counts a comparison of two lists of tags. Returns false beyond the limit.
  bool MayCompare(const Words& words, const Words& wanted) const {
    comparisons += 1 + words.size() * wanted.size();
    return comparisons <= kMostComparisons;
  }
  bool ComparedTooMuch() const { return comparisons > kMostComparisons; }

  /// Returns the nearest descendant structure with this name, level by level; -1 if there is none.
  int FindChild(int structure, const std::string& name) const;
  /// Returns the node with this name in the structure or its descendants; -1 if there is none.
  int FindNode(int structure, const std::string& name) const;
  /// Returns a pair between two positions, in either order, in the structure or its descendants; -1
  /// if there is none.
  int FindPair(int structure, const Vec3& a, const Vec3& b) const;

  void Turn(int structure, const Vec3& about, const Quat& q);
  void Shift(int structure, const Vec3& by);
  /// Scales the structure about the centroid of its nodes.
  void Scale(int structure, double factor);
  Vec3 Centroid(int structure) const;

 private:
  template <class F>
  void ForEachBelow(int structure, const F& visit) const;
};

/// Returns whether NTRT treats two positions as equal: it compares squared distances with the
/// machine epsilon of double.
inline bool SamePlace(const Vec3& a, const Vec3& b) { return Dot(b - a, b - a) < 2.3e-16; }

/// Reads a file and all included files. Returns nothing after an error.
std::optional<Model> ReadStructure(const std::string& path, const NtrtOptions& options,
                                   Diagnostics& out);

}  // namespace taut::import_ntrt
