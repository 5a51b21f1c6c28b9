// Dispatch of the narrow phase to the function for two kinds of shapes, resolved at compile time.
#include "sim/geometry/shape_contacts.h"

namespace taut::sim {
namespace {

/// Calls `use` with both shapes in W, sorted by kind, and whether they were exchanged.
template <class Use>
auto WithPair(const Shape& a, const ShapePose& at_a, const Shape& b, const ShapePose& at_b,
              const Use& use) noexcept {
  return WithShape(a, [&]<class A>(const A& shape_a) noexcept {
    return WithShape(b, [&]<class B>(const B& shape_b) noexcept {
      if constexpr (A::kKind <= B::kKind) {
        return use(Moved(shape_a, at_a), Moved(shape_b, at_b), false);
      } else {
        return use(Moved(shape_b, at_b), Moved(shape_a, at_a), true);
      }
    });
  });
}

}  // namespace

int TouchShapes(const Shape& a, const ShapePose& at_a, const Shape& b, const ShapePose& at_b,
                double margin_m, TouchPoint* out) noexcept {
  return WithPair(a, at_a, b, at_b,
                  [&](const auto& first, const auto& second, bool swapped) noexcept {
                    const int count = Touch(first, second, margin_m, out);
                    if (!swapped) return count;
                    for (int i = 0; i < count; ++i) {
                      for (double& x : out[i].normal) x = -x;
                    }
                    return count;
                  });
}

double DistanceOfShapes(const Shape& a, const ShapePose& at_a, const Shape& b,
                        const ShapePose& at_b, double enough_m) noexcept {
  return WithPair(a, at_a, b, at_b, [&](const auto& first, const auto& second, bool) noexcept {
    return DistanceUpTo(first, second, enough_m);
  });
}

}  // namespace taut::sim
