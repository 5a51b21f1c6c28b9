#include "mjcf/mjcf_schema.h"

#include <algorithm>
#include <map>
#include <sstream>

#include "mjcf/values.h"

namespace taut::mjcf {
namespace {

constexpr const char* kTurns = "pos quat axisangle xyaxes zaxis euler ";
constexpr const char* kBodyParts = "inertial joint freejoint geom site body frame";
constexpr const char* kPictures = "camera light";
constexpr const char* kNotBodies = "composite flexcomp attach replicate plugin";
constexpr const char* kActuators =
    "general motor position velocity intvelocity damper cylinder muscle adhesion plugin dcmotor "
    "orientation pid";
const std::string kJoint =
    "name class type pos axis damping stiffness armature frictionloss springdamper align";
const std::string kJointLeftOut =
    "group range limited ref springref margin solreflimit solimplimit solreffriction "
    "solimpfriction actuatorfrclimited actuatorfrcrange actuatorgravcomp user springyield";
const std::string kGeom =
    "name class type contype conaffinity condim group priority size mass density fromto friction "
    "mesh hfield shellinertia ";
const std::string kGeomLeftOut =
    "material rgba solmix solref solimp margin gap fitscale user fluidshape fluidcoef hullvertices "
    "castshadow adhesion surfacevel";
const std::string kTendon =
    "name class springlength stiffness damping armature frictionloss limited range "
    "actuatorfrclimited actuatorfrcrange";
const std::string kTendonLeftOut =
    "group solreflimit solimplimit solreffriction solimpfriction margin width material rgba user "
    "springyield";
const std::string kActuator =
    "name class tendon joint jointinparent site refsite body cranksite slidersite ctrllimited "
    "ctrlrange forcelimited forcerange gear group actlimited actrange delay damping armature ";
const std::string kActuatorLeftOut = "user lengthrange cranklength actdim actearly nsample interp";

/// Attributes in `left_out` that affect forces or positions. An attribute is ignored silently if it
/// has its neutral value. The file may give only the first numbers of this value.
struct Change {
  const char *elements, *attributes, *neutral;
  const char* consequence;  ///< Text of the warning. Null: the attribute is rejected.
};
constexpr const char* kSoft = "contacts are rigid in taut; in MuJoCo these values make them soft";
constexpr const char* kWelded =
    "welded bodies become one rigid body; in MuJoCo a weld is a soft constraint";
constexpr Change kChanges[] = {
    {"geom pair", "solref", "0.02 1", kSoft},
    {"geom pair", "solimp", "0.9 0.95 0.001 0.5 2", kSoft},
    {"pair", "solreffriction", "0 0", kSoft},
    {"geom pair", "margin gap", "0",
     "contacts begin where shapes touch; in MuJoCo at a distance given by these values"},
    {"geom pair", "adhesion", "0", nullptr},
    {"geom", "surfacevel", "0 0 0", nullptr},
    {"tendon spatial joint", "springyield", "0", nullptr},
    {"weld equality", "solref", "0.02 1", kWelded},
    {"weld equality", "solimp", "0.9 0.95 0.001 0.5 2", kWelded},
    {"weld", "torquescale", "1", kWelded},
    {"key", "mpos mquat plastic", "", "mocap bodies stay at their poses in the file"},
};

bool Has(const char* list, const std::string& word) {
  const std::string padded = std::string(" ") + list + " ";
  return padded.find(" " + word + " ") != padded.npos;
}

std::vector<std::string> Words(const std::string& list) {
  std::istringstream in(list);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

class Checker {
 public:
  Checker(LeftOut& left_out, Diagnostics& out) : left_out_(left_out), out_(out) {}

  void Run(const Element& element, const std::string& kind) {
    const auto& rules = Rules();
    const auto rule =
        std::find_if(rules.begin(), rules.end(), [&](const Rule& r) { return kind == r.element; });
    if (rule == rules.end()) return;
    if (std::string(rule->children) == "...") return;
    for (const Attribute& a : element.attributes) {
      if (Has(rule->read, a.name)) continue;
      if (Has(rule->left_out, a.name)) {
        LeaveOut(element, kind, a);
        continue;
      }
      out_.Error("mjcf.unknown_attribute", a.at,
                 element.name + " has no attribute \"" + a.name + "\" in MJCF",
                 DidYouMean(a.name, Words(std::string(rule->read) + " " + rule->left_out)));
    }
    for (const Element& child : element.children) {
      if (Has(rule->children, child.name)) {
        Run(child, KindOf(kind, child.name));
      } else if (Has(rule->children_left_out, child.name)) {
        ++left_out_[child.name];
      } else if (Has(rule->children_refused, child.name)) {
        out_.Error("mjcf.element_not_read", child.at,
                   child.Called() + " in " + element.name + " is not supported");
      } else {
        out_.Error("mjcf.unknown_element", child.at,
                   element.name + " has no element \"" + child.name + "\" in MJCF",
                   DidYouMean(child.name,
                              Words(std::string(rule->children) + " " + rule->children_left_out)));
      }
    }
  }

 private:
  /// `site` in a tendon, and `joint` in `equality`, have a different schema than in a body.
  static std::string KindOf(const std::string& in, const std::string& name) {
    if (in == "spatial") return "spatial/" + name;
    if (in == "equality" && (name == "joint" || name == "tendon")) return "equality/" + name;
    if (name == "frame" || name == "worldbody") return "body";
    return name;
  }

  void LeaveOut(const Element& element, const std::string& kind, const Attribute& a) {
    const std::string called = element.name + "." + a.name;
    for (const Change& change : kChanges) {
      if (!Has(change.elements, kind) || !Has(change.attributes, a.name)) continue;
      const auto is = ToNumbers(a.value), neutral = ToNumbers(change.neutral);
      const bool changes_nothing = is && !is->empty() && is->size() <= neutral->size() &&
                                   std::equal(is->begin(), is->end(), neutral->begin());
      if (changes_nothing) return;
      if (change.consequence == nullptr) {
        out_.Error("mjcf.not_read", a.at, element.Called() + ": " + a.name + " is not supported");
        return;
      }
      const auto [first, fresh] = changes_.try_emplace(change.consequence, Changed{called, a.at});
      first->second.more += !fresh;
      return;
    }
    ++left_out_[called];
  }

  struct Changed {
    std::string called;
    SourceRef at;
    int more = 0;
  };
  LeftOut& left_out_;
  Diagnostics& out_;
  std::map<std::string, Changed> changes_;  ///< Changes by `consequence`.

 public:
  void Warn() const {
    for (const auto& [consequence, its] : changes_) {
      const std::string more =
          its.more > 0 ? " and " + std::to_string(its.more) + " more are" : " is";
      out_.Warning("mjcf.left_out", its.at, its.called + more + " left out: " + consequence);
    }
  }
};

}  // namespace

bool IsActuator(const std::string& element) { return Has(kActuators, element); }

const std::vector<Rule>& Rules() {
  static const std::string kBody = std::string("name childclass mocap gravcomp ") + kTurns;
  static const std::string kGeomRead = kGeom + kTurns;
  static const std::string kSite = std::string("name class fromto ") + kTurns;
  static const std::string kInertial = std::string("mass diaginertia fullinertia ") + kTurns;
  static const std::string kInDefaults =
      std::string("default geom site joint tendon equality pair ") + kActuators;
  static const std::string kGeneral =
      kActuator + "dyntype gaintype biastype dynprm gainprm biasprm inheritrange";
  static const std::string kIntegrated = kActuator + "kp kv dampratio inheritrange";
  static const std::string kCylinder = kActuator + "timeconst bias area diameter";
  static const std::string kPosition = kActuator + "kp kv dampratio timeconst inheritrange";
  static const std::string kVelocity = kActuator + "kv kp";
  static const std::string kOthers =
      kActuatorLeftOut +
      " kp kv gain bias area diameter timeconst range force scale lmin lmax vmax fpmax fvmax "
      "ctrlrange plugin instance dyntype dynprm inheritrange dampratio tausmooth input ki imax "
      "slewmax posrange velrange ffrange cogging controller inductance lugre motorconst nominal "
      "resistance saturation thermal";
  static const char* const kActuatorOut = kActuatorLeftOut.c_str();
  static const std::vector<Rule> kRules{
      {"mujoco", "model", "",
       "compiler option default worldbody contact equality tendon actuator keyframe",
       "size statistic visual asset sensor custom", "extension deformable"},
      {"compiler",
       "angle coordinate eulerseq inertiafromgeom inertiagrouprange autolimits boundmass "
       "boundinertia settotalmass alignfree",
       "balanceinertia strippath fitaabb fusestatic convexhull discardvisual usethread meshdir "
       "texturedir assetdir exactmeshinertia saveinertial conflict passthrough savecanonical "
       "savecompiled",
       "", "lengthrange LRopt", ""},
      {"option", "gravity timestep density viscosity collision actuatorgroupdisable",
       "wind magnetic integrator cone jacobian solver iterations tolerance ls_iterations "
       "ls_tolerance noslip_iterations noslip_tolerance mpr_iterations mpr_tolerance "
       "ccd_iterations ccd_tolerance impratio apirate o_margin o_solref o_solimp o_friction "
       "sdf_iterations sdf_initpoints sleep_tolerance",
       "flag", "", ""},
      {"flag",
       "gravity contact constraint passive spring damper actuation equality clampctrl frictionloss "
       "limit override",
       "warmstart filterparent refsafe sensor energy fwdinv invdiscrete multiccd island nativeccd "
       "eulerdamp midphase autoreset sensornoise sleep diagexact ipc speculative",
       "", "", ""},
      {"default", "class", "", kInDefaults.c_str(), "mesh material camera light texture", ""},
      {"body", kBody.c_str(), "user sleep fuse simple", kBodyParts, kPictures, kNotBodies},
      {"inertial", kInertial.c_str(), "", "", "", ""},
      {"joint", kJoint.c_str(), kJointLeftOut.c_str(), "", "", ""},
      {"freejoint", "name align", "group", "", "", ""},
      {"geom", kGeomRead.c_str(), kGeomLeftOut.c_str(), "", "", "plugin"},
      {"site", kSite.c_str(), "type group size material rgba user mesh", "", "", ""},
      {"tendon", kTendon.c_str(), kTendonLeftOut.c_str(), "spatial", "", "fixed"},
      {"spatial", kTendon.c_str(), kTendonLeftOut.c_str(), "site", "", "geom pulley"},
      {"spatial/site", "site", "", "", "", ""},
      {"actuator", "", "", kActuators, "", ""},
      {"general", kGeneral.c_str(), kActuatorOut, "", "", "plugin"},
      {"motor", kActuator.c_str(), kActuatorOut, "", "", ""},
      {"position", kPosition.c_str(), kActuatorOut, "", "", ""},
      {"velocity", kVelocity.c_str(), kActuatorOut, "", "", ""},
      {"intvelocity", kIntegrated.c_str(), kActuatorOut, "", "", ""},
      {"damper", kActuator.c_str(), kOthers.c_str(), "", "", ""},
      {"cylinder", kCylinder.c_str(), kActuatorOut, "", "", ""},
      {"muscle", kActuator.c_str(), kOthers.c_str(), "", "", ""},
      {"adhesion", kActuator.c_str(), kOthers.c_str(), "", "", ""},
      {"dcmotor", kActuator.c_str(), kOthers.c_str(), "", "", ""},
      {"orientation", kActuator.c_str(), kOthers.c_str(), "", "", ""},
      {"pid", kActuator.c_str(), kOthers.c_str(), "", "", ""},
      {"equality", "active", "class solref solimp",
       "weld connect joint tendon distance flex flexstrain", "", ""},
      {"weld", "name class active body1 body2 site1 site2 relpose anchor",
       "solref solimp torquescale", "", "", ""},
      {"connect", "name class active body1 body2 site1 site2 anchor", "solref solimp", "", "", ""},
      {"contact", "", "", "pair exclude", "", ""},
      {"pair", "name class geom1 geom2 condim friction",
       "solref solreffriction solimp margin gap user adhesion", "", "", ""},
      {"exclude", "name body1 body2", "", "", "", ""},
      {"keyframe", "", "", "key", "", ""},
      {"key", "name qpos qvel ctrl act", "time mpos mquat plastic", "", "", ""},
  };
  return kRules;
}

void CheckSchema(const Element& root, LeftOut& left_out, Diagnostics& out) {
  if (root.name != "mujoco") {
    out.Error("mjcf.root", root.at, "the root element is \"" + root.name + "\", not mujoco",
              root.name == "robot"
                  ? "this is URDF: convert it to MJCF with MuJoCo's program `compile`"
                  : "");
    return;
  }
  Checker checker(left_out, out);
  checker.Run(root, "mujoco");
  checker.Warn();
}

}  // namespace taut::mjcf
