// Linearization: state-space matrices A, B, C, D by automatic differentiation of the step, checked
// against finite differences (docs/theory/linear.md).
#include "taut/state_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "linear/coordinates.h"
#include "linear/linear_equilibrium.h"
#include "plant/find_start.h"

namespace taut {
namespace linear {
namespace {

/// Distances by which bodies are lifted off their contacts, for finite differences and for exact
/// derivatives. A step treats positive gaps by its velocity law, but penetrations by another rule.
/// At a zero gap, the limit between both rules, the step has no derivative.
constexpr double kLiftM = 2e-8, kHairM = 1e-10;

constexpr int kKinds = static_cast<int>(SignalKind::kOther) + 1;

/// States after a tick, then outputs before the tick.
using Column = std::vector<double>;

struct Columns {
  std::vector<Column> of_states, of_inputs;
};

/// Returns states and outputs of a tick from the start, with one coordinate changed.
template <class Num>
std::vector<Num> RunWith(World<Num>& world, const Tick<Num>& tick, const Coordinates& coordinates,
                         const Coordinate* changed, double amount) {
  world.Reset();
  world.Sense();
  TickMemory<Num> memory = tick.MemoryAtRest(world);
  TickInputs<Num> inputs = tick.NoInputs(world);
  Num by = Num::Splat(amount);
  if constexpr (sizeof(Num) > sizeof(double)) by = {0.0, 1.0};
  if (changed != nullptr) {
    for (const auto& [row, unit] : changed->rows) world.Add(row, amount, unit);
    if (changed->quat_row >= 0) {
      const int row = changed->quat_row;
      Num square = Num::Splat(0.0);
      for (int k = 0; k < 4; ++k) square += world.Get(row + k) * world.Get(row + k);
      for (int k = 0; k < 4; ++k) world.Set(row + k, world.Get(row + k) / Sqrt(square));
    }
    const auto index = static_cast<std::size_t>(changed->index);
    if (changed->of == Coordinate::Of::kTarget) inputs.target[index] = by;
    if (changed->of == Coordinate::Of::kVelocityInput) inputs.velocity_input[index] = by;
    if (changed->of == Coordinate::Of::kMemory) {
      control::ImpedanceMemory<Num>& at = memory[index / 3];
      (index % 3 == 0   ? at.pid.error_before
       : index % 3 == 1 ? at.pid.integral
                        : at.difference.length_before_m) += by;
    }
    world.Sense();
  }
  const std::vector<Num> seen = coordinates.Outputs(world);
  tick.Run(world, memory, inputs);
  std::vector<Num> out = coordinates.States(world, memory);
  out.insert(out.end(), seen.begin(), seen.end());
  return out;
}

class Finder {
 public:
  Finder(const Rest& rest)
      : plain_tick_(rest.driven, rest.step_s),
        dual_tick_(rest.driven, rest.step_s),
        plain_(rest.model, *rest.batch, kTolerance),
        dual_(rest.model, *rest.batch),
        coordinates_(Sensed(plain_), plain_tick_) {
    const std::vector<ContactState> contacts = rest.batch->Contacts(0);
    Lift(contacts, kLiftM, plain_);
    if (dual_.good()) Lift(contacts, kHairM, dual_);
  }

  const Coordinates& coordinates() const noexcept { return coordinates_; }
  bool has_exact() const noexcept { return dual_.good(); }

  Column Exact(const Coordinate& c) {
    Column column;
    for (const Dual& x : RunWith(dual_, dual_tick_, coordinates_, &c, 0.0)) column.push_back(x.d);
    return column;
  }

  Column At(const Coordinate* c, double amount) {
    Column column;
    for (const Plain& x : RunWith(plain_, plain_tick_, coordinates_, c, amount)) {
      column.push_back(x.v);
    }
    return column;
  }

  /// Returns central differences for a step size, its half and its quarter, combined to cancel
  /// errors of first order (motors with limits: x |x|) and second order (L4). `apart` receives the
  /// difference between the one-sided slopes.
  Column Differences(const Coordinate& c, const Column& at_rest, Column& apart) {
    std::array<Column, 3> of;
    double d = c.small;
    for (Column& column : of) {
      column = At(&c, d);
      const Column back = At(&c, -d);
      apart.resize(column.size());
      for (std::size_t i = 0; i < column.size(); ++i) {
        apart[i] = (column[i] - 2 * at_rest[i] + back[i]) / d;
        column[i] = (column[i] - back[i]) / (2 * d);
      }
      d /= 2;
    }
    for (std::size_t i = 0; i < of[0].size(); ++i) {
      const double wide = 2 * of[1][i] - of[0][i], narrow = 2 * of[2][i] - of[1][i];
      of[0][i] = (4 * narrow - wide) / 3;
    }
    return of[0];
  }

 private:
  /// Finite differences require small residuals of the solver.
  static constexpr double kTolerance = 1e-12;

  template <class Num>
  static void Lift(const std::vector<ContactState>& contacts, double by_m, World<Num>& world) {
    std::vector<std::pair<int, Vec3>> done;
    world.Reset();
    for (const ContactState& c : contacts) {
      const auto same = [&c](const std::pair<int, Vec3>& d) {
        return d.first == c.body_a && Dot(d.second, c.normal) > 0.999;
      };
      if (c.body_b != kWorld || std::any_of(done.begin(), done.end(), same)) continue;
      done.emplace_back(c.body_a, c.normal);
      const int row = world.layout().pos + 3 * c.body_a;
      const double way[] = {c.normal.x, c.normal.y, c.normal.z};
      for (int k = 0; k < 3; ++k)
        world.Set(row + k, world.Get(row + k) + Num::Splat(by_m * way[k]));
    }
    world.StartHere();
  }
  static World<Plain>& Sensed(World<Plain>& world) {
    world.Sense();
    return world;
  }

  Tick<Plain> plain_tick_;
  Tick<Dual> dual_tick_;
  World<Plain> plain_;
  World<Dual> dual_;
  Coordinates coordinates_;
};

/// Returns a small change of a kind of signal. Changes of different kinds have similar relevance.
double SmallOf(SignalKind kind) {
  switch (kind) {
    case SignalKind::kPlace:
    case SignalKind::kLength:
      return 1e-6;
    case SignalKind::kTurn:
      return 1e-5;
    case SignalKind::kVelocity:
    case SignalKind::kRate:
      return 1e-4;
    default:
      return 1e-3;
  }
}

/// Largest matrix entry for each pair of kinds.
class Sizes {
 public:
  Sizes(const std::vector<SignalKind>& rows) : rows_(rows) {}
  void Add(SignalKind of, const Column& column) {
    for (std::size_t i = 0; i < column.size(); ++i) {
      double& most = At(rows_[i], of);
      most = std::max(most, std::fabs(column[i]));
    }
  }
  /// Returns the largest entry of `column`, relative to the largest entry of its pair of kinds.
  /// `which` receives its index.
  double Share(SignalKind of, const Column& column, std::size_t& which) const {
    // Lower limit of the reference size, in units of SmallOf(result) / SmallOf(changed quantity).
    constexpr double kNothing = 1e-4;
    double most = 0;
    for (std::size_t i = 0; i < column.size(); ++i) {
      const double floor = kNothing * SmallOf(rows_[i]) / SmallOf(of);
      const double size = std::max(At(rows_[i], of), floor);
      const double share = std::fabs(column[i]) / size;
      if (!(share <= most)) most = share, which = i;
    }
    return most;
  }

 private:
  double& At(SignalKind row, SignalKind of) {
    return sizes_[static_cast<std::size_t>(row)][static_cast<std::size_t>(of)];
  }
  double At(SignalKind row, SignalKind of) const {
    return sizes_[static_cast<std::size_t>(row)][static_cast<std::size_t>(of)];
  }
  std::vector<SignalKind> rows_;
  std::array<std::array<double, kKinds>, kKinds> sizes_{};
};

Column Less(const Column& a, const Column& b) {
  Column out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = a[i] - b[i];
  return out;
}

/// Returns the states to keep. A state is dropped if it affects only itself and other dropped
/// states.
std::vector<std::size_t> KeptStates(const std::vector<Coordinate>& states,
                                    const std::vector<Column>& columns) {
  constexpr double kNothing = 1e-10;
  const std::size_t n = states.size();
  std::vector<bool> stays(n, true);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t j = 0; j < n; ++j) {
      if (!stays[j] || !states[j].may_go) continue;
      bool matters = false;
      for (std::size_t i = 0; i < columns[j].size() && !matters; ++i) {
        if (i == j || (i < n && !stays[i])) continue;
        const double unit = i < n ? SmallOf(states[i].kind) : 1e-6;
        matters = std::fabs(columns[j][i]) * SmallOf(states[j].kind) > kNothing * unit;
      }
      if (!matters) stays[j] = false, changed = true;
    }
  }
  std::vector<std::size_t> kept;
  for (std::size_t j = 0; j < n; ++j) {
    if (stays[j]) kept.push_back(j);
  }
  return kept;
}

void Fill(const Coordinates& c, const Columns& columns, StateSpace& out) {
  const std::size_t all = c.states().size();
  const std::vector<std::size_t> kept = KeptStates(c.states(), columns.of_states);
  const int n = static_cast<int>(kept.size()), m = static_cast<int>(c.inputs().size());
  const int p = static_cast<int>(c.outputs().size());
  out.A = Matrix(n, n), out.B = Matrix(n, m), out.C = Matrix(p, n), out.D = Matrix(p, m);
  const auto put = [&](const Column& column, int j, Matrix& next, Matrix& seen) {
    for (int i = 0; i < n; ++i) next(i, j) = column[kept[static_cast<std::size_t>(i)]];
    for (int i = 0; i < p; ++i) seen(i, j) = column[all + static_cast<std::size_t>(i)];
  };
  for (int j = 0; j < n; ++j) {
    const std::size_t from = kept[static_cast<std::size_t>(j)];
    put(columns.of_states[from], j, out.A, out.C);
    out.states.push_back(c.states()[from].signal);
  }
  for (int j = 0; j < m; ++j) put(columns.of_inputs[static_cast<std::size_t>(j)], j, out.B, out.D);
  for (const Coordinate& input : c.inputs()) out.inputs.push_back(input.signal);
  for (const Coordinate& output : c.outputs()) out.outputs.push_back(output.signal);
}

/// Computes exact and finite-difference columns and compares them. Returns false and sets `why` at
/// a kink.
bool FindColumns(Finder& finder, const LinearOptions& options, StateSpace& out, Columns& columns) {
  constexpr double kAgrees = 1e-5, kKink = 1e-2;
  const Coordinates& c = finder.coordinates();
  const Column at_rest = finder.At(nullptr, 0.0);
  std::vector<SignalKind> kinds;
  for (const Coordinate& s : c.states()) kinds.push_back(s.kind);
  for (const Coordinate& s : c.outputs()) kinds.push_back(s.kind);
  const auto name_of = [&](std::size_t i) {
    return i < c.states().size() ? c.states()[i].signal.name
                                 : c.outputs()[i - c.states().size()].signal.name;
  };
  Sizes sizes(kinds);
  std::vector<const Coordinate*> all;
  for (const Coordinate& s : c.states()) all.push_back(&s);
  for (const Coordinate& s : c.inputs()) all.push_back(&s);
  std::vector<Column> exact, rough, apart(all.size());
  for (std::size_t j = 0; j < all.size(); ++j) {
    if (options.go_on && !options.go_on()) {
      out.why = "the computation was interrupted";
      return false;
    }
    rough.push_back(finder.Differences(*all[j], at_rest, apart[j]));
    exact.push_back(finder.has_exact() ? finder.Exact(*all[j]) : rough.back());
    sizes.Add(all[j]->kind, rough.back());
  }
  std::string worst;
  for (std::size_t j = 0; j < all.size(); ++j) {
    std::size_t which = 0;
    if (!(sizes.Share(all[j]->kind, apart[j], which) < kKink)) {
      out.why = "a contact or cable is at a limit: the derivatives of " + name_of(which) +
                " for an increase and a decrease of " + all[j]->signal.name + " differ";
      out.hint = "change the start or the rest lengths, or increase friction";
      return false;
    }
    const double share = sizes.Share(all[j]->kind, Less(exact[j], rough[j]), which);
    if (share <= out.disagreement) continue;
    out.disagreement = share;
    worst = name_of(which) + " by " + all[j]->signal.name;
  }
  out.derivatives = Derivatives::kExact;
  if (options.differences || !finder.has_exact() || !(out.disagreement < kAgrees)) {
    out.derivatives = Derivatives::kDifferences;
    if (!options.differences) {
      out.remarks.push_back(
          finder.has_exact()
              ? "derivatives are finite differences: the exact ones deviate from them (" + worst +
                    ")"
              : "derivatives are finite differences: this build has no exact ones");
    }
  }
  std::vector<Column>& of = out.derivatives == Derivatives::kExact ? exact : rough;
  for (std::size_t j = 0; j < all.size(); ++j) {
    (j < c.states().size() ? columns.of_states : columns.of_inputs).push_back(std::move(of[j]));
  }
  return true;
}

}  // namespace
}  // namespace linear

StateSpace FindStateSpace(const ExperimentSpec& experiment, const LinearOptions& options,
                          Diagnostics& out) {
  StateSpace system;
  linear::Rest rest = linear::FindRest(experiment, options, out);
  system.remarks = std::move(rest.remarks);
  system.why = rest.why, system.hint = rest.hint;
  if (!rest.batch) return system;
  system.pose = plant::PoseOf(*rest.batch);
  for (const double step_s : rest.step_s) system.period_s += step_s;
  system.step_s = rest.step_s.front();
  for (const BodyDef& body : rest.model->def().bodies) system.bodies.push_back(body.name);
  for (const CableDef& cable : rest.model->def().cables) system.cables.push_back(cable.name);
  linear::Finder finder(rest);
  linear::Columns columns;
  if (!linear::FindColumns(finder, options, system, columns)) return system;
  linear::Fill(finder.coordinates(), columns, system);
  system.found = true;
  return system;
}

std::optional<int> FindSignal(const std::vector<LinearSignal>& signals, const std::string& name) {
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (signals[i].name == name) return static_cast<int>(i);
  }
  return std::nullopt;
}

}  // namespace taut
