// Tendons and what pulls at them.
#include <algorithm>
#include <cmath>

#include "mjcf/scene.h"

namespace taut::mjcf {
namespace {

/// What actuator elements say, one over the other: defaults of all kinds set the same numbers.
struct Settings {
  std::string dyntype = "none", gaintype = "fixed", biastype = "none";
  double gain = 1, bias[3] = {0, 0, 0}, lag_s = 1;
};

void Apply(const Element& e, Settings& s, Diagnostics& out) {
  const Layers layers({&e}, out);
  s.dyntype = layers.Text("dyntype", s.dyntype);
  s.gaintype = layers.Text("gaintype", s.gaintype);
  s.biastype = layers.Text("biastype", s.biastype);
  if (layers.Has("gainprm")) s.gain = layers.Numbers("gainprm", {s.gain}, 1, 10)[0];
  if (layers.Has("dynprm")) s.lag_s = layers.Numbers("dynprm", {s.lag_s}, 1, 10)[0];
  if (layers.Has("biasprm")) {
    const auto n = layers.Numbers("biasprm", {s.bias[0], s.bias[1], s.bias[2]}, 1, 10);
    std::copy(n.begin(), n.begin() + 3, s.bias);
  }
  if (e.name == "motor") {
    s = {};
  } else if (e.name == "position") {
    const double kp = layers.Number("kp", s.gain), kv = layers.Number("kv", 0);
    if (layers.Number("dampratio", 0) != 0) {
      layers.Error("dampratio", "dampratio is not read", "kv is");
    }
    if (const double lag_s = layers.Number("timeconst", 0); lag_s != 0) {
      s.dyntype = "filterexact", s.lag_s = lag_s;
    }
    s.gaintype = "fixed", s.biastype = "affine";
    s.gain = kp, s.bias[0] = 0, s.bias[1] = -kp, s.bias[2] = -kv;
  } else if (e.name == "velocity") {
    const double kv = layers.Number("kv", s.gain);
    s.gaintype = "fixed", s.biastype = "affine", s.dyntype = "none";
    s.gain = kv, s.bias[0] = s.bias[1] = 0, s.bias[2] = -kv;
  }
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
    const bool known =
        e.name == "general" || e.name == "motor" || e.name == "position" || e.name == "velocity";
    if (!known) {
      Refuse(e, "actuators of kind " + e.name + " are not read");
      return;
    }
    for (const char* other : {"joint", "jointinparent", "site", "body", "cranksite"}) {
      if (!e.Find(other)) continue;
      Refuse(e, std::string("an actuator on a ") + other + " is not read, those on tendons are");
      return;
    }
    actuator.tendon = Find(scene_.tendon_by_name, e, "tendon", "tendon", out_);
    if (actuator.tendon < 0) return;
    Settings s;
    for (const Element* const layer : layers.all()) Apply(*layer, s, out_);
    const bool lags = s.dyntype == "filter" || s.dyntype == "filterexact";
    if (!lags && s.dyntype != "none") {
      Refuse(e, "its dyntype is " + s.dyntype + ", only none, filter and filterexact are read");
    }
    if (lags) actuator.lag_s = s.lag_s, actuator.state = scene_.states++;
    if (s.gaintype != "fixed") Refuse(e, "its gaintype is " + s.gaintype + ", only fixed is read");
    if (s.biastype != "none" && s.biastype != "affine") {
      Refuse(e, "its biastype is " + s.biastype + ", only none and affine are read");
    }
    // The actuator's length is the tendon's times the gear, and so is its force the other way.
    const double gear = layers.Numbers("gear", {1}, 1, 6)[0];
    const bool affine = s.biastype == "affine";
    actuator.gain = gear * s.gain;
    actuator.bias[0] = affine ? gear * s.bias[0] : 0;
    actuator.bias[1] = affine ? gear * gear * s.bias[1] : 0;
    actuator.bias[2] = affine ? gear * gear * s.bias[2] : 0;
    if (layers.Limited("ctrllimited", "ctrlrange", scene_.settings)) {
      const auto n = layers.Numbers("ctrlrange", {0, 0}, 2, 2);
      actuator.control_range = std::pair(n[0], n[1]);
      if (!(n[0] < n[1])) layers.Error("ctrlrange", "ctrlrange must rise");
    }
    if (layers.Limited("forcelimited", "forcerange", scene_.settings)) {
      const auto n = layers.Numbers("forcerange", {0, 0}, 2, 2);
      actuator.force_range = std::minmax(gear * n[0], gear * n[1]);
      if (!(n[0] < n[1])) layers.Error("forcerange", "forcerange must rise");
    }
    const bool unsure = layers.Has("forcerange") && layers.Text("forcelimited", "auto") == "auto" &&
                        !scene_.settings.autolimits_given;
    if (unsure && !warned_) {
      warned_ = true;
      out_.Warning(e.at, e.Called() + ": whether forcerange counts is not said; here it does",
                   "MuJoCo 2 would not take it so: forcelimited says it to all versions");
    }
    scene_.actuators.push_back(actuator);
  }

 private:
  void Refuse(const Element& e, const std::string& what) {
    out_.Error(e.at, e.Called() + ": " + what);
  }
  const Defaults& defaults_;
  Scene& scene_;
  Diagnostics& out_;
  bool warned_ = false;
};

}  // namespace

void ReadTendons(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out) {
  for (const Element* const section : Sections(root, "tendon")) {
    for (const Element& e : section->children) {
      if (e.name != "spatial") continue;
      const Layers layers = defaults.Over(e, "", out);
      Tendon tendon;
      tendon.at = e.at;
      const int index = static_cast<int>(scene.tendons.size());
      tendon.name = layers.Text("name", "tendon_" + std::to_string(index));
      Register(scene.tendon_by_name, e, index, out);
      if (const Attribute* const cls = e.Find("class")) tendon.tag = cls->value;
      for (const Element& site : e.children) {
        if (site.name != "site") continue;
        tendon.sites.push_back(Find(scene.site_by_name, site, "site", "site", out));
      }
      if (tendon.sites.size() < 2 && e.children.size() == tendon.sites.size()) {
        out.Error(e.at, e.Called() + " has fewer than two sites");
      }
      tendon.stiffness = layers.Numbers("stiffness", {0}, 1, 3)[0];
      tendon.damping = layers.Numbers("damping", {0}, 1, 3)[0];
      for (const char* polynomial : {"stiffness", "damping"}) {
        const auto n = layers.Numbers(polynomial, {0, 0, 0}, 1, 3);
        if (n[1] == 0 && n[2] == 0) continue;
        layers.Error(polynomial, std::string(polynomial) + " that is not constant is not read");
      }
      tendon.springlength = layers.Numbers("springlength", {-1}, 1, 2);
      tendon.friction = layers.Number("frictionloss", 0);
      if (layers.Number("armature", 0) != 0) {
        layers.Error("armature", "armature of a tendon is not read");
      }
      for (const char* key : {"stiffness", "damping", "frictionloss"}) {
        if (layers.Numbers(key, {0}, 1, 3)[0] < 0) {
          layers.Error(key, std::string(key) + " is negative");
        }
      }
      tendon.has_limit = layers.Limited("limited", "range", scene.settings);
      if (layers.Limited("actuatorfrclimited", "actuatorfrcrange", scene.settings)) {
        layers.Error("actuatorfrcrange", "actuatorfrcrange is not read", "forcerange is");
      }
      scene.tendons.push_back(std::move(tendon));
    }
  }
}

void ReadActuators(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out) {
  ActuatorReader reader(defaults, scene, out);
  for (const Element* const section : Sections(root, "actuator")) {
    for (const Element& e : section->children) reader.Read(e);
  }
}

}  // namespace taut::mjcf
