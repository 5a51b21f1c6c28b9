/// Feed-forward neural network with one hidden layer.
///
/// The exponential uses only + and *, so outputs are bit-identical on a microcontroller, on a PC
/// and in every SIMD lane. Equations: docs/theory/gaits.md.
#pragma once

#include "taut/control/real.h"

namespace taut {
namespace control {

namespace internal {

/// Returns 1 / n!, n >= 0. A template, so that object files for different instruction sets share no
/// function.
template <class Real>
constexpr double ExpTerm(int n) noexcept {
  constexpr double kTerms[] = {1.0,
                               1.0,
                               0.5,
                               0.16666666666666666,
                               0.041666666666666664,
                               0.008333333333333333,
                               0.001388888888888889,
                               1.984126984126984e-04,
                               2.48015873015873e-05,
                               2.7557319223985893e-06,
                               2.755731922398589e-07};
  return kTerms[n];
}

/// Returns exp(-y), 0 <= y <= 40: the Taylor series at y / 256, squared eight times. The relative
/// error is at most 256 rounding errors: 3e-14 in double, 2e-5 in float.
template <class Real>
constexpr Real ExpOfMinus(Real y) noexcept {
  const Real z = Literal<Real>(-0.00390625f) * y;
  Real e = control::FromScalar<Real>(ExpTerm<Real>(10));
  for (int n = 9; n >= 0; --n) e = e * z + control::FromScalar<Real>(ExpTerm<Real>(n));
  for (int squared = 0; squared < 8; ++squared) e = e * e;
  return e;
}

}  // namespace internal

/// Returns 1 / (1 + exp(-x)) without overflow; accuracy 1e-14 in double. NaN stays NaN.
template <class Real>
constexpr Real Sigmoid(Real x) noexcept {
  const Real one = Literal<Real>(1.0f), zero = Literal<Real>(0.0f);
  const Real size = Max(zero - x, x);
  const Real e = internal::ExpOfMinus(Min(Literal<Real>(40.0f), size));
  return Select(x < zero, e, one) / (one + e);
}

/// Numbers of inputs, hidden neurons and outputs.
struct NetworkShape {
  int inputs, hidden, outputs;
};

/// Returns the number of weights. Order of the weights: for each hidden neuron, its input weights
/// and then its bias; after that for each output, its hidden weights and then its bias.
constexpr int WeightCount(const NetworkShape& shape) noexcept {
  return (shape.inputs + 1) * shape.hidden + (shape.hidden + 1) * shape.outputs;
}

/// Evaluates the network (G.19):
///   h_j = sigma(sum_i w_ji x_i + b_j),  y_k = 2 sigma(sum_j u_kj h_j + c_k) - 1   (G.19)
/// `weight(n)` and `input(i)` return a `Real`; `output(k, y)` receives one. `hidden` is scratch
/// memory with one entry per hidden neuron.
template <class Real, class Weight, class Input, class Output>
constexpr void EvaluateNetwork(const NetworkShape& shape, const Weight& weight, const Input& input,
                               Real* hidden, const Output& output) noexcept {
  int n = 0;
  for (int j = 0; j < shape.hidden; ++j) {
    Real sum = Literal<Real>(0.0f);
    for (int i = 0; i < shape.inputs; ++i) sum = sum + weight(n++) * input(i);
    hidden[j] = Sigmoid<Real>(sum + weight(n++));
  }
  for (int k = 0; k < shape.outputs; ++k) {
    Real sum = Literal<Real>(0.0f);
    for (int j = 0; j < shape.hidden; ++j) sum = sum + weight(n++) * hidden[j];
    output(k, Literal<Real>(2.0f) * Sigmoid<Real>(sum + weight(n++)) - Literal<Real>(1.0f));
  }
}

}  // namespace control
}  // namespace taut
