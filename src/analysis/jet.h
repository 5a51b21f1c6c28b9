/// Automatic differentiation (jets): numbers with exact first and second derivatives, for joint
/// coordinates as functions of small motions of two bodies (docs/theory/statics.md, eq. 3).
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "math/vec.h"

namespace taut::analysis {

/// Number with derivatives with respect to twelve motions: six of the first body, six of the second
/// body.
struct Jet {
  static constexpr int kMotions = 12;
  using Gradient = Eigen::Matrix<double, kMotions, 1>;
  using Hessian = Eigen::Matrix<double, kMotions, kMotions>;
  double value = 0;
  Gradient gradient = Gradient::Zero();
  Hessian hessian = Hessian::Zero();

  static Jet Of(double value) {
    Jet jet;
    jet.value = value;
    return jet;
  }
  static Jet Motion(int i) {
    Jet jet;
    jet.gradient[i] = 1;
    return jet;
  }
};

inline Jet operator+(const Jet& a, const Jet& b) {
  return {a.value + b.value, a.gradient + b.gradient, a.hessian + b.hessian};
}
inline Jet operator-(const Jet& a, const Jet& b) {
  return {a.value - b.value, a.gradient - b.gradient, a.hessian - b.hessian};
}
inline Jet operator*(double s, const Jet& a) {
  return {s * a.value, s * a.gradient, s * a.hessian};
}
inline Jet operator*(const Jet& a, const Jet& b) {
  const Jet::Hessian cross = a.gradient * b.gradient.transpose();
  return {a.value * b.value, a.value * b.gradient + b.value * a.gradient,
          a.value * b.hessian + b.value * a.hessian + cross + cross.transpose()};
}
/// Returns f(a). `f`, `first` and `second` are the function and its first two derivatives at a.
inline Jet Apply(const Jet& a, double f, double first, double second) {
  return {f, first * a.gradient,
          first * a.hessian + second * (a.gradient * a.gradient.transpose())};
}
inline Jet Sqrt(const Jet& a) {
  const double root = std::sqrt(a.value);
  return Apply(a, root, 0.5 / root, -0.25 / (root * a.value));
}
/// Returns the angle of the vector (x, y) from the x axis [rad].
inline Jet Atan2(const Jet& y, const Jet& x) {
  const double r2 = x.value * x.value + y.value * y.value;
  const double fx = -y.value / r2, fy = x.value / r2;
  const double fxx = -2 * fx * x.value / r2, fyy = -2 * fy * y.value / r2;
  const double fxy = (y.value * y.value - x.value * x.value) / (r2 * r2);
  const Jet::Hessian cross = x.gradient * y.gradient.transpose();
  return {std::atan2(y.value, x.value), fx * x.gradient + fy * y.gradient,
          fx * x.hessian + fy * y.hessian + fxx * (x.gradient * x.gradient.transpose()) +
              fyy * (y.gradient * y.gradient.transpose()) + fxy * (cross + cross.transpose())};
}

struct JetVec {
  Jet x, y, z;
  static JetVec Of(const Vec3& a) { return {Jet::Of(a.x), Jet::Of(a.y), Jet::Of(a.z)}; }
};
inline JetVec operator+(const JetVec& a, const JetVec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline JetVec operator-(const JetVec& a, const JetVec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline JetVec operator*(double s, const JetVec& a) { return {s * a.x, s * a.y, s * a.z}; }
inline JetVec operator*(const Jet& s, const JetVec& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Jet Dot(const JetVec& a, const JetVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline JetVec Cross(const JetVec& a, const JetVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace taut::analysis
