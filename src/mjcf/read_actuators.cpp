// Actuators on tendons, with the defaults of their classes.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/brief.h"
#include "mjcf/mjcf_scene.h"

namespace taut::mjcf {
namespace {

/// Parameters of an actuator while elements are applied: first the elements of its default classes,
/// outermost first, then the actuator element. Elements of all kinds write the same parameters.
struct ActuatorSettings {
  std::string dyntype = "none", gaintype = "fixed", biastype = "none";
  double gain = 1, bias[3] = {0, 0, 0}, lag_s = 1, inherited_range = 0;

  bool Lags() const { return dyntype == "filter" || dyntype == "filterexact"; }
  /// Returns whether both settings have the same force law.
  bool Equals(const ActuatorSettings& other) const {
    const bool same_bias = biastype != "affine" || std::equal(bias, bias + 3, other.bias);
    return dyntype == other.dyntype && gaintype == other.gaintype && biastype == other.biastype &&
           gain == other.gain && same_bias && (!Lags() || lag_s == other.lag_s) &&
           inherited_range == other.inherited_range;
  }
};

/// Applies one element like MuJoCo's reader: parameters that the element neither sets nor implies
/// keep their values. Examples: `kv` and `bias[0]` of a `position` element.
void Apply(const Element& e, ActuatorSettings& s, Diagnostics& out) {
  const Layers layers({&e}, out);
  const auto number = [&](const char* name, double if_absent) {
    const double given = layers.Number(name, if_absent);
    if (layers.Has(name) && given < 0)
      layers.Error("mjcf.negative", name, std::string(name) + " must not be negative");
    return given;
  };
  if (e.name == "general") {
    s.dyntype = layers.Text("dyntype", s.dyntype);
    s.gaintype = layers.Text("gaintype", s.gaintype);
    s.biastype = layers.Text("biastype", s.biastype);
    if (layers.Has("gainprm")) s.gain = layers.Numbers("gainprm", {s.gain}, 1, 10)[0];
    if (layers.Has("dynprm")) s.lag_s = layers.Numbers("dynprm", {s.lag_s}, 1, 10)[0];
    const auto n = layers.Numbers("biasprm", {s.bias[0], s.bias[1], s.bias[2]}, 1, 10);
    std::copy(n.begin(), n.begin() + 3, s.bias);
    s.inherited_range = number("inheritrange", s.inherited_range);
  } else if (e.name == "motor") {
    s.gain = 1;
    s.dyntype = "none", s.gaintype = "fixed", s.biastype = "none";
  } else if (e.name == "position" || e.name == "intvelocity") {
    s.gain = layers.Number("kp", s.gain), s.bias[1] = -s.gain;
    if (layers.Has("kv")) s.bias[2] = -number("kv", 0);
    // MuJoCo stores a damping ratio as a positive number and converts it after it has computed the
    // masses.
    if (layers.Has("dampratio")) s.bias[2] = number("dampratio", 0);
    if (layers.Has("kv") && layers.Has("dampratio")) {
      layers.Error("mjcf.kv_and_dampratio", "dampratio", "kv and dampratio are both given",
                   "leave out one of them");
    }
    if (layers.Has("timeconst")) {
      s.lag_s = number("timeconst", 0);
      s.dyntype = s.lag_s == 0 ? "none" : "filterexact";
    }
    if (e.name == "intvelocity") s.dyntype = "integrator";
    s.inherited_range = number("inheritrange", s.inherited_range);
    s.gaintype = "fixed", s.biastype = "affine";
  } else if (e.name == "velocity") {
    s.gain = layers.Number("kv", s.gain);
    s.bias[0] = s.bias[1] = 0, s.bias[2] = -s.gain;
    s.dyntype = "none", s.gaintype = "fixed", s.biastype = "affine";
  } else if (e.name == "cylinder") {
    s.lag_s = number("timeconst", s.lag_s);
    const auto n = layers.Numbers("bias", {s.bias[0], s.bias[1], s.bias[2]}, 1, 3);
    std::copy(n.begin(), n.begin() + 3, s.bias);
    const double diameter = number("diameter", -1);
    s.gain = layers.Number("area", s.gain);
    if (diameter >= 0) s.gain = std::numbers::pi / 4 * diameter * diameter;
    s.dyntype = "filter", s.gaintype = "fixed", s.biastype = "affine";
  }
}

/// Merges elements like MuJoCo up to 3.15: each element modifies the result of all previous
/// elements.
ActuatorSettings MergedUntil315(const std::vector<const Element*>& layers, Diagnostics& out) {
  ActuatorSettings s;
  for (const Element* const layer : layers) Apply(*layer, s, out);
  return s;
}

/// Merges elements like MuJoCo since 3.16. An element of another kind than `general` inherits from
/// the latest previous element that is `general` or of the same kind, and inherits fewer parameters
/// from `general`. Verified with random files of up to four elements: 10,000 with 4.0.0 and 1,500
/// with 3.16.0.
///
/// `one_per_class`: each class keeps only its last element, like MuJoCo 4.0.0 for classes with
/// elements of several kinds.
ActuatorSettings MergedSince316(const std::vector<const Element*>& layers, const Defaults& defaults,
                                bool one_per_class) {
  struct Made {
    std::string kind;
    const void* of = nullptr;  ///< Default class that contains the element; null for the actuator
                               ///< element.
    ActuatorSettings settings = {};
  };
  Diagnostics ignored;
  std::vector<Made> made{{"general"}};
  for (const Element* const layer : layers) {
    const std::string& kind = layer->name;
    const auto from = std::find_if(made.rbegin(), made.rend(), [&](const Made& before) {
      return kind == "general" || before.kind == "general" || before.kind == kind;
    });
    ActuatorSettings s = from->settings;
    if (kind == "position" && s.dyntype != "filterexact") s.dyntype = "none", s.lag_s = 1;
    if (kind == "motor" || kind == "velocity") s.bias[0] = s.bias[1] = s.bias[2] = 0, s.lag_s = 1;
    if (kind == "position" || kind == "intvelocity") s.bias[0] = 0;
    Apply(*layer, s, ignored);
    const void* const of = defaults.ClassOf(*layer);
    if (one_per_class && of != nullptr) {
      std::erase_if(made, [&](const Made& before) { return before.of == of; });
    }
    made.push_back({kind, of, s});
  }
  return made.back().settings;
}

class ActuatorReader {
 public:
  ActuatorReader(const Defaults& defaults, Scene& scene, Diagnostics& out)
      : defaults_(defaults), scene_(scene), out_(out) {}

  void Read(const Element& e) {
    const Layers layers = defaults_.Over(e, "", out_);
    Actuator actuator;
    actuator.at = e.at;
    actuator.name = layers.Text("name");
    for (const Element* const layer : layers.all()) {
      if (IsRead(layer->name)) continue;
      const std::string under =
          layer == &e ? "" : " are not supported; its class sets one in line " + LineOf(*layer);
      Refuse("mjcf.actuator_kind", e,
             under.empty() ? "actuators of kind " + e.name + " are not supported"
                           : "actuators of kind " + layer->name + under);
      return;
    }
    for (const char* other : {"joint", "jointinparent", "site", "body", "cranksite"}) {
      if (!e.Find(other)) continue;
      Refuse("mjcf.actuator_transmission", e,
             std::string("an actuator on a ") + other + " is not supported (expected a tendon)");
      return;
    }
    actuator.tendon = Find(scene_.tendon_by_name, e, "tendon", "tendon", out_);
    if (actuator.tendon < 0) return;
    const ActuatorSettings s = MergedUntil315(layers.all(), out_);
    for (const bool one_per_class : {false, true}) {
      const ActuatorSettings since = MergedSince316(layers.all(), defaults_, one_per_class);
      if (s.Equals(since)) continue;
      Refuse("mjcf.defaults_differ", e,
             "versions of MuJoCo differ in its defaults: " + Text(s) + " until 3.15, " +
                 Text(since) + " since 3.16",
             "set these parameters in the element: its default classes set them for other kinds of "
             "actuators");
      return;
    }
    ReadLaw(layers, s, actuator);
    ReadRanges(layers, s, actuator);
    ReadRest(layers, actuator);
    scene_.actuators.push_back(actuator);
  }

 private:
  static bool IsRead(const std::string& kind) {
    return kind == "general" || kind == "motor" || kind == "position" || kind == "velocity" ||
           kind == "intvelocity" || kind == "cylinder";
  }
  static std::string LineOf(const Element& e) {
    return std::to_string(e.at.line) + " of " + e.at.file;
  }

  static std::string Text(const ActuatorSettings& s) {
    std::string text = "gain " + base::Brief(s.gain, 6) + ", bias";
    for (const double bias : s.bias) text += " " + base::Brief(bias, 6);
    return text + " (" + s.biastype + "), dyntype " + s.dyntype;
  }

  void ReadLaw(const Layers& layers, const ActuatorSettings& s, Actuator& actuator) {
    const Element& e = layers.element();
    const bool lags = s.Lags();
    if (!lags && s.dyntype != "none") {
      Refuse("mjcf.actuator_law", e,
             "the actuator's dyntype is " + s.dyntype + " (expected none, filter or filterexact)");
    }
    if (lags) actuator.lag_s = s.lag_s, actuator.state = scene_.states++;
    if (s.gaintype != "fixed")
      Refuse("mjcf.actuator_law", e,
             "the actuator's gaintype is " + s.gaintype + " (expected fixed)");
    if (s.biastype != "none" && s.biastype != "affine") {
      Refuse("mjcf.actuator_law", e,
             "the actuator's biastype is " + s.biastype + " (expected none or affine)");
    }
    const bool affine = s.biastype == "affine";
    if (affine && s.bias[2] > 0 && s.gain == -s.bias[1]) {
      layers.Error("mjcf.dampratio", "dampratio", "dampratio is not supported", "use kv");
    }
    // The actuator's length is the tendon's length times the gear. Its force on the tendon is also
    // multiplied by the gear.
    const double gear = layers.Numbers("gear", {1}, 1, 6)[0];
    actuator.gain = gear * s.gain;
    actuator.bias[0] = affine ? gear * s.bias[0] : 0;
    actuator.bias[1] = affine ? gear * gear * s.bias[1] : 0;
    actuator.bias[2] = affine ? gear * gear * s.bias[2] : 0;
  }

  void ReadRanges(const Layers& layers, const ActuatorSettings& s, Actuator& actuator) {
    const Element& e = layers.element();
    if (const auto range = layers.Range("ctrllimited", "ctrlrange", scene_.settings)) {
      actuator.control_range = range;
    }
    const bool as_tendon = s.gaintype == "fixed" && s.biastype == "affine" &&
                           s.gain == -s.bias[1] && s.inherited_range > 0;
    if (as_tendon) InheritRange(layers, s, actuator);
    if (const auto range = layers.Range("forcelimited", "forcerange", scene_.settings)) {
      const double gear = layers.Numbers("gear", {1}, 1, 6)[0];
      actuator.force_range = std::minmax(gear * range->first, gear * range->second);
    }
    const bool unsure = layers.Has("forcerange") && layers.Text("forcelimited", "auto") == "auto" &&
                        actuator.force_range && !scene_.settings.autolimits_given;
    if (unsure && !warned_) {
      warned_ = true;
      out_.Warning("mjcf.forcerange", e.at,
                   e.Called() + ": forcerange without forcelimited takes effect",
                   "set forcelimited, because MuJoCo 2 ignores such a forcerange");
    }
    if (!actuator.state) return;
    if (layers.Range("actlimited", "actrange", scene_.settings)) {
      layers.Error("mjcf.actrange", "actrange", "actrange is not supported", "use ctrlrange");
    }
  }

  /// Applies `inheritrange`: sets the control range to this fraction of the tendon's range, about
  /// the same center.
  void InheritRange(const Layers& layers, const ActuatorSettings& s, Actuator& actuator) {
    const auto& range = scene_.tendons[Scene::Index(actuator.tendon)].range;
    if (s.dyntype == "filter") {
      layers.Error("mjcf.inheritrange", "inheritrange",
                   "inheritrange does not apply to dyntype filter");
    } else if (layers.Has("ctrlrange") &&
               layers.Numbers("ctrlrange", {0, 0}, 2, 2) != std::vector<double>{0, 0}) {
      layers.Error("mjcf.inheritrange", "inheritrange", "ctrlrange and inheritrange are both given",
                   "leave out one of them");
    } else if (!range) {
      layers.Error("mjcf.inheritrange", "inheritrange",
                   "inheritrange is given, but the actuator's tendon has no range");
    } else if (layers.Text("ctrllimited", "auto") != "false") {
      const double middle = 0.5 * (range->first + range->second);
      const double radius = 0.5 * (range->second - range->first) * s.inherited_range;
      if (scene_.settings.autolimits || layers.Text("ctrllimited", "auto") == "true") {
        actuator.control_range = std::pair(middle - radius, middle + radius);
      }
    }
  }

  /// Reads the delay. Rejects attributes that affect the force and that taut's cables do not have.
  void ReadRest(const Layers& layers, Actuator& actuator) {
    for (const char* key : {"damping", "armature"}) {
      const auto n = layers.Numbers(key, {0, 0, 0}, 1, 3);
      if (n == std::vector<double>{0, 0, 0}) continue;
      layers.Error("mjcf.not_read", key, std::string(key) + " of an actuator is not supported");
    }
    if (const double delay_s = layers.Number("delay", 0); delay_s != 0) {
      actuator.lag_s += delay_s;
    }
    const std::vector<int>& off = scene_.disabled_groups;
    if (std::find(off.begin(), off.end(), layers.Whole("group", 0)) != off.end()) {
      Refuse("mjcf.disabled_group", layers.element(),
             "the actuator's group is disabled by actuatorgroupdisable",
             "remove the actuator, or its group from actuatorgroupdisable");
    }
  }

  void Refuse(MessageId id, const Element& e, const std::string& what,
              const std::string& hint = {}) {
    scene_.lacks_actuators = true;
    out_.Error(id, e.at, e.Called() + ": " + what, hint);
  }
  const Defaults& defaults_;
  Scene& scene_;
  Diagnostics& out_;
  bool warned_ = false;
};

}  // namespace

void ReadActuators(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out) {
  ActuatorReader reader(defaults, scene, out);
  for (const Element* const section : Sections(root, "actuator")) {
    for (const Element& e : section->children) reader.Read(e);
  }
}

}  // namespace taut::mjcf
