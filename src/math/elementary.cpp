#include "math/elementary.h"

#include <cmath>
#include <limits>

namespace taut::math {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
/// Below this value, two terms of a series are exact beyond double precision.
constexpr double kTiny = 0x1p-30;

/// Double-double number: the unevaluated sum hi + lo, |lo| <= ulp(hi) / 2.
struct Dd {
  double hi = 0.0, lo = 0.0;
};

// pi / 2 and ln 2, each as a sum of three doubles.
constexpr double kHalfPi[3] = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54,
                               -0x1.f1976b7ed8fbcp-110};
constexpr double kLn2[3] = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56, 0x1.7b57a079a1934p-111};
constexpr Dd kHalfPiDd{kHalfPi[0], kHalfPi[1]};
constexpr Dd kPiDd{2.0 * kHalfPi[0], 2.0 * kHalfPi[1]};

// Error-free sums and products are by Knuth and Dekker. The double-double operations are from
// Joldes, Muller and Popescu, "Tight and rigorous error bounds for basic building blocks of
// double-word arithmetic", ACM TOMS 44 (2017), with proven accuracies of a few units of 2^-106.

Dd TwoSum(double a, double b) {
  const double sum = a + b, of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

/// Like TwoSum, for |a| >= |b|.
Dd FastTwoSum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// Splits a number into its upper 26 bits and the rest.
Dd Split(double a) {
  const double c = 134217729.0 * a;  // 2^27 + 1
  const double hi = c - (c - a);
  return {hi, a - hi};
}

Dd TwoProduct(double a, double b) {
  const double product = a * b;
  const Dd x = Split(a), y = Split(b);
  return {product, ((x.hi * y.hi - product) + x.hi * y.lo + x.lo * y.hi) + x.lo * y.lo};
}

Dd operator+(const Dd& a, const Dd& b) {
  const Dd s = TwoSum(a.hi, b.hi), t = TwoSum(a.lo, b.lo);
  const Dd v = FastTwoSum(s.hi, s.lo + t.hi);
  return FastTwoSum(v.hi, t.lo + v.lo);
}

Dd operator-(const Dd& a) { return {-a.hi, -a.lo}; }
Dd operator-(const Dd& a, const Dd& b) { return a + -b; }

Dd operator*(const Dd& a, const Dd& b) {
  const Dd p = TwoProduct(a.hi, b.hi);
  return FastTwoSum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

Dd operator/(const Dd& a, const Dd& b) {
  const double q1 = a.hi / b.hi;
  Dd rest = a - b * Dd{q1};
  const double q2 = rest.hi / b.hi;
  rest = rest - b * Dd{q2};
  return FastTwoSum(q1, q2) + Dd{rest.hi / b.hi};
}

/// Multiplies by a power of two.
Dd Scaled(const Dd& a, double power) { return {a.hi * power, a.lo * power}; }

Dd Sqrt(const Dd& a) {
  if (a.hi <= 0.0) return {};
  const double root = std::sqrt(a.hi);
  const Dd rest = a - TwoProduct(root, root);
  return FastTwoSum(root, rest.hi / (2.0 * root));
}

/// Returns x + x^2/2! + ... for |x| <= 0.0014.
Dd Expm1Series(const Dd& x) {
  Dd term = x, sum = x;
  for (int n = 2; n <= 10; ++n) {
    term = term * x / Dd{static_cast<double>(n)};
    sum = sum + term;
  }
  return sum;
}

/// Returns e^x for |x| <= 800, rounded to a double.
double ExpOf(const Dd& x) {
  // x = k ln 2 + r, |r| <= 0.35; e^r - 1 from r / 256 by doubling eight times.
  const double k = std::floor(x.hi / kLn2[0] + 0.5);
  const Dd r = x - TwoProduct(k, kLn2[0]) - TwoProduct(k, kLn2[1]) - TwoProduct(k, kLn2[2]);
  Dd p = Expm1Series(Scaled(r, 1.0 / 256.0));
  for (int i = 0; i < 8; ++i) p = p * (Dd{2.0} + p);
  return std::ldexp((Dd{1.0} + p).hi, static_cast<int>(k));
}

/// Returns ln x for finite x > 0.
Dd LogOf(double x) {
  // x = 2^e m, 1/sqrt(2) <= m < sqrt(2); ln m = 2 artanh(s), s = (m - 1) / (m + 1), |s| <= 0.172.
  int e = 0;
  double m = std::frexp(x, &e);
  if (m < 0x1.6a09e667f3bcdp-1) {
    m *= 2.0;
    --e;
  }
  const Dd s = TwoSum(m, -1.0) / TwoSum(m, 1.0);
  const Dd s2 = s * s;
  Dd series;
  for (int n = 22; n >= 0; --n) series = series * s2 + Dd{1.0} / Dd{2.0 * n + 1.0};
  const double k = e;
  return Scaled(s * series, 2.0) + TwoProduct(k, kLn2[2]) + TwoProduct(k, kLn2[1]) +
         TwoProduct(k, kLn2[0]);
}

/// Sine and cosine of r, |r| <= 0.79, from their series.
struct SinCos {
  Dd sin, cos;
};
SinCos SinCosSeries(const Dd& r) {
  const Dd minus_r2 = -(r * r);
  SinCos out{r, {1.0, 0.0}};
  Dd odd = r, even{1.0, 0.0};
  for (int n = 2; n <= 30; n += 2) {
    even = even * minus_r2 / Dd{static_cast<double>(n * (n - 1))};
    odd = odd * minus_r2 / Dd{static_cast<double>(n * (n + 1))};
    out.cos = out.cos + even;
    out.sin = out.sin + odd;
  }
  return out;
}

/// Returns sine and cosine of an angle, |angle| <= kMaxAngle.
SinCos SinCosOf(double angle) {
  const double k = std::floor(angle / kHalfPi[0] + 0.5);
  const Dd r =
      Dd{angle} - TwoProduct(k, kHalfPi[0]) - TwoProduct(k, kHalfPi[1]) - TwoProduct(k, kHalfPi[2]);
  const SinCos s = SinCosSeries(r);
  switch (static_cast<long long>(k) & 3) {
    case 0:
      return s;
    case 1:
      return {s.cos, -s.sin};
    case 2:
      return {-s.sin, -s.cos};
    default:
      return {-s.cos, s.sin};
  }
}

/// Returns the angle of the direction (x, y), 0 <= y <= x, x near 1.
Dd AngleBelowDiagonal(const Dd& y, const Dd& x) {
  Dd t = y / x;
  for (int i = 0; i < 3; ++i) t = t / (Dd{1.0} + Sqrt(Dd{1.0} + t * t));  // halves the angle
  const Dd minus_t2 = -(t * t);                                           // |t| <= tan(pi / 32)
  Dd series;
  for (int n = 17; n >= 0; --n) series = series * minus_t2 + Dd{1.0} / Dd{2.0 * n + 1.0};
  return Scaled(t * series, 8.0);
}

/// Returns the angle of the direction (x, y), y >= 0, with the larger of |x| and |y| near 1.
Dd AngleOf(const Dd& y, const Dd& x) {
  const Dd right = x.hi < 0.0 ? -x : x;
  const Dd acute =
      y.hi <= right.hi ? AngleBelowDiagonal(y, right) : kHalfPiDd - AngleBelowDiagonal(right, y);
  return x.hi < 0.0 ? kPiDd - acute : acute;
}

bool IsWhole(double x) { return x == std::floor(x); }
bool IsOdd(double x) { return IsWhole(x) && !IsWhole(0.5 * x); }

}  // namespace

double Sin(double angle_rad) noexcept {
  if (!(std::fabs(angle_rad) <= kMaxAngle)) return kNan;
  if (std::fabs(angle_rad) < kTiny) return angle_rad - angle_rad * angle_rad * angle_rad / 6.0;
  return SinCosOf(angle_rad).sin.hi;
}

double Cos(double angle_rad) noexcept {
  if (!(std::fabs(angle_rad) <= kMaxAngle)) return kNan;
  return SinCosOf(angle_rad).cos.hi;
}

double Tan(double angle_rad) noexcept {
  if (!(std::fabs(angle_rad) <= kMaxAngle)) return kNan;
  if (std::fabs(angle_rad) < kTiny) return angle_rad + angle_rad * angle_rad * angle_rad / 3.0;
  const SinCos s = SinCosOf(angle_rad);
  return (s.sin / s.cos).hi;
}

double Asin(double x) noexcept {
  if (!(std::fabs(x) <= 1.0)) return kNan;
  if (std::fabs(x) < kTiny) return x + x * x * x / 6.0;
  const double a = std::fabs(x);
  return std::copysign(AngleOf(Dd{a}, Sqrt(TwoSum(1.0, -a) * TwoSum(1.0, a))).hi, x);
}

double Acos(double x) noexcept {
  if (!(std::fabs(x) <= 1.0)) return kNan;
  return AngleOf(Sqrt(TwoSum(1.0, -x) * TwoSum(1.0, x)), Dd{x}).hi;
}

double Atan(double x) noexcept {
  if (std::isnan(x)) return kNan;
  if (std::fabs(x) < kTiny) return x - x * x * x / 3.0;
  return Atan2(x, 1.0);
}

double Atan2(double y, double x) noexcept {
  if (std::isnan(x) || std::isnan(y)) return kNan;
  if (std::isinf(x) || std::isinf(y)) {  // finite values count as 0, infinite values as equal
    const double finite = 0.0;
    return Atan2(std::isinf(y) ? std::copysign(1.0, y) : std::copysign(finite, y),
                 std::isinf(x) ? std::copysign(1.0, x) : std::copysign(finite, x));
  }
  if (y == 0.0) return std::signbit(x) ? std::copysign(kPiDd.hi, y) : y;
  if (x == 0.0) return std::copysign(kHalfPiDd.hi, y);
  int of_y = 0, of_x = 0;
  const double my = std::frexp(std::fabs(y), &of_y), mx = std::frexp(x, &of_x);
  const int apart = of_y - of_x;
  if (apart < -60) return x > 0.0 ? y / x : std::copysign(kPiDd.hi, y);
  if (apart > 60) return std::copysign(kHalfPiDd.hi, y);
  const Dd angle = apart > 0 ? AngleOf(Dd{my}, Dd{std::ldexp(mx, -apart)})
                             : AngleOf(Dd{std::ldexp(my, apart)}, Dd{mx});
  return std::copysign(angle.hi, y);
}

double Exp(double x) noexcept {
  if (std::isnan(x)) return kNan;
  if (x > 710.0) return kInf;
  if (x < -746.0) return 0.0;
  return ExpOf(Dd{x});
}

double Log(double x) noexcept {
  if (std::isnan(x) || x < 0.0) return kNan;
  if (x == 0.0) return -kInf;
  return std::isinf(x) ? x : LogOf(x).hi;
}

double Pow(double base, double exponent) noexcept {
  if (exponent == 0.0 || base == 1.0) return 1.0;
  if (std::isnan(base) || std::isnan(exponent)) return kNan;
  const double sign = std::signbit(base) && IsOdd(exponent) ? -1.0 : 1.0;
  const double size = std::fabs(base);
  if (std::isinf(exponent)) {
    return size == 1.0 ? 1.0 : (size > 1.0) == (exponent > 0.0) ? kInf : 0.0;
  }
  if (size == 0.0 || std::isinf(size)) {
    return sign * ((size == 0.0) == (exponent > 0.0) ? 0.0 : kInf);
  }
  if (base < 0.0 && !IsWhole(exponent)) return kNan;
  const Dd log = LogOf(size);
  const double estimate = log.hi * exponent;
  if (estimate > 710.0) return sign * kInf;
  if (estimate < -746.0) return sign * 0.0;
  return sign * ExpOf(log * Dd{exponent});
}

}  // namespace taut::math
