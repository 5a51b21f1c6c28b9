/// Draft of a model file: names and tags of taut, in SI, z up.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "import_ntrt/ntrt_build.h"
#include "import_ntrt/si.h"

namespace taut::import_ntrt {

struct DraftNode {
  std::string name, full_name;
  Words tags;         ///< Besides its name.
  int structure = 0;  ///< -1: not used, left out.
  Vec3 at_m;          ///< In the frame of its structure's file.
  std::string fixed_to;
};

struct DraftPair {
  int from = 0, to = 0;  ///< Draft nodes.
  Words tags;
  std::string name;   ///< Empty: named after its nodes.
  int structure = 0;  ///< NTRT structure that contains it.
  int number = 0;     ///< In the order of that structure's file.
};

/// A key of a builder: a number or a text.
struct Field {
  std::string key;
  double number = 0.0;
  std::string text = {};  ///< If not empty, instead of the number.
};

/// Pairs or nodes that one builder of a model builds.
struct Group {
  std::string kind;  ///< rod, cable ...
  std::vector<Field> fields, actuator;
  std::string comment;
  bool on_nodes = false;
  std::vector<int> items;
  std::vector<Words> keys;  ///< Per item: the tags by which NTRT's builder found it.

  std::string Text() const;  ///< Text without the items: groups with equal texts share a builder.
};

struct Draft {
  std::vector<std::string> placements;  ///< Per structure: its name; empty for the topmost.
  std::vector<DraftNode> nodes;         ///< NTRT's nodes by their numbers, then added ones.
  std::vector<DraftPair> pairs;
  std::vector<Group> groups;
};

Draft MakeDraft(const Model& model, const Built& built, double length_unit_m);

/// Adds the groups to the draft, and tags where NTRT's tags do not distinguish them. Features of
/// NTRT that the model lacks are listed in `import`.
void AddGroups(const Model& model, const Built& built, const NtrtOptions& options, Draft& draft,
               NtrtImport& import, Diagnostics& out);

/// Named parameters: numbers that occur several times, or that users will want to change.
struct Parameter {
  std::string name;
  double value = 0.0;
};
std::vector<Parameter> TakeOutParameters(std::vector<Group>& groups);

// Blocks of the file.
std::string BuildersText(const Draft& draft);
std::string PartsText(const Model& model, const Draft& draft, double length_unit_m);

}  // namespace taut::import_ntrt
