// Integration scheme of each cable of a model for a step length, and the number of substeps.
#include "taut/cable_scheme.h"

#include <algorithm>
#include <cmath>

#include "sim/batch/substeps.h"
#include "sim/data/cable_groups.h"
#include "sim/data/tables.h"

namespace taut {
namespace {

std::size_t At(int i) { return static_cast<std::size_t>(i); }

/// Groups of the cables of a model, for a step length.
class ModelGroups {
 public:
  ModelGroups(const sim::Tables& tables, double step_s) : tables_(tables) {
    for (const CableDef& cable : def().cables) {
      k_max_ = std::max(k_max_, cable.stiffness_n_per_m);
    }
    const auto bodies = At(view_.body_count);
    group_.resize(bodies), size_.resize(bodies), kind_.resize(bodies);
    sim::FindGroups(
        view_, step_s, [&](int body) { return Moves(body); }, [&](int c) { return Stiffness(c); },
        [&](int c) { return cable(c).damping_n_s_per_m > 0; }, groups());
  }

  const sim::View& view() const { return view_; }
  const CableDef& cable(int c) const { return def().cables[At(c)]; }
  sim::CableGroups groups() { return {group_.data(), size_.data(), kind_.data()}; }

  /// Returns K of eq. 7 [1/s^2].
  double Stiffness(int c) const {
    return std::min(tables_.coupling[At(c)] * cable(c).stiffness_n_per_m,
                    tables_.largest_coupling * k_max_);
  }
  template <class F>
  void ForEachMovedBy(int c, const F& f) const {
    sim::ForEachMoved(
        view_, view_.cables[c], [&](int body) { return Moves(body); }, f);
  }

 private:
  const ModelDef& def() const { return tables_.def(); }
  bool Moves(int body) const { return !def().bodies[At(body)].fixed; }

  const sim::Tables& tables_;
  sim::View view_ = tables_.View();
  double k_max_ = 0;
  std::vector<int> group_, size_;
  std::vector<std::uint8_t> kind_;
};

}  // namespace

namespace sim {

int SubstepRule::CountOf(double step_s) const noexcept {
  const double parts = step_s * rate_per_s;
  if (!(parts > 1)) return 1;
  return static_cast<int>(std::min(std::ceil(parts), static_cast<double>(kMostSubsteps)));
}

bool SubstepRule::IsEnough(double step_s) const noexcept {
  return !(step_s * rate_per_s > kMostSubsteps);
}

SubstepRule SubstepRuleOf(const Tables& tables) {
  /// Fraction of the critical damping. With less damping, cables with fixed directions gained
  /// energy.
  constexpr double kEnoughDamping = 0.05;
  ModelGroups model(tables, 1.0);
  const CableGroups groups = model.groups();
  SubstepRule rule;
  for (int c = 0; c < tables.cable_count; ++c) {
    bool other = false;
    model.ForEachMovedBy(c, [&](int body) {
      other = other || (groups.kind[groups.group[body]] & kGroupOther) != 0;
    });
    const double K = model.Stiffness(c), k = model.cable(c).stiffness_n_per_m;
    const double damping = 0.5 * model.cable(c).damping_n_s_per_m * std::sqrt(K) / k;
    if (!other || (model.view().cables[c].touch < 0 && damping >= kEnoughDamping)) continue;
    const double rate_per_s = std::sqrt(K / kSubstepSpring);
    if (rate_per_s > rule.rate_per_s) rule = {rate_per_s, c};
  }
  return rule;
}

}  // namespace sim

int SubstepCount(const Model& model, double step_s) {
  return sim::SubstepRuleOf(static_cast<const sim::Tables&>(model)).CountOf(step_s);
}

std::vector<CableScheme> CableSchemes(const Model& model, double step_s) {
  const double part_s = step_s / SubstepCount(model, step_s);
  ModelGroups all(static_cast<const sim::Tables&>(model), part_s);
  const sim::CableGroups groups = all.groups();
  std::vector<CableScheme> schemes;
  for (int c = 0; c < all.view().cable_count; ++c) {
    const bool stiff = all.Stiffness(c) > sim::kSoftSpring / (part_s * part_s);
    CableScheme scheme = stiff ? CableScheme::kAlong : CableScheme::kExplicit;
    all.ForEachMovedBy(c, [&](int body) {
      if (!groups.IsImplicit(body)) return;
      scheme = groups.HasSecondStage(body) ? CableScheme::kImplicitDamped : CableScheme::kImplicit;
    });
    schemes.push_back(scheme);
  }
  return schemes;
}

}  // namespace taut
