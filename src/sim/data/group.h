/// A group of worlds that share a register, and the interface between the code that is compiled
/// once (batch.cpp) and the step that is compiled once an instruction set (step_*.cpp).
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "sim/data/view.h"
#include "sim/geometry/near_parts.h"

namespace taut::sim {

/// What one lane has to say; see WorldStatus.
struct LaneStatus {
  uint32_t bits = 0;
  double first_time_s = 0;
  int body = kWorld, cable = -1, ground = -1;
};

/// The key of a slot or of a memory that holds nothing. Others: see Tables.
inline constexpr double kNoKey = -1.0;
inline constexpr BendNumbers<double> kNoBend{kNoKey, 0, 0, 0, 0, 0, {}, {}};
/// What a contact remembers of having slid (1) or stuck (0) where it did not press.
inline constexpr double kSlipUnknown = -1.0;

/// N worlds. `rows` is laid out by `Layout`: row i of lane j is rows[i * lanes + j].
struct Group {
  int lanes = 1;
  int first_world = 0;
  double* rows = nullptr;
  int* slots_used = nullptr;    ///< Per body: its slots that some lane used in the last step.
  int touches_used = 0;         ///< The longest lane's list of touches of the last step.
  int* forced_nodes = nullptr;  ///< Nodes that ever had a force, rising.
  int forced_count = 0;
  NearParts* kept =
      nullptr;          ///< Of pair `BodyPairTable::kept` those of lane j at [kept * lanes + j].
  bool sensed = false;  ///< The kSensed rows belong to the current state. Const readers share it.
  LaneStatus* status = nullptr;  ///< Per lane.
};

struct StepSettings {
  int max_linear_solves = 1000;  ///< An island, a step.
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

// Those that the build has (cmake/instruction_sets.cmake): TAUT_HAS_AVX2 and the like.
extern const Kernel kKernelScalar;
extern const Kernel kKernelNeon;
extern const Kernel kKernelSimd128;
extern const Kernel kKernelSse2;
extern const Kernel kKernelAvx2;
extern const Kernel kKernelAvx512;

}  // namespace taut::sim
