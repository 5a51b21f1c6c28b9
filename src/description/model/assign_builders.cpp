// Assignment of builders to nodes and pairs by selectors.
#include <algorithm>
#include <set>

#include "description/model/build.h"

namespace taut::description {
namespace {

/// Returns whether copies get this tag automatically: first, middle, last or a number.
bool IsCopyTag(const std::string& tag) {
  return tag == "first" || tag == "middle" || tag == "last" ||
         std::all_of(tag.begin(), tag.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool CouldMatch(const std::vector<std::string>& set, const std::vector<TagsInFile>& all) {
  return std::any_of(all.begin(), all.end(), [&](const TagsInFile& one) {
    return std::all_of(set.begin(), set.end(), [&](const std::string& tag) {
      return (one.copied && IsCopyTag(tag)) ||
             std::find(one.tags.begin(), one.tags.end(), tag) != one.tags.end();
    });
  });
}

template <class List>
bool MatchesAny(const std::vector<std::string>& set, const List& all) {
  return std::any_of(all.begin(), all.end(),
                     [&](const auto& one) { return Matches({set}, one.tags); });
}

std::string ShownTags(const std::vector<std::string>& set) {
  std::string shown;
  for (const std::string& tag : set) shown += (shown.empty() ? "[" : ", ") + tag;
  return shown + "]";
}

/// Returns a hint for the first tag of the set that no element of `all` has.
std::string TagHint(const std::vector<std::string>& set, const std::vector<TagsInFile>& all) {
  std::set<std::string> tags;
  for (const TagsInFile& one : all) {
    tags.insert(one.tags.begin(), one.tags.end());
    if (one.copied) tags.insert({"first", "middle", "last"});
  }
  for (const std::string& tag : set) {
    if (tags.count(tag) > 0) continue;
    return "tag " + tag + ": " + NameHint(tag, {tags.begin(), tags.end()});
  }
  return "no single element has all of these tags";
}

/// Reports selectors that match nothing for any number of copies. A selector may match nothing for
/// the present number: a spine of two segments has no middle segment.
void CheckMatches(const BuilderText& builder, const Assembly& assembly, Diagnostics& out) {
  const auto& mine = builder.on_pairs() ? assembly.pair_tags : assembly.node_tags;
  const auto& others = builder.on_pairs() ? assembly.node_tags : assembly.pair_tags;
  const char* const what = builder.on_pairs() ? "pair" : "node";
  const char* const other = builder.on_pairs() ? "nodes" : "pairs";
  for (const std::vector<std::string>& set : builder.match) {
    if (CouldMatch(set, mine)) continue;
    const bool placed =
        builder.on_pairs() ? MatchesAny(set, assembly.pairs) : MatchesAny(set, assembly.nodes);
    if (placed) continue;  // matched by a full name such as segment_0.tip
    out.Error("builder.matches_nothing", builder.match_at,
              std::string("no ") + what + " matches " + ShownTags(set),
              CouldMatch(set, others) ? "a " + builder.kind + " is made from " + what +
                                            "s, but these tags are on " + other
                                      : TagHint(set, mine));
  }
}

}  // namespace

Assignment AssignBuilders(const ModelText& model, const Assembly& assembly, Diagnostics& out) {
  Assignment assignment;
  assignment.of_pair.assign(assembly.pairs.size(), -1);
  assignment.of_node.resize(assembly.nodes.size());
  assignment.lump_kg.assign(assembly.nodes.size(), 0.0);
  std::set<std::pair<int, int>> clashes;  // report each pair of builders once, not once per node
  const auto clash = [&](int first, int second, const std::string& name) {
    if (!clashes.insert({first, second}).second) return;
    const BuilderText& a = model.builders[first];
    out.Error("builder.second_builder", model.builders[second].at,
              "\"" + name + "\" is already a " + a.kind + ", made by the builder in line " +
                  std::to_string(a.at.line),
              "change the tags so that only one of the two builders matches");
  };

  for (int b = 0; b < static_cast<int>(model.builders.size()); ++b) {
    const BuilderText& builder = model.builders[b];
    if (assembly.complete) CheckMatches(builder, assembly, out);
    if (builder.on_pairs()) {
      for (std::size_t pair = 0; pair < assembly.pairs.size(); ++pair) {
        if (!Matches(builder.match, assembly.pairs[pair].tags)) continue;
        int& taken = assignment.of_pair[pair];
        if (taken >= 0) {
          clash(taken, b, assembly.pairs[pair].name);
        } else {
          taken = b;
        }
      }
      continue;
    }
    for (std::size_t node = 0; node < assembly.nodes.size(); ++node) {
      if (!Matches(builder.match, assembly.nodes[node].tags)) continue;
      std::vector<int>& taken = assignment.of_node[node];
      const auto same = std::find_if(taken.begin(), taken.end(), [&](int other) {
        return model.builders[other].kind == builder.kind;
      });
      if (same != taken.end()) {
        clash(*same, b, assembly.nodes[node].name);
      } else {
        taken.push_back(b);
      }
    }
  }

  if (!model.builders_complete) return assignment;
  std::set<std::pair<int, int>> reported;  // report each place in the file once, not once per copy
  for (std::size_t pair = 0; pair < assembly.pairs.size(); ++pair) {
    const PlacedPair& placed = assembly.pairs[pair];
    if (assignment.of_pair[pair] >= 0 ||
        !reported.insert({placed.at.line, placed.at.column}).second) {
      continue;
    }
    out.Error("pair.no_builder", placed.at, "no builder matches the pair \"" + placed.name + "\"",
              placed.tags.empty() ? "it has no tags" : "its tags are " + ShownTags(placed.tags));
  }
  return assignment;
}

}  // namespace taut::description
