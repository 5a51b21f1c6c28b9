// Form finding of robots from force densities or tensions of their cables
// (docs/theory/inverse_statics.md, section 5).
#include "taut/form_finding.h"

#include <cmath>

#include "math/cable_law.h"
#include "math/vec.h"
#include "taut/statics.h"

namespace taut {
namespace {

/// Returns the model with cables whose tension is force density times length.
ModelDef WithDensities(const ModelDef& def, const std::vector<double>& density_n_per_m) {
  ModelDef pulled = def;
  for (std::size_t i = 0; i < pulled.cables.size(); ++i) {
    pulled.cables[i].stiffness_n_per_m = density_n_per_m[i];
    pulled.cables[i].rest_length_m = 0;
  }
  return pulled;
}

bool Check(const RobotSpec& robot, const FormOptions& options, Diagnostics& out) {
  const std::size_t before = out.items().size();
  const std::vector<CableDef>& cables = robot.def.cables;
  const bool densities = !options.force_density_n_per_m.empty();
  if (densities == !options.tension_n.empty()) {
    out.Error("form_finding.densities_or_tensions", {},
              "form finding needs either force densities or tensions of the cables");
    return false;
  }
  const std::vector<double>& given = densities ? options.force_density_n_per_m : options.tension_n;
  if (given.size() != cables.size()) {
    out.Error("form_finding.wrong_number", {},
              "there are " + std::to_string(given.size()) + " force densities or tensions for " +
                  std::to_string(cables.size()) + " cables");
    return false;
  }
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (given[i] > 0 && std::isfinite(given[i])) continue;
    out.Error("form_finding.not_positive", {},
              "cable " + cables[i].name + " must have a force density or tension above 0");
  }
  return out.items().size() == before;
}

class FormSearch {
 public:
  FormSearch(const RobotSpec& robot, const FormOptions& options)
      : robot_(robot), options_(options) {
    loads_.weight = options.weight;
    equilibrium_.contact = options.contact;
  }

  Form Run(Diagnostics& out) {
    Form form;
    std::vector<double> density = options_.force_density_n_per_m;
    if (density.empty()) density = DensitiesAt(robot_.def);
    Pose pose;
    for (int round = 0; round < kMostRounds; ++round) {
      const Equilibrium relaxed =
          FindEquilibrium(WithDensities(robot_.def, density), loads_, equilibrium_);
      if (!relaxed.found) {
        form.why = "the cables have no equilibrium form: " + relaxed.why;
        return form;
      }
      pose = relaxed.pose;
      if (options_.tension_n.empty()) break;
      equilibrium_.from = relaxed.pose;
      const std::vector<double> next = DensitiesAt(ModelAt(robot_.def, pose));
      double change = 0;
      for (std::size_t i = 0; i < next.size(); ++i) {
        change = std::fmax(change, std::fabs(next[i] / density[i] - 1));
      }
      if (change < kSame) break;
      if (round + 1 == kMostRounds) {
        form.why =
            "tensions did not converge; their last relative change is " + std::to_string(change);
        return form;
      }
      density = next;
    }
    if (Collapsed(pose, form.why)) return form;
    if (!SetRestLengths(density, pose, out)) {
      form.why = "some cables are too soft";
      return form;
    }
    form.robot = RobotAt(robot_, pose);
    equilibrium_.from = std::nullopt;
    form.equilibrium = FindEquilibrium(form.robot.def, loads_, equilibrium_);
    form.found = form.equilibrium.found;
    if (!form.found) form.why = "the form is not in equilibrium: " + form.equilibrium.why;
    return form;
  }

 private:
  static constexpr int kMostRounds = 300;
  static constexpr double kSame = 1e-10, kNothing = 1e-6;

  std::vector<double> DensitiesAt(const ModelDef& def) const {
    std::vector<double> density;
    for (std::size_t i = 0; i < def.cables.size(); ++i) {
      density.push_back(options_.tension_n[i] / CableLength(def.cables[i]));
    }
    return density;
  }

  /// Returns whether a cable has length zero. `why` receives the error message.
  bool Collapsed(const Pose& pose, std::string& why) const {
    const ModelDef there = ModelAt(robot_.def, pose);
    double longest = 0;
    for (const CableDef& cable : there.cables) longest = std::fmax(longest, CableLength(cable));
    for (const CableDef& cable : there.cables) {
      if (CableLength(cable) > kNothing * longest) continue;
      why = "the form collapses: cable " + cable.name +
            " pulls its ends into one point, and other members are too weak to keep them apart";
      return true;
    }
    return false;
  }

  /// Sets rest lengths L = l - q l / k.
  bool SetRestLengths(const std::vector<double>& density, Pose& pose, Diagnostics& out) const {
    const std::size_t before = out.items().size();
    const ModelDef there = ModelAt(robot_.def, pose);
    for (std::size_t i = 0; i < there.cables.size(); ++i) {
      const CableDef& cable = there.cables[i];
      const double length = CableLength(cable), tension = density[i] * length;
      pose.rest_lengths_m[i] = length - math::CableLaw{cable.stiffness_n_per_m}.Stretch(tension);
      if (pose.rest_lengths_m[i] > 0) continue;
      out.Error("form_finding.cable_too_soft",
                i < robot_.cable_sources.size() ? robot_.cable_sources[i] : SourceRef{},
                "cable " + cable.name + " is too soft: " + std::to_string(tension) +
                    " N would stretch it by more than its length of " + std::to_string(length) +
                    " m",
                "reduce its tension, or increase its stiffness");
    }
    return out.items().size() == before;
  }

  const RobotSpec& robot_;
  const FormOptions& options_;
  LoadCaseSpec loads_;
  EquilibriumOptions equilibrium_;
};

}  // namespace

Form FindForm(const RobotSpec& robot, const FormOptions& options, Diagnostics& out) {
  Form none;
  none.why = "the options are invalid";
  if (!Check(robot, options, out)) return none;
  return FormSearch(robot, options).Run(out);
}

}  // namespace taut
