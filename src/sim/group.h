/// A group of worlds that share a register, and the interface between the code that is compiled
/// once (batch.cpp) and the step that is compiled once an instruction set (step_*.cpp).
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "sim/tables.h"

namespace taut::sim {

/// What one lane has to say; see WorldStatus.
struct LaneStatus {
  uint32_t bits = 0;
  double first_time_s = 0;
  int body = kWorld, cable = -1;
};

/// What a contact remembers of having slid (1) or stuck (0) where it did not press.
inline constexpr double kSlipUnknown = -1.0;

/// N worlds. `rows` is laid out by `Layout`: row i of lane j is rows[i * lanes + j].
struct Group {
  int lanes = 1;
  double* rows = nullptr;
  uint32_t* contact_ids = nullptr;  ///< Of the last step, rising.
  int contact_count = 0;
  int* forced_nodes = nullptr;  ///< Nodes that ever had a force, rising.
  int forced_count = 0;
  bool sensed = false;  ///< The kSensed rows belong to the current state. Const readers share it.
  LaneStatus* status = nullptr;  ///< Per lane.
};

struct StepSettings {
  int max_sweeps = 1000;
  double tolerance_m_per_s = 1e-10;
};

/// One instruction set's step. Scratch is memory of `scratch_bytes`, aligned to 64.
struct Kernel {
  int lanes;
  size_t (*scratch_bytes)(const View&);
  void (*step)(const View&, const Layout&, Group&, const StepSettings&, void* scratch,
               double step_s, int count);
  void (*sense)(const View&, const Layout&, Group&, void* scratch);
};

extern const Kernel kKernelScalar;
extern const Kernel kKernelSse2;
extern const Kernel kKernelAvx2;
extern const Kernel kKernelAvx512;

}  // namespace taut::sim
