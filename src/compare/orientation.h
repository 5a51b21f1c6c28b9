/// Signs of unit quaternions: q and -q are the same orientation.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "taut/trace.h"

namespace taut::compare {

/// Channels of one quaternion in the order w, x, y, z.
using QuaternionChannels = std::array<std::size_t, 4>;

/// Returns the quaternions of a trace: four channels whose names differ in their last letter only,
/// `orientation_w`, ... with any beginning; other names only if the length is 1 in every row.
std::vector<QuaternionChannels> FindQuaternions(const Trace& trace);

/// Returns all names of the quaternion of `orientation_x` and the like, w first; empty for other
/// channels.
std::vector<std::string> QuaternionNames(const std::string& channel);

/// Returns -1 if `q` with changed signs is closer to `to`, else 1. For numbers that are not finite:
/// 1.
double NearerSign(const std::array<double, 4>& q, const std::array<double, 4>& to);

using QuaternionRows = std::array<std::vector<double>, 4>;

/// Chooses the sign of every row to be nearer to the last complete row. Signs change for the four
/// components together.
void MakeContinuous(QuaternionRows& rows);
/// Chooses the sign of every row so that it is nearer to the same row of `to`.
void AlignTo(const QuaternionRows& to, QuaternionRows& rows);

/// Makes all quaternions of a trace continuous.
void MakeOrientationsContinuous(Trace& trace);

}  // namespace taut::compare
