// Application of mappings to traces and tables.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "base/pattern.h"
#include "taut/compare.h"
#include "taut/run_folder.h"

namespace taut {
namespace {

bool IsPattern(const std::string& from) { return from.find('*') != from.npos; }

/// Finds the first rule for a name. Rules without `*` are found in a hash table, because a log and
/// its mapping may have 100,000 columns each.
class RuleFinder {
 public:
  explicit RuleFinder(const std::vector<Mapping::Rule>& rules) : rules_(rules) {
    for (std::size_t i = 0; i < rules.size(); ++i) {
      if (IsPattern(rules[i].from)) {
        patterns_.push_back(i);
      } else {
        exact_.emplace(rules[i].from, i);
      }
    }
  }
  /// Returns the rule and the text for its `*`; null if no rule applies.
  const Mapping::Rule* Find(const std::string& name, std::string& wildcard) const {
    const auto exact = exact_.find(name);
    for (const std::size_t i : patterns_) {
      if (exact != exact_.end() && exact->second < i) break;
      const auto fits = base::Wildcard(rules_[i].from, name);
      if (!fits) continue;
      wildcard = *fits;
      return &rules_[i];
    }
    wildcard.clear();
    return exact == exact_.end() ? nullptr : &rules_[exact->second];
  }

 private:
  const std::vector<Mapping::Rule>& rules_;
  std::unordered_map<std::string_view, std::size_t> exact_;
  std::vector<std::size_t> patterns_;
};

}  // namespace

std::optional<Trace> ApplyMapping(const Mapping& mapping, Trace trace, const std::string& path,
                                  Diagnostics& out) {
  std::set<std::string> names;
  bool good = true;
  const RuleFinder finder(mapping.rules);
  std::string wildcard;
  for (std::size_t i = 0; i < trace.channels.size(); ++i) {
    ChannelInfo& channel = trace.channels[i];
    if (const Mapping::Rule* const rule = finder.Find(channel.name, wildcard)) {
      std::string name = rule->to;
      if (const std::size_t star = name.find('*'); star != name.npos) {
        name.replace(star, 1, wildcard);
      }
      channel = {name, rule->unit.empty() ? UnitOfName(name) : rule->unit, rule->period};
      for (double& value : trace.values[i]) value = rule->scale * value + rule->offset;
    }
    if (!names.insert(channel.name).second) {
      out.Error("mapping.duplicate_channel", {path},
                fmt::format("the mapping creates the channel {} twice", channel.name));
      good = false;
    }
  }
  if (!good) return std::nullopt;
  return trace;
}

std::optional<Trace> ReadMapped(const std::string& path, const Mapping& mapping,
                                const std::string& mapping_path, Diagnostics& out) {
  auto trace = mapping.table ? ReadTable(path, *mapping.table, out) : ReadTraceOfRun(path, out);
  if (!trace) return std::nullopt;
  bool good = true;
  if (mapping.table) {
    std::vector<std::string> names;
    for (const ChannelInfo& channel : trace->channels) names.push_back(channel.name);
    const std::unordered_set<std::string_view> known(names.begin(), names.end());
    for (const Mapping::Rule& rule : mapping.rules) {
      const bool fits = IsPattern(rule.from)
                            ? std::any_of(names.begin(), names.end(),
                                          [&](const std::string& name) {
                                            return base::Wildcard(rule.from, name).has_value();
                                          })
                            : known.contains(rule.from);
      if (fits) continue;
      out.Error("mapping.no_column", {mapping_path},
                fmt::format("{} has no column \"{}\"", path, rule.from),
                DidYouMean(rule.from, names));
      good = false;
    }
  }
  if (!good) return std::nullopt;
  return ApplyMapping(mapping, std::move(*trace), path, out);
}

std::optional<Trace> ReadTraceOrLog(const std::string& path, const std::string& mapping_path,
                                    const std::string& use, Diagnostics& out, bool* is_log) {
  std::optional<Trace> trace;
  if (mapping_path.empty()) {
    trace = ReadTraceOfRun(path, out);
  } else if (const auto mapping = LoadMapping(mapping_path, out)) {
    if (is_log != nullptr) *is_log = mapping->table.has_value() || path.ends_with(".mcap");
    trace = ReadMapped(path, *mapping, mapping_path, out);
  }
  if (trace) WarnIfUnfinished(*trace, path, use, out);
  return trace;
}

}  // namespace taut
