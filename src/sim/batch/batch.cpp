// Batches of worlds: choice of the SIMD kernel, memory, starts, steps, and setters of the state.
#include "taut/world_batch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/batch/batch_impl.h"
#include "sim/batch/kernels.h"
#include "sim/compile/model_check.h"
#include "sim/compile/start_values.h"
#include "taut/instruction_sets.h"

namespace taut {
namespace {

Simd WidestUpTo(Simd wish) {
  for (Simd simd : {Simd::kAvx512, Simd::kAvx2, Simd::kSse2}) {
    if (static_cast<int>(simd) <= static_cast<int>(wish) && sim::KernelOf(simd)) return simd;
  }
  return Simd::kScalar;
}

/// Names of the instruction sets; some have the same number of lanes.
constexpr std::pair<std::string_view, Simd> kSimdNames[] = {
    {"scalar", Simd::kScalar},   {"sse2", Simd::kSse2}, {"neon", Simd::kNeon},
    {"simd128", Simd::kSimd128}, {"avx2", Simd::kAvx2}, {"avx512", Simd::kAvx512}};

std::string_view SimdWish() {
  const char* const text = std::getenv("TAUT_SIMD");
  return text == nullptr ? "" : text;
}

WorldBatchOptions Sane(WorldBatchOptions o) {
  o.worlds = std::max(o.worlds, 1);
  o.simd = SimdOf(o);
  return o;
}

/// Returns whether two poses are equal up to rounding.
bool SamePlace(const BodyState& a, const BodyState& b) {
  constexpr double kTurn = 1e-12;
  const Quat &p = a.orientation, &q = b.orientation;
  const double same = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z;
  const Vec3 &x = a.position_m, &y = b.position_m;
  return x.x == y.x && x.y == y.y && x.z == y.z && std::fabs(same) > 1.0 - kTurn;
}

}  // namespace

Simd BestSimd() {
  for (const auto& [name, simd] : kSimdNames) {
    if (SimdWish() == name) return WidestUpTo(simd);
  }
  return WidestUpTo(Simd::kAvx512);
}

Simd SimdOf(const WorldBatchOptions& options) {
  if (options.simd) return WidestUpTo(*options.simd);
  return options.worlds == 1 ? Simd::kScalar : BestSimd();
}

std::vector<InstructionSet> InstructionSets() {
  std::vector<InstructionSet> sets;
  for (const auto& [name, simd] : kSimdNames) {
    const bool built = sim::IsBuilt(name);
    sets.push_back({name, simd, built, built && sim::KernelOf(simd) != nullptr});
  }
  return sets;
}

bool sim::CheckEnvironment(Diagnostics& out) {
  std::string known, here;
  if (SimdWish().empty()) return true;
  for (const InstructionSet& set : InstructionSets()) {
    if (SimdWish() == set.name) return true;
    known += (known.empty() ? "" : ", ") + std::string(set.name);
    if (set.runs_here) here += (here.empty() ? "" : ", ") + std::string(set.name);
  }
  out.Error("simd.unknown", {},
            "the environment variable TAUT_SIMD is \"" + std::string(SimdWish()) + "\"",
            "expected one of: " + known + "; this build of taut on this machine supports: " + here);
  return false;
}

WorldBatch::Impl::Impl(std::shared_ptr<const Model> m, const WorldBatchOptions& o)
    : model(std::static_pointer_cast<const sim::Tables>(std::move(m))),
      view(model->View()),
      options(Sane(o)),
      kernel(sim::KernelOf(*options.simd)),
      layout(model->MakeLayout()),
      substep_rule(sim::SubstepRuleOf(*model)),
      pool(options.threads) {
  friction = {model->friction_sides.data(), static_cast<int>(model->shapes.size()),
              model->shape_of_point.data(), model->def().friction_combine, options.friction.get()};
  if (model->friction_by_slip || friction.law != nullptr) view.friction = &friction;
  const int n = lanes();
  const auto group_count = static_cast<std::size_t>((options.worlds + n - 1) / n);
  const auto bodies = static_cast<std::size_t>(model->body_count);
  const auto nodes = static_cast<std::size_t>(model->node_count);
  const std::size_t group_rows =
      static_cast<std::size_t>(layout.rows) * static_cast<std::size_t>(n);
  const std::size_t stride = (group_rows + 7) / 8 * 8;
  rows = AllocateAligned<double>(group_count * stride);
  const std::size_t group_kept =
      static_cast<std::size_t>(model->kept_count) * static_cast<std::size_t>(n);
  kept = AllocateAligned<sim::NearParts>(group_count * group_kept);
  slots_used.resize(group_count * bodies);
  forced.resize(group_count * nodes);
  const auto group_near = static_cast<std::size_t>(view.near_capacity);
  near.resize(group_count * group_near);
  status.resize(group_count * static_cast<std::size_t>(n));
  groups.resize(group_count);
  for (std::size_t g = 0; g < group_count; ++g) {
    groups[g].lanes = n;
    groups[g].first_world = static_cast<int>(g) * n;
    groups[g].rows = rows.get() + g * stride;
    groups[g].kept = kept.get() + g * group_kept;
    groups[g].slots_used = slots_used.data() + g * bodies;
    groups[g].near = near.data() + g * group_near;
    groups[g].forced_nodes = forced.data() + g * nodes;
    groups[g].status = status.data() + g * static_cast<std::size_t>(n);
  }
  for (int i = 0; i < pool.threads(); ++i) {
    scratch.push_back(AllocateScratch(*kernel, view));
  }
  // Unused lanes after the last world contain a world, too. Steps then need no special cases for
  // these lanes and find no NaN in them.
  for (int world = 0; world < static_cast<int>(group_count) * n; ++world) StartWorld(world);
}

void WorldBatch::Impl::SetMass(int world, int body, double mass_kg) noexcept {
  const sim::start_of::Masses m = sim::start_of::MassesOf(*model, body, mass_kg);
  at(world, layout.mass + body) = m.mass;
  at(world, layout.inv_mass + body) = m.inv_mass;
  set(world, layout.inertia + 3 * body, m.inertia);
  set(world, layout.inv_inertia + 3 * body, m.inv_inertia);
}

void WorldBatch::Impl::StartWorld(int world) noexcept {
#define TAUT_ROW(name, type, per, role, halted, start)                 \
  for (int i = 0; i < view.Count(sim::Per::per); ++i) {                \
    const sim::start_of::type first = sim::start_of::start(*model, i); \
    set(world, layout.name + sim::kWidth##type * i, first);            \
  }
  TAUT_STATE_ROWS(TAUT_ROW)
#undef TAUT_ROW
  JudgeStiffness(world);
}

void WorldBatch::Impl::JudgeStiffness(int world) noexcept {
  const ModelDef& def = model->def();
  double lighter = 1, k_max = 0;
  for (int b = 0; b < view.body_count; ++b) {
    const BodyDef& body = def.bodies[static_cast<std::size_t>(b)];
    if (!body.fixed) lighter = std::max(lighter, body.mass_kg / at(world, layout.mass + b));
  }
  for (int c = 0; c < view.cable_count; ++c) {
    k_max = std::max(k_max, at(world, layout.stiffness + c));
  }
  // Two bounds of the spectral radius: from the column of the cable, and of the whole matrix.
  for (int c = 0; c < view.cable_count; ++c) {
    const double own = model->coupling[static_cast<std::size_t>(c)];
    const double all = model->largest_coupling;
    at(world, layout.stiff_k + c) =
        lighter * std::min(own * at(world, layout.stiffness + c), all * k_max);
  }
}

void WorldBatch::Impl::Moved(int world) noexcept {
  const int pairs = view.world_pair_count + view.moving_pair_count;
  for (int i = 0; i < pairs; ++i) at(world, layout.clearance + i) = 0.0;
  at(world, layout.near_m) = 0.0;
  for (int i = 0; i < view.touch_count; ++i) at(world, layout.touch_free + i) = 0.0;
  ForgetMeans(world);
}

void WorldBatch::Impl::ForgetMeans(int world) noexcept {
  at(world, layout.mean_step) = 0.0;
  group(world).sensed = false;
}

void WorldBatch::Impl::Sense(int world) const noexcept {
  sim::Group& g = group(world);
  // Several threads may read concurrently: one updates the readings, the others wait. Later calls
  // in the same step take no lock. Compiler builtins replace std::atomic_ref, which the libc++ of
  // emscripten 3.1.6 lacks.
  if (__atomic_load_n(&g.sensed, __ATOMIC_ACQUIRE)) return;
  const std::lock_guard lock(sensing);
  if (__atomic_load_n(&g.sensed, __ATOMIC_RELAXED)) return;
  kernel->sense(view, layout, g, scratch[0].get());
  __atomic_store_n(&g.sensed, true, __ATOMIC_RELEASE);
}

void WorldBatch::Impl::ForceNode(int world, int node) noexcept {
  sim::Group& g = group(world);
  int* const end = g.forced_nodes + g.forced_count;
  int* const place = std::lower_bound(g.forced_nodes, end, node);
  if (place != end && *place == node) return;
  TAUT_ASSERT(g.forced_count < view.node_count);
  std::copy_backward(place, end, end + 1);
  *place = node;
  ++g.forced_count;
}

WorldBatch::WorldBatch(std::shared_ptr<const Model> model, const WorldBatchOptions& options)
    : impl_(std::make_unique<Impl>(std::move(model), options)) {}
WorldBatch::~WorldBatch() = default;
WorldBatch::WorldBatch(WorldBatch&&) noexcept = default;
WorldBatch& WorldBatch::operator=(WorldBatch&&) noexcept = default;

const Model& WorldBatch::model() const noexcept { return *impl_->model; }
int WorldBatch::worlds() const noexcept { return impl_->options.worlds; }
int WorldBatch::lanes() const noexcept { return impl_->lanes(); }

sim::StepSettings WorldBatch::Impl::SettingsOf(double step_s) const noexcept {
  return {options.max_linear_solves, options.tolerance_m_per_s, substep_rule.CountOf(step_s),
          substep_rule.IsEnough(step_s) ? -1 : substep_rule.cable};
}

void WorldBatch::Impl::Step(double step_s, int count, const double* targets_m) noexcept {
  sim::CheckStep("Step", step_s, count);
  const sim::StepSettings settings = SettingsOf(step_s);
  auto work = [&](int thread, std::size_t g) {
    if (targets_m != nullptr) SetTargets(static_cast<int>(g), targets_m);
    kernel->step(view, layout, groups[g], settings, scratch[static_cast<std::size_t>(thread)].get(),
                 step_s, count);
  };
  pool.ForEach(groups.size(), work);
}

void WorldBatch::Impl::SetTargets(int group_number, const double* targets_m) const noexcept {
  const int cables = view.cable_count, first = group_number * lanes();
  const int here = std::min(lanes(), options.worlds - first);
  for (int c = 0; c < cables; ++c) {
    for (int j = 0; j < here; ++j) {
      at(first + j, layout.target + c) =
          targets_m[static_cast<std::ptrdiff_t>(first + j) * cables + c];
    }
  }
}

void WorldBatch::Step(double step_s, int count) noexcept { impl_->Step(step_s, count, nullptr); }

void WorldBatch::Step(double step_s, int count,
                      std::span<const double> rest_length_targets_m) noexcept {
  const auto worlds = static_cast<std::size_t>(impl_->options.worlds);
  sim::CheckCount(__func__, "target for each cable of each world", rest_length_targets_m.size(),
                  worlds * static_cast<std::size_t>(impl_->view.cable_count));
  impl_->Step(step_s, count, rest_length_targets_m.data());
}

double WorldBatch::Time(int world) const noexcept {
  impl_->CheckWorld(__func__, world);
  return impl_->at(world, impl_->layout.time);
}

double WorldBatch::RestLengthTarget(int world, int cable) const noexcept {
  impl_->CheckCable(__func__, world, cable);
  return impl_->at(world, impl_->layout.target + cable);
}
Vec3 WorldBatch::NodeForce(int world, int node) const noexcept {
  impl_->CheckNode(__func__, world, node);
  return impl_->vec(world, impl_->layout.node_force + 3 * node);
}
void WorldBatch::SetNodeForce(int world, int node, const Vec3& force_n) noexcept {
  impl_->CheckNode(__func__, world, node);
  impl_->ForceNode(world, node);
  impl_->set(world, impl_->layout.node_force + 3 * node, force_n);
}

void WorldBatch::SetBodyState(int world, int body, const BodyState& state) noexcept {
  Impl& d = *impl_;
  d.CheckBody(__func__, world, body);
  if (d.view.HasMotion(body)) return;
  const auto first = static_cast<std::size_t>(4 * body);
  const double* q0 = d.model->q_WP0.data() + first;
  const Quat q = state.orientation * Quat{q0[0], q0[1], q0[2], q0[3]};
  if (d.view.touch_count > 0 && !SamePlace(Body(world, body), state)) d.ForgetBends(world);
  d.set(world, d.layout.pos + 3 * body, state.position_m);
  d.set(world, d.layout.vel + 3 * body, state.velocity_m_per_s);
  d.set(world, d.layout.old_vel + 3 * body, state.velocity_m_per_s);
  d.set(world, d.layout.old_spin + 3 * body, state.angular_velocity_rad_per_s);
  d.set(world, d.layout.quat + 4 * body, q);
  // angular momentum in W: R diag(I) R^T w
  const Vec3 w = Rotate(Conjugate(q), state.angular_velocity_rad_per_s);
  const Vec3 inertia = d.vec(world, d.layout.inertia + 3 * body);
  d.set(world, d.layout.mom + 3 * body,
        Rotate(q, {inertia.x * w.x, inertia.y * w.y, inertia.z * w.z}));
  // The next step projects the velocities onto the joints, like the first step.
  if (d.view.joint_count > 0) d.at(world, d.layout.last_step) = 0;
  d.Moved(world);
}

void WorldBatch::SetTime(int world, double time_s) noexcept {
  impl_->CheckWorld(__func__, world);
  impl_->at(world, impl_->layout.time) = time_s;
  impl_->PlaceMotions(world);
}

std::size_t WorldBatch::BytesPerWorld() const noexcept {
  const Impl& d = *impl_;
  return static_cast<std::size_t>(d.layout.rows) * sizeof(double) + sizeof(sim::LaneStatus) +
         static_cast<std::size_t>(d.model->kept_count) * sizeof(sim::NearParts) +
         d.near.size() * sizeof(sim::MovingPair) /
             (d.groups.size() * static_cast<std::size_t>(d.lanes()));
}

}  // namespace taut
