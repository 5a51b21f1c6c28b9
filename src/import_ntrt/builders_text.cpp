// YAML text of builders and parameters.
#include <algorithm>
#include <map>
#include <set>

#include "import_ntrt/draft.h"

namespace taut::import_ntrt {
namespace {

/// Converts a tag to a name that is valid in an expression.
std::string Identifier(const std::string& tag) {
  std::string name = tag;
  for (char& c : name) {
    if (c == '-' || c == '.') c = '_';
  }
  const bool digit = !name.empty() && name[0] >= '0' && name[0] <= '9';
  return digit ? "cable_" + name : name;
}

std::string FlowText(const std::vector<Field>& fields) {
  std::string text;
  for (const Field& field : fields) {
    text += (text.empty() ? "{" : ", ") + field.key + ": " +
            (field.text.empty() ? NumberText(field.number) : field.text);
  }
  return text.empty() ? "{}" : text + "}";
}

std::string MatchText(const std::vector<Words>& keys) {
  const auto set = [](const Words& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "[" : ", ") + word;
    return text + "]";
  };
  if (keys.size() == 1) return keys[0].size() == 1 ? keys[0][0] : set(keys[0]);
  std::string text;
  for (const Words& key : keys) text += (text.empty() ? "[" : ", ") + set(key);
  return text + "]";
}

class Namer {
 public:
  explicit Namer(std::vector<Group>& groups) : groups_(groups) {}

  std::vector<Parameter> Run() {
    std::size_t cables = 0;
    for (const Group& group : groups_) cables += group.kind == "cable" ? 1 : 0;
    ForNumbers([&](Group& group, Field& field) {
      if (field.key != "prestress_n") return;
      const std::string tag = group.keys[0].empty() ? "" : group.keys[0].back();
      Name(field, cables == 1 ? "prestress_n" : Identifier(tag) + "_prestress_n");
    });
    std::map<std::pair<std::string, std::string>, int> count;
    ForNumbers([&](Group&, Field& field) { ++count[{field.key, NumberText(field.number)}]; });
    std::map<std::pair<std::string, std::string>, std::string> names;
    ForNumbers([&](Group&, Field& field) {
      const std::pair key(field.key, NumberText(field.number));
      if (count[key] < 2) return;
      const auto named = names.find(key);
      if (named != names.end()) {
        field.text = named->second;
      } else {
        Name(field, field.key);
        names[key] = field.text;
      }
    });
    return std::move(parameters_);
  }

 private:
  template <class F>
  void ForNumbers(const F& visit) {
    for (Group& group : groups_) {
      for (Field& field : group.fields) {
        if (field.text.empty()) visit(group, field);
      }
    }
  }

  void Name(Field& field, const std::string& wanted) {
    std::string name = wanted;
    for (int i = 2; !taken_.insert(name).second; ++i) name = wanted + "_" + std::to_string(i);
    parameters_.push_back({name, Rounded15(field.number)});
    field.text = name;
  }

  std::vector<Group>& groups_;
  std::vector<Parameter> parameters_;
  std::set<std::string> taken_;
};

}  // namespace

std::vector<Parameter> TakeOutParameters(std::vector<Group>& groups) { return Namer(groups).Run(); }

std::string BuildersText(const Draft& draft) {
  std::string text = "\nbuilders:\n";
  std::map<std::string, int> uses;
  for (const Group& group : draft.groups) ++uses[FlowText(group.actuator)];
  std::map<std::string, std::string> motors;  // actuator text -> YAML anchor: each actuator is
                                              // written once
  for (const Group& group : draft.groups) {
    const std::string match = MatchText(group.keys);
    if (group.kind != "cable") {
      text += "  - {match: " + match + ", " + group.kind + ": " + FlowText(group.fields) + "}  # " +
              group.comment + "\n";
      continue;
    }
    text += "  - match: " + match + "  # " + group.comment + "\n    cable:\n";
    for (const Field& field : group.fields) {
      text += "      " + field.key + ": " +
              (field.text.empty() ? NumberText(field.number) : field.text) + "\n";
    }
    if (group.actuator.empty()) continue;
    const std::string motor = FlowText(group.actuator);
    std::string& anchor = motors[motor];
    text += "      actuator: ";
    if (!anchor.empty()) {
      text += "*" + anchor + "\n";
      continue;
    }
    anchor = motors.size() == 1 ? "motor" : "motor_" + std::to_string(motors.size());
    text += (uses[motor] > 1 ? "&" + anchor + " " : "") + motor + "\n";
  }
  return text;
}

}  // namespace taut::import_ntrt
