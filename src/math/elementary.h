/// Elementary functions with the same bits on every machine and with every C library.
///
/// The functions compute in double-double arithmetic (two doubles, about 2^-100 relative) from +,
/// -, *, / and sqrt, which IEEE 754 defines exactly. Then they round to a double. The error is at
/// most 0.5001 units in the last place, and at most one unit for subnormal results. The compiler
/// must not contract or reorder operations (-ffp-contract=off, no -ffast-math). The functions are
/// about 100 times slower than a C library. Use them for reading files and start-up, not in steps.
///
/// Special cases as in C: NaN for NaN and for domain errors; infinity on overflow.
#pragma once

namespace taut::math {

/// Largest angle [rad] for Sin, Cos and Tan. Beyond this angle, they return NaN, because the
/// argument reduction has only 160 bits of pi.
inline constexpr double kMaxAngle = 1e9;

double Sin(double angle_rad) noexcept;
double Cos(double angle_rad) noexcept;
double Tan(double angle_rad) noexcept;
double Asin(double x) noexcept;
double Acos(double x) noexcept;
double Atan(double x) noexcept;
double Atan2(double y, double x) noexcept;
double Exp(double x) noexcept;
double Log(double x) noexcept;
double Pow(double base, double exponent) noexcept;

}  // namespace taut::math
