/// Base class of gait players made of oscillators (CPG): kernel memory, and integration between
/// ticks in the lanes that are due. Subclasses compute the feedback (play_cpg.cpp,
/// play_feedback_cpg.cpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/out_of_memory.h"
#include "plant/lane_kernel.h"
#include "plant/other_lanes.h"
#include "plant/player_kinds.h"

namespace taut::plant {

class OscillatorPlayer : public GaitPlayer {
 public:
  void Restart(int lane, const GaitSpec& gait) final {
    SetNumbers(lane, gait);
    Forget(lane);
    Start(Lanes{1} << lane);
  }

  void Retune(int lane, const GaitSpec& gait) final {
    SetNumbers(lane, gait);
    retuned_ = true;
  }

  void Serialize(LaneState& state) override {
    GaitPlayer::Serialize(state);
    state.Row(States(), state_count());
  }

  /// Starts the oscillators at the first tick. Later ticks integrate them with the feedback of the
  /// previous tick.
  void Tick(const GaitTick& tick, const Observation& seen) final {
    if (retuned_) Start(0);
    Lanes first = 0;
    for (int j = 0; j < lanes(); ++j) {
      if (Has(tick.due, j) && tick.number[j] == 0) first |= Lanes{1} << j;
    }
    if (first != 0) {
      Go(first, 0);
      Begin(first, seen);
    }
    if (first != tick.due) Go(tick.due & ~first, steps_a_tick_);
    Hear(tick.due, seen);
  }

 protected:
  OscillatorPlayer(const GaitSetup& setup, double most_step_s)
      : GaitPlayer(setup),
        kernel_(LaneKernelOf(lanes())),
        steps_a_tick_(
            std::max(1, static_cast<int>(std::ceil(setup.period_s / most_step_s - 1e-6)))),
        integrator_step_s_(setup.period_s / steps_a_tick_) {
    for (const CouplingGraph::Coupling& link : setup.resolved.graph.couplings) {
      to_.push_back(static_cast<unsigned short>(link.to));
      from_.push_back(static_cast<unsigned short>(link.from));
    }
  }

  /// Allocates the kernel's memory and sets all lanes to their start. Subclasses call it at the end
  /// of their constructors.
  void Prepare(const GaitSetup& setup, std::size_t bytes) {
    memory_.reset(std::aligned_alloc(64, (bytes + 63) / 64 * 64));
    if (!memory_) base::OutOfMemory();
    kept_.Reserve(2, state_count() * static_cast<std::size_t>(lanes()) + signal_.size());
    for (int j = 0; j < lanes(); ++j) SetNumbers(j, *setup.gaits[static_cast<std::size_t>(j)]);
    StartKernel();
  }

  virtual void SetNumbers(int lane, const GaitSpec& gait) = 0;
  /// Returns the oscillators' state: three rows per oscillator.
  virtual double* States() const = 0;
  /// Passes the parameters of all lanes to the kernel and restarts all oscillators.
  virtual void StartKernel() = 0;
  /// Integrates `steps` steps of length `integrator_step_s` and writes the signals.
  virtual void TickKernel(int steps) = 0;
  /// Clears the feedback of a lane.
  virtual void Forget(int lane) = 0;
  /// Stores reference values at the first tick.
  virtual void Begin(Lanes first, const Observation& seen) { (void)first, (void)seen; }
  /// Computes the feedback to the oscillators, which is used until the next tick.
  virtual void Hear(Lanes due, const Observation& seen) = 0;

  const LaneKernel& kernel() const noexcept { return kernel_; }
  void* memory() const noexcept { return memory_.get(); }
  int count() const noexcept { return static_cast<int>(cables().size()); }
  int couplings() const noexcept { return static_cast<int>(to_.size()); }
  std::size_t state_count() const noexcept { return 3 * cables().size(); }
  const unsigned short* to() const noexcept { return to_.data(); }
  const unsigned short* from() const noexcept { return from_.data(); }
  double integrator_step_s() const noexcept { return integrator_step_s_; }

 private:
  struct Free {
    void operator()(void* p) const noexcept { std::free(p); }
  };

  /// Passes the parameters to the kernel. Oscillators of the lanes `begin` restart; others keep
  /// their state.
  void Start(Lanes begin) {
    retuned_ = false;
    OtherLanes others(begin, lanes(), kept_);
    others.Keep(States(), state_count());
    StartKernel();
    others.PutBack();
  }

  void Go(Lanes due, int steps) {
    OtherLanes others(due, lanes(), kept_);
    others.Keep(States(), state_count());
    others.Keep(signal_.data(), cables().size());
    TickKernel(steps);
    others.PutBack();
  }

  const LaneKernel& kernel_;
  std::vector<unsigned short> to_, from_;
  int steps_a_tick_;
  double integrator_step_s_;
  bool retuned_ = false;  ///< Whether changed parameters must still be passed to the kernel.
  KeptRows kept_;
  std::unique_ptr<void, Free> memory_;
};

}  // namespace taut::plant
