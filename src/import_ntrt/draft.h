/// Draft of a model file: taut's names and tags, SI units, z up.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "import_ntrt/ntrt_build.h"
#include "import_ntrt/si.h"

namespace taut::import_ntrt {

struct DraftNode {
  std::string name, full_name;
  Words tags;         ///< Tags of the node, without its name.
  int structure = 0;  ///< NTRT structure of the node; -1: unused, not written.
  Vec3 at_m;          ///< Position in the frame of its structure's file.
  std::string fixed_to;
};

struct DraftPair {
  int from = 0, to = 0;  ///< Ends of the pair: indices of draft nodes.
  Words tags;
  std::string name;   ///< Empty: taut names the pair after its nodes.
  int structure = 0;  ///< NTRT structure that contains the pair.
  int number = 0;     ///< Position in that structure's file.
};

/// Key of a builder, with a number or a text.
struct Field {
  std::string key;
  double number = 0.0;
  std::string text = {};  ///< If not empty, replaces the number.
};

/// Pairs or nodes of one builder of the model.
struct Group {
  std::string kind;  ///< "rod", "cable", ...
  std::vector<Field> fields, actuator;
  std::string comment;
  bool on_nodes = false;
  std::vector<int> items;
  std::vector<Words> keys;  ///< Per item: tags by which NTRT's builder selected it.

  std::string Text() const;  ///< Text of the builder without its items. Groups with equal texts are
                             ///< merged.
};

struct Draft {
  std::vector<std::string> placements;  ///< Name of each structure; empty for the top-level
                                        ///< structure.
  std::vector<DraftNode> nodes;         ///< NTRT's nodes in their order, then additional ones.
  std::vector<DraftPair> pairs;
  std::vector<Group> groups;
};

Draft MakeDraft(const Model& model, const Built& built, double length_unit_m);

/// Adds groups to the draft. Adds tags if NTRT's tags do not distinguish groups. Lists features in
/// `import` that taut's models lack.
void AddGroups(const Model& model, const Built& built, const NtrtOptions& options, Draft& draft,
               NtrtImport& import, Diagnostics& out);

/// Named parameter: a number that occurs several times, or that users may want to change.
struct Parameter {
  std::string name;
  double value = 0.0;
};
std::vector<Parameter> TakeOutParameters(std::vector<Group>& groups);

// Each function returns a block of the model file.
std::string BuildersText(const Draft& draft);
std::string PartsText(const Model& model, const Draft& draft, double length_unit_m);

}  // namespace taut::import_ntrt
