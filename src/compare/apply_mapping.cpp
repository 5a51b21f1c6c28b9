// Application of mappings to traces and tables.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/pattern.h"
#include "taut/compare.h"
#include "taut/run_folder.h"

namespace taut {

std::optional<Trace> ApplyMapping(const Mapping& mapping, Trace trace, const std::string& path,
                                  Diagnostics& out) {
  std::set<std::string> names;
  bool good = true;
  for (std::size_t i = 0; i < trace.channels.size(); ++i) {
    ChannelInfo& channel = trace.channels[i];
    for (const Mapping::Rule& rule : mapping.rules) {
      const auto wildcard = base::Wildcard(rule.from, channel.name);
      if (!wildcard) continue;
      std::string name = rule.to;
      if (const std::size_t star = name.find('*'); star != name.npos) {
        name.replace(star, 1, *wildcard);
      }
      channel = {name, rule.unit.empty() ? UnitOfName(name) : rule.unit, rule.period};
      for (double& value : trace.values[i]) value = rule.scale * value + rule.offset;
      break;
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
    for (const Mapping::Rule& rule : mapping.rules) {
      const bool fits = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
        return base::Wildcard(rule.from, name).has_value();
      });
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

}  // namespace taut
