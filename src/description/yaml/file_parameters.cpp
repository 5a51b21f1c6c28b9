#include "description/yaml/file_parameters.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "description/yaml/quantity.h"
#include "description/yaml/reader.h"

namespace taut::description {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Finds a cycle of parameters, such as a -> b -> a, among parameters that cannot be evaluated.
/// `waits_for[i]`: an unevaluated parameter to which `i` refers.
std::vector<std::size_t> FindCircle(const std::unordered_map<std::size_t, std::size_t>& waits_for,
                                    std::size_t start) {
  std::vector<std::size_t> path;
  std::unordered_map<std::size_t, std::size_t> place;
  std::size_t at = start;
  while (place.emplace(at, path.size()).second) {
    path.push_back(at);
    at = waits_for.at(at);
  }
  path.erase(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(place[at]));
  return path;
}

}  // namespace

OverrideSet::OverrideSet(const Overrides& overrides) {
  for (const auto& [name, expression] : overrides) {
    items_.push_back({{name, expression, {"--set " + name + "=" + expression, 0, 0}}, false});
  }
}

void OverrideSet::Apply(std::vector<ParameterText>& parameters) {
  for (Item& item : items_) {
    for (ParameterText& parameter : parameters) {
      if (parameter.name != item.text.name) continue;
      parameter = item.text;
      item.used = true;
    }
  }
}

void OverrideSet::Silence() {
  for (Item& item : items_) item.used = true;
}

void OverrideSet::Add(ParameterText parameter) { items_.push_back({std::move(parameter), false}); }

std::vector<ParameterText> OverrideSet::Unused() const {
  std::vector<ParameterText> unused;
  for (const Item& item : items_) {
    if (!item.used) unused.push_back(item.text);
  }
  return unused;
}

void OverrideSet::ReportUnused(const std::vector<std::string>& known, Diagnostics& out) const {
  for (const ParameterText& parameter : Unused()) ReportUnknownParameter(parameter, known, out);
}

void ReportUnknownParameter(const ParameterText& parameter, const std::vector<std::string>& known,
                            Diagnostics& out) {
  out.Error("parameter.unknown", parameter.at, "there is no parameter \"" + parameter.name + "\"",
            known.empty()         ? "the file has no parameters"
            : known.size() <= 300 ? KeyHint(parameter.name, known)
                                  : "");
}

std::vector<ParameterText> ReadParameters(const Value* block, Diagnostics& out) {
  std::vector<ParameterText> parameters;
  if (!block) return parameters;
  if (block->kind != Value::Kind::kMap) {
    out.Error("parameter.not_a_map", block->at,
              "parameters must be a map, got " + std::string(KindName(*block)),
              "write `parameters: {edge_m: 0.4}`");
    return parameters;
  }
  for (const Entry& entry : block->entries) {
    if (!IsIdentifier(entry.key)) {
      out.Error("parameter.bad_name", entry.key_at,
                "\"" + entry.key + "\" cannot be the name of a parameter",
                "use letters, digits and _, and no digit first");
    } else if (IsReservedName(entry.key)) {
      out.Error("parameter.reserved_name", entry.key_at,
                "\"" + entry.key + "\" is the name of a function or constant");
    } else if (entry.value->kind != Value::Kind::kScalar) {
      out.Error("parameter.not_a_number", entry.value->at,
                "parameters." + entry.key + " must be a number or an expression, got " +
                    std::string(KindName(*entry.value)));
      parameters.push_back({entry.key, "", {}});  // uses of the name cause no further error
    } else {
      parameters.push_back({entry.key, entry.value->text, entry.value->at});
    }
  }
  return parameters;
}

void MergeParameters(std::vector<ParameterText>& base, const std::vector<ParameterText>& changes) {
  std::unordered_map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < base.size(); ++i) places[base[i].name] = i;
  for (const ParameterText& change : changes) {
    const auto found = places.find(change.name);
    if (found == places.end()) {
      base.push_back(change);
    } else {
      base[found->second] = change;
    }
  }
}

void WarnOfUnused(const std::vector<ParameterText>& parameters, NameSet used,
                  const std::vector<std::string>& files, Diagnostics& out) {
  std::vector<std::string> open(used.begin(), used.end());
  std::unordered_map<std::string, const ParameterText*> by_name;
  for (const ParameterText& parameter : parameters) by_name[parameter.name] = &parameter;
  while (!open.empty()) {
    const auto found = by_name.find(open.back());
    open.pop_back();
    if (found == by_name.end()) continue;
    for (std::string& name : NamesIn(found->second->expression)) {
      if (used.insert(name).second) open.push_back(std::move(name));
    }
  }
  for (const ParameterText& parameter : parameters) {
    const bool of_base =
        std::find(files.begin() + 1, files.end(), parameter.at.file) != files.end();
    if (of_base || used.contains(parameter.name)) continue;
    out.Warning("parameter.unused", parameter.at,
                "the parameter \"" + parameter.name + "\" is not used",
                "remove it, or use it in an expression");
  }
}

NameTable ResolveParameters(const std::vector<ParameterText>& parameters, Diagnostics& out) {
  // Topological order (Kahn's algorithm). Recursion could overflow the stack, since chains may have
  // any length.
  std::unordered_map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < parameters.size(); ++i) places[parameters[i].name] = i;
  std::vector<std::vector<std::size_t>> users(parameters.size()), needs(parameters.size());
  std::vector<std::size_t> open(parameters.size()), ready;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    for (const std::string& name : NamesIn(parameters[i].expression)) {
      const auto found = places.find(name);
      if (found == places.end()) continue;  // unknown name: the evaluation reports it later
      needs[i].push_back(found->second);
      users[found->second].push_back(i);
    }
    open[i] = needs[i].size();
    if (open[i] == 0) ready.push_back(i);
  }

  // Contains all names from the start, so that hints can suggest them.
  NameTable values;
  for (const ParameterText& parameter : parameters) values[parameter.name] = kUnknown;
  std::vector<bool> done(parameters.size(), false);
  const auto evaluate = [&](std::size_t i) {
    const ParameterText& parameter = parameters[i];
    done[i] = true;
    if (parameter.at.file.empty()) return;  // already reported by the reader
    Evaluated result = EvaluateQuantity(parameter.expression, values, parameter.name);
    if (!result.error.empty()) {
      out.Error("parameter.bad_expression", parameter.at,
                "parameters." + parameter.name + ": " + result.error, std::move(result.hint));
    }
    values[parameter.name] = result.value;
  };
  for (std::size_t next = 0; next < ready.size(); ++next) {
    const std::size_t i = ready[next];
    evaluate(i);
    for (const std::size_t user : users[i]) {
      if (--open[user] == 0) ready.push_back(user);
    }
  }

  // All remaining parameters belong to a cycle or depend on one.
  std::unordered_map<std::size_t, std::size_t> waits_for;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    for (const std::size_t need : needs[i]) {
      if (!done[i] && !done[need]) waits_for[i] = need;
    }
  }
  std::vector<bool> reported(parameters.size(), false);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (done[i]) continue;
    std::vector<std::size_t> circle = FindCircle(waits_for, i);
    std::rotate(circle.begin(), std::min_element(circle.begin(), circle.end()), circle.end());
    if (reported[circle[0]]) continue;
    reported[circle[0]] = true;
    std::string path;
    for (const std::size_t member : circle) path += parameters[member].name + " -> ";
    out.Error("parameter.circle", parameters[circle[0]].at,
              "parameters refer to each other in a circle: " + path + parameters[circle[0]].name);
  }
  return values;
}

}  // namespace taut::description
