// Serialization of a robot as a model file. Robots that the format cannot express are rejected.
// Known cases have a specific error; other cases are detected by reading the text back.
#include <algorithm>
#include <cmath>
#include <map>

#include "description/model/build.h"
#include "description/model/model.h"
#include "description/model/model_keys.h"
#include "description/write/model_write.h"
#include "description/yaml/laws.h"
#include "description/yaml/write_keys.h"
#include "math/vec.h"

namespace taut::description {
namespace {

std::string Name(const std::string& text) { return PlainOrQuoted(text); }

std::string TagsText(const Tags& tags, const Tags& implied) {
  std::string text;
  for (const std::string& tag : tags) {
    if (std::find(implied.begin(), implied.end(), tag) != implied.end()) continue;
    text += (text.empty() ? "" : ", ") + Name(tag);
  }
  return text.empty() ? "" : ", tags: [" + text + "]";
}

std::string ActuatorText(const ActuatorDef& a) {
  if (a.kind == ActuatorDef::Kind::kIdeal) return "{ideal: true}";
  if (a.kind == ActuatorDef::Kind::kDcMotor) {
    return "{min_rest_length_m: " + Shown(a.min_rest_length_m) +
           ", dc_motor: " + FlowWriter<false>::Text(*a.dc_motor) + "}";
  }
  std::string text;
  const auto add = [&](const char* key, double value) {
    text += (text.empty() ? "" : ", ") + std::string(key) + ": " + Shown(value);
  };
  const auto add_limit = [&](const char* key, double value) {
    if (std::isfinite(value)) add(key, value);
  };
  add_limit("max_speed_m_per_s", a.max_speed_m_per_s);
  add_limit("max_acceleration_m_per_s2", a.max_acceleration_m_per_s2);
  add_limit("max_force_n", a.max_force_n);
  add("min_rest_length_m", a.min_rest_length_m);
  if (a.min_length_m != 0) add("min_length_m", a.min_length_m);
  return "{" + text + "}";
}

class Writer {
 public:
  Writer(const RobotSpec& robot, WrittenModel model, Diagnostics& out)
      : robot_(robot), def_(robot.def), m_(std::move(model)), out_(out) {}

  std::string Text() {
    TagSolids();
    for (WrittenPair& pair : m_.pairs) NamePair(pair);
    return Head() + Nodes() + Pairs() + Structure() + Builders() + Laws();
  }

 private:
  void Refuse(const std::string& what, const std::string& hint = {}) {
    RefuseModel(out_, what, hint);
  }

  /// Adds a tag to the pairs of each builder, so that the builder needs no list of names: `rod`, or
  /// `rod_1`, `rod_2`, ...
  void TagSolids() {
    int number = 0;
    for (const WrittenBuilder& builder : m_.on_pairs) {
      std::string tag = builder.text.substr(0, builder.text.find(':'));
      if (m_.on_pairs.size() > 1) tag += "_" + std::to_string(++number);
      const bool taken = std::any_of(m_.pairs.begin(), m_.pairs.end(), [&](const WrittenPair& p) {
        return p.name == tag || ShortName(p.name) == tag ||
               std::find(p.tags.begin(), p.tags.end(), tag) != p.tags.end();
      });
      if (taken) continue;
      for (const int pair : builder.on)
        m_.pairs[static_cast<std::size_t>(pair)].tags.push_back(tag);
    }
  }

  /// Assigns a pair to a placement if the pair's name begins with the placement's name.
  void NamePair(WrittenPair& pair) {
    const auto [placement, given] = NameOf(m_, pair);
    const bool inside = !placement.empty();
    if (!given.empty() && !IsName(given)) {
      Refuse("\"" + pair.name + "\" cannot be the name of a pair",
             "give the pair a `name:` in the model");
    }
    pair.placement = placement;
    pair.line = given.empty() ? "{" : "{name: " + Name(given) + ", ";
    pair.line += "nodes: [";
    for (std::size_t i = 0; i < pair.nodes.size(); ++i) {
      const std::string& name = m_.nodes[static_cast<std::size_t>(pair.nodes[i])].name;
      pair.line += (i == 0 ? "" : ", ") + Name(inside ? ShortName(name) : name);
    }
    pair.line += "]" + TagsText(pair.tags, {given, pair.name}) + "}";
    for (const std::string& name : {given, pair.name}) {  // the reader adds these tags, too
      if (!name.empty()) pair.tags.push_back(name);
    }
  }

  std::string NodeLine(const WrittenNode& node, const Quat& turn) const {
    const Vec3 p = Rotate(Conjugate(turn), node.position_m);
    std::string line = Name(ShortName(node.name)) + ": ";
    const std::string at = "[" + Shown(p.x) + ", " + Shown(p.y) + ", " + Shown(p.z) + "]";
    std::string more = TagsText(node.tags, {ShortName(node.name), node.name});
    if (node.fixed_to >= 0) {
      more +=
          ", fixed_to: " + Name(ShortName(m_.nodes[static_cast<std::size_t>(node.fixed_to)].name));
    }
    return line + (more.empty() ? at : "{at_m: " + at + more + "}") + "\n";
  }

  std::string NodesOf(const std::string& placement, const std::string& indent) const {
    const auto turn = m_.turns.find(placement);
    std::string text;
    for (const WrittenNode& node : m_.nodes) {
      if (PlacementOf(node.name) != placement) continue;
      text += indent + "  " + NodeLine(node, turn == m_.turns.end() ? Quat{} : turn->second);
    }
    return text.empty() ? "" : indent + "nodes:\n" + text;
  }
  std::string PairsOf(const std::string& placement, const std::string& indent) const {
    std::string text;
    for (const WrittenPair& pair : m_.pairs) {
      if (pair.placement == placement) text += indent + "  - " + pair.line + "\n";
    }
    return text.empty() ? "" : indent + "pairs:\n" + text;
  }

  std::string Head() const { return "taut: 1\nkind: model\nname: " + Name(def_.name) + "\n"; }
  std::string Nodes() const {
    const std::string text = NodesOf("", "");
    return text.empty() ? "" : "\n" + text;
  }
  std::string Pairs() const {
    const std::string text = PairsOf("", "");
    return text.empty() ? "" : "\n" + text;
  }
  std::string Structure() const {
    std::vector<std::string> placements;
    for (const WrittenNode& node : m_.nodes) {
      const std::string placement = PlacementOf(node.name);
      if (placement.empty()) continue;
      if (std::find(placements.begin(), placements.end(), placement) == placements.end()) {
        placements.push_back(placement);
      }
    }
    if (placements.empty()) return {};
    std::string parts = "\nparts:\n", structure = "\nstructure:\n";
    for (const std::string& placement : placements) {
      parts +=
          "  " + Name(placement) + ":\n" + NodesOf(placement, "    ") + PairsOf(placement, "    ");
      structure += "  - {part: " + Name(placement);
      const auto turn = m_.turns.find(placement);
      if (turn != m_.turns.end()) {
        const Quat& q = turn->second;
        structure += ", rotate: {quaternion: [" + Shown(q.w) + ", " + Shown(q.x) + ", " +
                     Shown(q.y) + ", " + Shown(q.z) + "]}";
      }
      structure += "}\n";
    }
    return parts + structure;
  }

  /// Returns the selector of a builder: a tag that all its elements and no others have, or their
  /// names.
  template <class Items>
  std::string MatchText(const std::vector<int>& on, const Items& items) {
    const auto has = [&](int i, const std::string& tag) {
      const auto& item = items[static_cast<std::size_t>(i)];
      return item.name == tag ||
             std::find(item.tags.begin(), item.tags.end(), tag) != item.tags.end();
    };
    const auto is_on = [&](int i) { return std::find(on.begin(), on.end(), i) != on.end(); };
    const auto only_these = [&](const std::string& tag) {
      for (int i = 0; i < static_cast<int>(items.size()); ++i) {
        if (has(i, tag) && !is_on(i)) return false;
      }
      return true;
    };
    for (const std::string& tag : items[static_cast<std::size_t>(on[0])].tags) {
      const bool all = std::all_of(on.begin(), on.end(), [&](int i) { return has(i, tag); });
      if (all && only_these(tag)) return Name(tag);
    }
    std::string text;
    for (const int i : on) {
      const std::string& name = items[static_cast<std::size_t>(i)].name;
      if (!only_these(name)) Refuse("\"" + name + "\" is both a name and a tag of another element");
      text += (text.empty() ? "[[" : "], [") + Name(name);
    }
    return on.size() == 1 ? Name(items[static_cast<std::size_t>(on[0])].name) : text + "]]";
  }

  std::string Builders() {
    std::string text = "\nbuilders:\n";
    for (const WrittenBuilder& b : m_.on_pairs) {
      text += "  - {match: " + MatchText(b.on, m_.pairs) + ", " + b.text + "}\n";
    }
    for (const WrittenBuilder& b : m_.on_nodes) {
      text += "  - {match: " + MatchText(b.on, m_.nodes) + ", " + b.text + "}\n";
    }
    return text + CableBuilders();
  }

  /// Writes one builder per cable, because rest lengths differ. A YAML anchor contains the other
  /// keys, which are usually the same.
  std::string CableBuilders() {
    const auto kind_of = [&](std::size_t i) {
      const CableDef& cable = def_.cables[static_cast<std::size_t>(m_.cables[i])];
      std::string kind = "stiffness_n_per_m: " + Shown(cable.stiffness_n_per_m);
      kind += ", damping_n_s_per_m: " + Shown(cable.damping_n_s_per_m);
      if (cable.damping_law == DampingLaw::kClamped) kind += ", damping_law: clamped";
      for (const auto& [name, touches] : kCableTouches) {
        if (touches != cable.touches || touches == CableTouches::kNone) continue;
        kind += ", touches: " + name + ", radius_m: " + Shown(cable.radius_m);
        if (cable.touch_friction == 0) continue;
        kind += ", touch_friction: " + Shown(cable.touch_friction);
      }
      kind += MemberText(cable.member);
      if (cable.actuator.kind == ActuatorDef::Kind::kNone) return kind;
      return kind + ", actuator: " + ActuatorText(cable.actuator);
    };
    std::map<std::string, int> count, number;
    for (std::size_t i = 0; i < m_.cables.size(); ++i) ++count[kind_of(i)];
    std::string text;
    for (std::size_t i = 0; i < m_.cables.size(); ++i) {
      const std::string kind = kind_of(i);
      const auto [anchor, fresh] = number.emplace(kind, static_cast<int>(number.size()) + 1);
      const std::string called = "cable_" + std::to_string(anchor->second);
      const std::string mark = count[kind] > 1 ? "&" + called + " " : "";
      const double rest_m = def_.cables[static_cast<std::size_t>(m_.cables[i])].rest_length_m;
      text += "  - {match: " + MatchText({static_cast<int>(m_.solid_pairs + i)}, m_.pairs) +
              ", cable: " + (fresh ? mark + "{" + kind : "{<<: *" + called) +
              ", rest_length_m: " + Shown(rest_m) + "}}\n";
    }
    return text;
  }

  std::string Laws() const {
    const Vec3& g = def_.gravity_m_per_s2;
    std::string text =
        "\ngravity_m_per_s2: [" + Shown(g.x) + ", " + Shown(g.y) + ", " + Shown(g.z) + "]\n";
    FlowWriter<false> contact;
    ContactKeys(contact, def_);
    text += "contact: {" + contact.text() + "}\n";
    if (!m_.apart.empty()) text += "apart: " + FlowWriter<false>::Text(m_.apart) + "\n";
    Diagnostics apart;
    CheckConnected(robot_, apart);
    return apart.ok() ? text : text + "allow_disconnected: true\n";
  }

  const RobotSpec& robot_;
  const ModelDef& def_;
  WrittenModel m_;
  Diagnostics& out_;
};

std::string Commented(const std::string& heading) {
  std::string text = heading.empty() ? "" : "# ";
  for (const char c : heading) {
    text += c;
    if (c == '\n') text += "# ";
  }
  return text.empty() ? "" : text + "\n";
}

}  // namespace

PairName NameOf(const WrittenModel& model, const WrittenPair& pair) {
  std::string full, shorter;
  const auto name_of = [&](int n) { return model.nodes[static_cast<std::size_t>(n)].name; };
  const std::string placement = PlacementOf(name_of(pair.nodes[0]));
  bool inside = !placement.empty() && pair.name.starts_with(placement + ".");
  for (const int n : pair.nodes) {
    const std::string name = name_of(n);
    full += (full.empty() ? "" : "-") + name;
    shorter += (shorter.empty() ? "" : "-") + ShortName(name);
    inside = inside && PlacementOf(name) == placement;
  }
  if (inside) {
    const std::string own = pair.name.substr(placement.size() + 1);
    if (own == shorter || IsName(own)) return {placement, own == shorter ? "" : own};
  }
  return {"", pair.name == full ? "" : pair.name};
}

std::string TextOf(const RobotSpec& robot, WrittenModel model, Diagnostics& out) {
  return Writer(robot, std::move(model), out).Text();
}

}  // namespace taut::description

namespace taut {

std::optional<std::string> ModelYaml(const RobotSpec& robot, const std::string& heading,
                                     Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  if (robot.solids && robot.solids->bounding_box_inertia) {
    description::RefuseModel(
        out,
        "its inertias are from bounding boxes in the described pose (`inertia: bounding_box`)");
  }
  const std::string text = description::TextOf(robot, description::TakeApart(robot, out), out);
  if (out.items().size() != errors_before) return std::nullopt;
  Diagnostics found;
  const std::optional<RobotSpec> read = description::ModelOfText(text, found);
  if (!read) {
    description::RefuseModel(out, found.items().front().what, found.items().front().hint);
    return std::nullopt;
  }
  if (!description::CheckReadBack(robot, *read, out)) return std::nullopt;
  return description::Commented(heading) + text;
}

}  // namespace taut
