// Reader of compiler settings, options, contacts, equalities and keyframes.
#include <algorithm>
#include <cmath>

#include "math/vec.h"
#include "mjcf/mjcf_scene.h"

namespace taut::mjcf {
namespace {

void ReadCompiler(const Layers& layers, CompilerSettings& s) {
  using FromGeoms = CompilerSettings::FromGeoms;
  const auto choose = [&](const char* name, const std::string& usual,
                          const std::vector<std::string>& words) {
    std::string text = layers.Text(name, usual);
    if (std::find(words.begin(), words.end(), text) != words.end()) return text;
    layers.Error("mjcf.bad_setting", name,
                 std::string(name) + " has the unknown value \"" + text + '"',
                 DidYouMean(text, words));
    return usual;
  };
  if (layers.Has("angle")) s.degrees = choose("angle", "degree", {"degree", "radian"}) == "degree";
  if (layers.Has("coordinate")) {
    s.global = choose("coordinate", "local", {"local", "global"}) == "global";
  }
  if (layers.Has("eulerseq")) {
    s.eulerseq = layers.Text("eulerseq");
    if (s.eulerseq.size() != 3 || s.eulerseq.find_first_not_of("xyzXYZ") != std::string::npos) {
      layers.Error("mjcf.eulerseq", "eulerseq", "eulerseq must be three of x, y, z, X, Y, Z");
      s.eulerseq = "xyz";
    }
  }
  if (layers.Has("inertiafromgeom")) {
    const std::string text = choose("inertiafromgeom", "auto", {"false", "true", "auto"});
    s.from_geoms = text == "true"    ? FromGeoms::kTrue
                   : text == "false" ? FromGeoms::kFalse
                                     : FromGeoms::kAuto;
  }
  s.alignfree = layers.Flag("alignfree", s.alignfree);
  s.autolimits_given = s.autolimits_given || layers.Has("autolimits");
  s.autolimits = layers.Flag("autolimits", s.autolimits);
  s.boundmass = layers.Number("boundmass", s.boundmass);
  s.boundinertia = layers.Number("boundinertia", s.boundinertia);
  s.settotalmass = layers.Number("settotalmass", s.settotalmass);
  s.inertia_groups = layers.Numbers("inertiagrouprange", s.inertia_groups, 2, 2);
}

void ReadFlags(const Element& element, Scene& scene, Diagnostics& out) {
  for (const Attribute& a : element.attributes) {
    if (a.value != "enable" && a.value != "disable") {
      out.Error("mjcf.bad_flag", a.at,
                "flag." + a.name + " must be enable or disable, not \"" + a.value + '"');
    } else if (a.name == "override" && a.value == "enable") {
      out.Error("mjcf.not_read", a.at, "flag.override=\"enable\" is not supported",
                "remove the flag; each geom then has its own friction instead of o_friction");
    } else if (a.value == "disable") {
      if (a.name == "gravity") scene.gravity = {};
      if (a.name == "contact") scene.has_contacts = false;
      if (a.name == "clampctrl") scene.clamps_controls = false;
      if (a.name == "frictionloss") scene.has_dry_friction = false;
      if (a.name == "limit") scene.has_limits = false;
      for (const char* whole :
           {"constraint", "passive", "spring", "damper", "actuation", "equality"}) {
        if (a.name == whole)
          out.Error("mjcf.not_read", a.at, "flag." + a.name + "=\"disable\" is not supported");
      }
    }
  }
}

void ReadOption(const Layers& layers, Scene& scene, Diagnostics& out) {
  const Vec3& g = scene.gravity;
  const auto n = layers.Numbers("gravity", {g.x, g.y, g.z}, 3, 3);
  scene.gravity = {n[0], n[1], n[2]};
  scene.timestep = layers.Number("timestep", scene.timestep);
  if (!(scene.timestep >= 1e-9 && scene.timestep <= 1)) {
    layers.Error("mjcf.timestep", "timestep",
                 "timestep must be within 1e-9..1");  // as step_s of an experiment
  }
  for (const char* fluid : {"density", "viscosity"}) {
    if (layers.Number(fluid, 0) != 0)
      layers.Error("mjcf.fluid", fluid, "a surrounding fluid is not supported",
                   "set density and viscosity to 0");
  }
  scene.only_pairs = layers.Text("collision", "all") == "predefined";
  if (layers.Has("actuatorgroupdisable")) {
    for (const double group : layers.Numbers("actuatorgroupdisable", {}, 0, 31)) {
      scene.disabled_groups.push_back(static_cast<int>(group));
    }
  }
  for (const Element& child : layers.element().children) {
    if (child.name == "flag") ReadFlags(child, scene, out);
  }
}

}  // namespace

std::vector<const Element*> Sections(const Element& root, std::string_view name) {
  std::vector<const Element*> found;
  for (const Element& child : root.children) {
    if (child.name == name) found.push_back(&child);
  }
  return found;
}

void Register(std::map<std::string, int>& by_name, const Element& element, int index,
              Diagnostics& out) {
  const Attribute* const name = element.Find("name");
  if (!name || name->value.empty()) return;
  if (!by_name.emplace(name->value, index).second) {
    out.Error("mjcf.duplicate_name", name->at, element.Called() + " is defined twice");
  }
}

int Find(const std::map<std::string, int>& by_name, const Element& element,
         std::string_view attribute, const char* kind, Diagnostics& out) {
  const Attribute* const name = element.Find(attribute);
  if (!name) {
    out.Error("mjcf.missing_attribute", element.at,
              element.Called() + " has no " + std::string(attribute));
    return -1;
  }
  const auto found = by_name.find(name->value);
  if (found != by_name.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [key, index] : by_name) {
    if (out.items().size() < kMostHints) known.push_back(key);
  }
  out.Error("mjcf.unknown_name", name->at,
            std::string("there is no ") + kind + " \"" + name->value + '"',
            known.empty() ? "" : DidYouMean(name->value, known));
  return -1;
}

void ReadSettings(const Element& root, Scene& scene, Diagnostics& out) {
  if (const Attribute* const model = root.Find("model")) scene.model = model->value;
  for (const Element* const e : Sections(root, "compiler")) {
    ReadCompiler(Layers({e}, out), scene.settings);
  }
  for (const Element* const e : Sections(root, "option")) {
    ReadOption(Layers({e}, out), scene, out);
  }
}

void ReadContacts(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out) {
  for (const Element* const section : Sections(root, "contact")) {
    for (const Element& e : section->children) {
      if (e.name == "exclude") {
        const int a = Find(scene.body_by_name, e, "body1", "body", out),
                  b = Find(scene.body_by_name, e, "body2", "body", out);
        if (a >= 0 && b >= 0) scene.excludes.emplace_back(a, b);
      } else if (e.name == "pair") {
        const Layers layers = defaults.Over(e, "", out);
        const int a = Find(scene.shape_by_name, e, "geom1", "geom", out),
                  b = Find(scene.shape_by_name, e, "geom2", "geom", out);
        if (a == Scene::kLeftOut || b == Scene::kLeftOut) {
          layers.Error("mjcf.pair_type", a == Scene::kLeftOut ? "geom1" : "geom2",
                       "this geom has a type that is not supported",
                       "use sphere, capsule, cylinder, box or plane");
        }
        if (a < 0 || b < 0) continue;
        // A pair does not inherit friction and condim of its geoms, as in MuJoCo.
        const auto friction = layers.Numbers("friction", {1, 1, 0.005, 0.0001, 0.0001}, 1, 5);
        const int condim = layers.Whole("condim", 3);
        if (friction[0] < 0)
          layers.Error("mjcf.negative_friction", "friction", "friction must not be negative");
        if (condim > 1 && friction[0] != friction[1]) {
          layers.Error(
              "mjcf.anisotropic_friction", "friction",
              "friction that differs between the two tangential directions is not supported",
              "give the first two numbers the same value; the second is 1 if absent");
        }
        if (condim > 3) scene.twisting.push_back(e.at);
        scene.pairs.push_back({e.at, a, b, condim == 1 ? 0 : friction[0]});
      }
    }
  }
}

void ReadEqualities(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out) {
  for (const Element* const section : Sections(root, "equality")) {
    for (const Element& e : section->children) {
      const Layers layers = defaults.Over(e, "", out);
      if (!layers.Flag("active", true)) {
        ++scene.left_out["inactive equality"];
        continue;
      }
      if (e.name != "weld") {
        out.Error("mjcf.equality", e.at, "the equality " + e.Called() + " is not supported",
                  "use weld, which joins two bodies into one");
        continue;
      }
      if (e.Find("site1")) {
        out.Error("mjcf.weld_of_sites", e.at, "a weld of sites is not supported",
                  "weld the bodies instead");
        continue;
      }
      const int a = Find(scene.body_by_name, e, "body1", "body", out);
      const int b = e.Find("body2") ? Find(scene.body_by_name, e, "body2", "body", out) : 0;
      if (a < 0 || b < 0) continue;
      const auto n = layers.Numbers("relpose", {0, 1, 0, 0, 0, 0, 0}, 7, 7);
      const bool as_described = n[3] == 0 && n[4] == 0 && n[5] == 0 && n[6] == 0;
      if (!as_described) {
        layers.Error("mjcf.relpose", "relpose", "a weld with a relpose is not supported",
                     "give the bodies their final poses, and leave out relpose");
      }
      // A body welded to a static body is static.
      const int root_a = scene.bodies[Scene::Index(a)].root,
                root_b = scene.bodies[Scene::Index(b)].root;
      const int keep = scene.Moves(b) ? root_a : root_b, lose = keep == root_a ? root_b : root_a;
      for (Body& body : scene.bodies) {
        if (body.root == lose) body.root = keep;
      }
    }
  }
}

void ReadKeys(const Element& root, Scene& scene, Diagnostics& out) {
  std::size_t positions = 0, velocities = 0;
  for (const Body& body : scene.bodies) {
    if (body.is_free) positions += 7, velocities += 6;
  }
  for (const Element* const section : Sections(root, "keyframe")) {
    for (const Element& e : section->children) {
      const Layers layers({&e}, out);
      Key key{layers.Text("name"), e.at, {}, {}, {}, {}};
      const auto read = [&](const char* name, std::size_t count) {
        if (!layers.Has(name)) return std::vector<double>();
        const std::vector<double> zeros(count);
        return layers.Numbers(name, zeros, count, count);
      };
      key.qpos = read("qpos", positions);
      key.qvel = read("qvel", velocities);
      if (!scene.lacks_actuators) {
        key.ctrl = read("ctrl", scene.actuators.size());
        key.act = read("act", scene.states);
      }
      scene.keys.push_back(std::move(key));
    }
  }
}

}  // namespace taut::mjcf
