#include "linear/step_dual.h"

#include "simd/dual.h"
// Source code of the step; include it after simd/dual.h.
#include "sim/step/kernel.inl"

namespace taut::linear {

const sim::Kernel kKernelDual = {2, sim::ScratchBytes<simd::Dual>, sim::LayOutScratch<simd::Dual>,
                                 sim::StepGroup<simd::Dual, sim::NoWatch>,
                                 sim::SenseGroup<simd::Dual>};

const double kStiffFrom = sim::kSoftSpring;

}  // namespace taut::linear
