/// Group of worlds that share a SIMD register, and the interface between the code that is compiled
/// once (batch.cpp) and the step that is compiled once per instruction set (step_*.cpp).
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "sim/data/view.h"
#include "sim/geometry/contact_cache.h"

namespace taut::sim {

/// Status of one lane; see WorldStatus.
struct LaneStatus {
  uint32_t bits = 0;
  double first_time_s = 0;
  int body = kWorld, cable = -1, ground = -1;
};

/// Key of an empty slot or memory. Other keys: see Tables.
inline constexpr double kNoKey = -1.0;
inline constexpr WrapPointNumbers<double> kNoWrapPoint{kNoKey, 0, 0, 0, 0, 0, {}, {}};
/// Slip state (1: slid, 0: stuck) of a contact without force.
inline constexpr double kSlipUnknown = -1.0;

/// Worlds of a group. `Layout` defines `rows`: row i of lane j is rows[i * lanes + j].
struct Group {
  int lanes = 1;
  int first_world = 0;
  double* rows = nullptr;
  int* slots_used = nullptr;  ///< Per body: number of slots used in any lane in the last step.
  int touches_used = 0;       ///< Largest number of contacts of moving bodies in a lane, last step.
  int* forced_nodes = nullptr;  ///< Nodes that ever had an external force, ascending.
  int forced_count = 0;
  /// Caches of near parts: for pair `WorldPairTable::kept` in lane j at [kept * lanes + j].
  NearParts* kept = nullptr;
  MovingPair* near = nullptr;    ///< Bodies near each other in some lane, ascending.
  int near_count = 0;            ///< Number of pairs in `near`; -1: more than View::near_capacity.
  bool sensed = false;           ///< The kSensed rows are up to date. Shared by const readers.
  LaneStatus* status = nullptr;  ///< Status per lane.
};

struct StepSettings {
  int max_linear_solves = 1000;  ///< Maximum per island and step.
  double tolerance_m_per_s = 1e-10;
  int substeps = 1;       ///< Number of equal substeps of a step.
  int coarse_cable = -1;  ///< Cable for which even the substeps are too long (kStatusStepTooLong).
};

/// Step functions of one instruction set. `scratch`: memory of `scratch_bytes` bytes, aligned to
/// 64, which `lay_out` has divided for the model.
struct Kernel {
  int lanes;
  size_t (*scratch_bytes)(const View&);
  void (*lay_out)(const View&, void* scratch);
  void (*step)(const View&, const Layout&, Group&, const StepSettings&, void* scratch,
               double step_s, int count);
  void (*sense)(const View&, const Layout&, Group&, void* scratch);
};

// Kernels in this build (cmake/instruction_sets.cmake): TAUT_HAS_AVX2 etc.
extern const Kernel kKernelScalar;
extern const Kernel kKernelNeon;
extern const Kernel kKernelSimd128;
extern const Kernel kKernelSse2;
extern const Kernel kKernelAvx2;
extern const Kernel kKernelAvx512;

}  // namespace taut::sim
