// Cables and bars from MuJoCo tendons with their springs, dampers and actuators.
#include <algorithm>
#include <cmath>

#include "base/brief.h"
#include "math/vec.h"
#include "mjcf/mjcf_build.h"

namespace taut::mjcf {
namespace {

/// Tension of a tendon by its springs, dampers and actuators: T = k l - c + b dl/dt.
struct Law {
  double k = 0, b = 0, c = 0;
  double gain = 0;       ///< Decrease of c per unit of control, for a tendon with one actuator.
  double c_at_zero = 0;  ///< c if all controls are 0.
  int actuators = 0;
  double lag_s = 0;  ///< Largest lag of the tendon's actuators.
  bool pushes = false, damps_slack = false, has_most = false, has_least = false;
};

class CableBuilder {
 public:
  CableBuilder(const Key* key, Building& b) : b_(b), scene_(b.scene), key_(key) {}

  void Run() {
    for (std::size_t t = 0; t < scene_.tendons.size(); ++t) Build(static_cast<int>(t));
    Tell();
  }

 private:
  /// Returns the initial control. For an actuator with a lag, returns its activation if the
  /// keyframe contains it.
  double Control(std::size_t actuator) const {
    const auto& state = scene_.actuators[actuator].state;
    if (state && key_ && !key_->act.empty()) return key_->act[*state];
    double u = key_ && !key_->ctrl.empty() ? key_->ctrl[actuator] : 0;
    const auto& range = scene_.actuators[actuator].control_range;
    if (range && scene_.clamps_controls) u = std::clamp(u, range->first, range->second);
    return u;
  }

  /// Returns the tendon's length at qpos0.
  double Length(const Tendon& tendon) const {
    double length = 0;
    for (std::size_t i = 0; i + 1 < tendon.sites.size(); ++i) {
      const Vec3 d = scene_.sites[Scene::Index(tendon.sites[i + 1])].p -
                     scene_.sites[Scene::Index(tendon.sites[i])].p;
      length += std::sqrt(Dot(d, d));
    }
    return length;
  }

  Law LawOf(int index) {
    const Tendon& tendon = scene_.tendons[Scene::Index(index)];
    Law law;
    law.k = tendon.stiffness, law.b = tendon.damping;
    law.damps_slack = tendon.damping > 0;
    if (tendon.stiffness > 0) {
      const double longest = tendon.springlength[1];
      law.c = tendon.stiffness * (longest < 0 ? Length(tendon) : longest);
      law.pushes = tendon.springlength[0] != 0;
    }
    law.c_at_zero = law.c;
    for (std::size_t a = 0; a < scene_.actuators.size(); ++a) {
      const Actuator& actuator = scene_.actuators[a];
      if (actuator.tendon != index) continue;
      ++law.actuators;
      law.k -= actuator.bias[1], law.b -= actuator.bias[2];
      law.c += actuator.bias[0] + actuator.gain * Control(a), law.c_at_zero += actuator.bias[0];
      law.gain = actuator.gain;
      law.lag_s = std::max(law.lag_s, actuator.lag_s);
      const auto& range = actuator.force_range;
      if (!range || range->second > 0) law.pushes = true;
      if (range && range->first > -1e9) law.has_most = true;
      if (range && range->second < 0) law.has_least = true;
    }
    return law;
  }

  /// Returns the initial tension by MuJoCo's equations, for a given length of the tendon.
  double TensionInMujoco(int index, double length) const {
    const Tendon& tendon = scene_.tendons[Scene::Index(index)];
    double shortest = tendon.springlength[0], longest = tendon.springlength[1];
    if (longest < 0) shortest = longest = Length(tendon);
    const double stretch = length > longest    ? length - longest
                           : length < shortest ? length - shortest
                                               : 0;
    double tension = tendon.stiffness * stretch;
    for (std::size_t a = 0; a < scene_.actuators.size(); ++a) {
      const Actuator& actuator = scene_.actuators[a];
      if (actuator.tendon != index) continue;
      const auto& range = actuator.force_range;
      const double push = actuator.gain * Control(a) + actuator.bias[0] + actuator.bias[1] * length;
      tension -= range ? std::clamp(push, range->first, range->second) : push;
    }
    return tension;
  }

  /// Reports an error if the cable's initial tension differs from MuJoCo's. Causes: an actuator is
  /// at its force limit, or the spring is slack while an actuator pulls. Another warning covers
  /// tendons that push in MuJoCo.
  void CheckStart(int index, const Law& law, double length) {
    const Tendon& tendon = scene_.tendons[Scene::Index(index)];
    const double theirs = TensionInMujoco(index, length);
    const double ours = std::max(0.0, law.k * length - law.c);
    const double size = law.k * length + std::fabs(law.c);
    if (std::fabs(std::max(theirs, 0.0) - ours) <= 1e-9 * size) return;
    b_.out.Error("mjcf.tension_differs", tendon.at,
                 "tendon \"" + tendon.name + "\" starts with a tension of " + Shown(theirs) +
                     " in MuJoCo, but " + Shown(ours) + " as a cable: a cable has no force limit " +
                     "(forcerange), and its spring and actuator go slack together",
                 "choose a keyframe or values at which no limit is active at the start");
  }

  void Build(int index) {
    const Tendon& tendon = scene_.tendons[Scene::Index(index)];
    const std::string called = "tendon \"" + tendon.name + "\"";
    const Law law = LawOf(index);
    const bool limits = tendon.range && scene_.has_limits;
    if (law.k == 0 && law.b == 0 && law.actuators == 0) {
      if (tendon.friction > 0) {
        b_.out.Error("mjcf.frictionloss_without_stiffness", tendon.at,
                     called + " has dry friction (frictionloss) but no stiffness",
                     "set stiffness and springlength to make it a cable");
      }
      if (!limits) {
        scene_.pictures += tendon.friction == 0;
        return;
      }
      b_.out.Error("mjcf.limit_without_stiffness", tendon.at,
                   called + " has a length limit (range) but no stiffness",
                   "set stiffness and springlength to make it a cable");
      return;
    }
    if (limits) limits_.push_back(&tendon);
    if (!(law.k > 0)) {
      b_.out.Error("mjcf.no_stiffness", tendon.at,
                   called + (law.actuators > 0 ? " has an actuator but no stiffness"
                                               : " has damping but no stiffness"),
                   "set `stiffness` of the tendon, or `biasprm` or `kp` of the actuator");
      return;
    }
    if (law.b < 0) {
      b_.out.Error("mjcf.negative_damping", tendon.at, called + " has a negative damping");
      return;
    }
    const double rest = law.c / law.k;
    if (!(rest > 0) || !std::isfinite(rest)) {
      b_.out.Error("mjcf.no_rest_length", tendon.at,
                   "the rest length of " + called +
                       " at the start must be positive and finite, got " + Shown(rest),
                   law.actuators > 0 ? KeyHint() : "set springlength");
      return;
    }
    std::vector<AttachmentDef> ends;
    for (const int site : tendon.sites) {
      const NodeDef& node = b_.def().nodes[Scene::Index(b_.node_of_site[Scene::Index(site)])];
      ends.push_back({node.body, node.position_m});
    }
    const bool in_one_body = std::all_of(ends.begin(), ends.end(), [&](const AttachmentDef& end) {
      return end.body == ends.front().body;
    });
    if (in_one_body) {
      idle_.push_back(&tendon);
      return;
    }
    double length = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const Vec3 d = ends[i + 1].position_m - ends[i].position_m;
      if (Dot(d, d) == 0) {
        b_.out.Error("mjcf.sites_in_one_place", tendon.at,
                     called + ": two consecutive sites coincide");
        return;
      }
      length += std::sqrt(Dot(d, d));
    }
    if (law.actuators > 0) CheckStart(index, law, length);
    const std::string name = b_.pairs.Take(NameOf(tendon));
    if (law.pushes && b_.options.slack == MjcfSlack::kAsMujoco) {
      AddBar(tendon, law, rest, ends, name);
      return;
    }
    if (law.pushes) bilateral_.push_back(&tendon);
    pushing_ += law.pushes && length < rest;
    if (law.damps_slack) damped_.push_back(&tendon);
    if (law.actuators > 0 && tendon.stiffness > 0) summed_.push_back(&tendon);
    if (law.has_most) capped_.push_back(&tendon);
    if (law.has_least) pulled_.push_back(&tendon);
    if (tendon.friction > 0) {
      if (!b_.options.without_frictionloss) {
        b_.out.Error("mjcf.frictionloss", tendon.at,
                     called + ": frictionloss of a cable is not supported",
                     "leave it out with --without_frictionloss, or import bars with --slack "
                     "as_mujoco, which have friction");
      }
      rough_.push_back(&tendon);
    }
    if (law.lag_s > 0) lagging_.push_back(&tendon);
    longest_lag_s_ = std::max(longest_lag_s_, law.lag_s);
    CableDef cable;
    cable.name = name, cable.attachments = std::move(ends);
    cable.stiffness_n_per_m = law.k, cable.damping_n_s_per_m = law.b;
    cable.rest_length_m = rest;
    if (law.actuators > 0) {
      cable.actuator.kind = ActuatorDef::Kind::kIdeal;
      CountControl(law, cable);
    }
    b_.def().cables.push_back(std::move(cable));
    Tags tags{name};
    const std::size_t dot = name.rfind('.');
    if (dot != name.npos && IsName(name.substr(dot + 1)) && name.find('.') == dot) {
      tags.push_back(name.substr(dot + 1));
    }
    const std::string tag = tendon.tag.empty() ? "" : ToName(tendon.tag, "");
    if (!tag.empty() && tag != name) tags.push_back(tag);
    b_.made.robot.cable_tags.push_back(std::move(tags));
    b_.made.robot.cable_sources.push_back(tendon.at);
  }

  /// Returns the tendon's name, or a similar name that is valid for a pair.
  std::string NameOf(const Tendon& tendon) const {
    std::string by_nodes, shorter, placement;
    bool inside = true;
    for (const int site : tendon.sites) {
      const std::string& node =
          b_.def().nodes[Scene::Index(b_.node_of_site[Scene::Index(site)])].name;
      const std::size_t dot = node.rfind('.');
      const std::string its = dot == node.npos ? "" : node.substr(0, dot);
      by_nodes += (by_nodes.empty() ? "" : "-") + node;
      if (site == tendon.sites.front()) placement = its;
      inside = inside && !its.empty() && its == placement;
    }
    const bool own = inside && tendon.name.starts_with(placement + ".") &&
                     IsName(tendon.name.substr(placement.size() + 1));
    return tendon.name == by_nodes || own ? tendon.name : ToName(tendon.name, "cable");
  }

  void AddBar(const Tendon& tendon, const Law& law, double rest,
              const std::vector<AttachmentDef>& ends, const std::string& name) {
    const bool dead_band = tendon.springlength[0] != tendon.springlength[1] && tendon.stiffness > 0;
    if (ends.size() != 2 || law.actuators > 0 || dead_band) {
      b_.out.Error("mjcf.tendon_pushes", tendon.at,
                   "tendon \"" + tendon.name +
                       "\" can push, but cannot become a bar: a bar needs two sites and "
                       "one springlength, and has no actuator",
                   "use --slack tension_only to import it as a cable");
      return;
    }
    JointDef bar;
    bar.name = name, bar.kind = JointKind::kDistance;
    bar.body_a = ends[0].body, bar.from_m = ends[0].position_m;
    bar.body_b = ends[1].body, bar.to_m = ends[1].position_m;
    if (bar.body_b == kWorld) {
      std::swap(bar.body_a, bar.body_b);
      std::swap(bar.from_m, bar.to_m);
    }
    bar.stiffness = law.k, bar.damping = law.b, bar.rest = rest, bar.friction = tendon.friction;
    bar.collides = true;
    b_.def().joints.push_back(bar);
    b_.made.robot.joint_tags.push_back({name});
  }

  void CountControl(const Law& law, const CableDef& cable) {
    const double per_control = law.gain / law.k, at_zero = law.c_at_zero / law.k;
    if (law.actuators > 1) {
      ++several_;
    } else if (std::fabs(per_control - 1) < 1e-12) {
      ++(law.c_at_zero == 0 ? absolute_ : relative_);
    } else {
      if (other_++ == 0) {
        const double length = b_.options.length_unit_m.value_or(1);
        example_ = "\"" + cable.name + "\": " + Shown(length * at_zero) + " m" +
                   (per_control < 0 ? " - " : " + ") + Shown(length * std::fabs(per_control)) +
                   " m u";
      }
    }
  }

  void Tell() {
    const auto note = [&](int count, const std::string& text) {
      if (count > 0) b_.Note(Count(static_cast<std::size_t>(count), "control") + text);
    };
    note(absolute_, " of MuJoCo: rest lengths of cables");
    note(relative_, " of MuJoCo: changes of rest lengths of cables");
    note(other_, " u of MuJoCo: rest lengths at another scale, such as " + example_);
    note(several_, " of MuJoCo: several per cable, whose rest length follows from their sum");
    if (!bilateral_.empty()) {
      b_.out.Warning(
          "mjcf.bilateral_tendons", bilateral_[0]->at,
          Count(bilateral_.size(), "tendon") +
              " would push in MuJoCo when shorter than the rest length, but cables only pull; " +
              std::to_string(pushing_) + " of them would push at the start",
          "use --slack as_mujoco to import them as bars");
    }
    if (!damped_.empty()) {
      b_.out.Warning("mjcf.dampers_of_slack_tendons", damped_[0]->at,
                     Count(damped_.size(), "damper") +
                         " of tendons would also act on slack tendons in MuJoCo; dampers of cables "
                         "act only under tension");
    }
    Some(summed_,
         " a spring and an actuator: they become one cable, slack only if their sum would push");
    Some(capped_, " a maximum tension (forcerange), which is left out");
    Some(pulled_, " a minimum tension (forcerange), which is left out");
    Some(limits_, " a length limit (range), which is left out");
    Some(rough_, " dry friction (frictionloss), which is left out");
    Some(lagging_, " actuators with a lag behind their controls (dyntype), of up to " +
                       Shown(longest_lag_s_) + " s; rest lengths of cables follow at once");
    Some(idle_, " all sites in one body and no effect: left out");
  }
  void Some(const std::vector<const Tendon*>& tendons, const std::string& what) {
    if (tendons.empty()) return;
    const std::size_t more = tendons.size() - 1;
    b_.out.Warning("mjcf.tendons_changed", tendons[0]->at,
                   "tendon \"" + tendons[0]->name + "\"" +
                       (more > 0 ? " and " + std::to_string(more) + " more have" : " has") + what);
  }

  std::string KeyHint() const {
    const bool chosen = key_ && !key_->ctrl.empty();
    for (const Key& key : scene_.keys) {
      if (chosen || key.ctrl.empty()) continue;
      const std::string name = key.name.empty() ? "0" : key.name;
      return "the controls are 0 there; choose others with --keyframe " + name;
    }
    return "it follows from the control of its actuator";
  }
  static std::string Shown(double number) { return base::Brief(number, 6); }

  Building& b_;
  Scene& scene_;
  const Key* key_;
  int pushing_ = 0;
  int absolute_ = 0, relative_ = 0, other_ = 0, several_ = 0;
  std::string example_;
  std::vector<const Tendon*> bilateral_, damped_, summed_, capped_, pulled_, limits_, rough_,
      lagging_, idle_;
  double longest_lag_s_ = 0;
};

}  // namespace

void BuildCables(const Key* key, Building& b) { CableBuilder(key, b).Run(); }

}  // namespace taut::mjcf
