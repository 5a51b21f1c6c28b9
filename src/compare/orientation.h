/// Signs of unit quaternions: q and -q represent the same orientation.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "taut/trace.h"

namespace taut::compare {

/// Channels of one quaternion in the order w, x, y, z.
using QuaternionChannels = std::array<std::size_t, 4>;

/// Finds the quaternions of a trace: four channels whose names differ only in the last letter.
/// Names end in `orientation_w`, ...; other names count only if all rows have unit length.
std::vector<QuaternionChannels> FindQuaternions(const Trace& trace);

/// Returns the names of all four channels of the quaternion that contains this channel, w first.
/// Returns an empty list for other channels.
std::vector<std::string> QuaternionNames(const std::string& channel);

/// Returns -1 if -q is nearer to `to` than q, otherwise 1. Returns 1 for values that are not
/// finite.
double NearerSign(const std::array<double, 4>& q, const std::array<double, 4>& to);

using QuaternionRows = std::array<std::vector<double>, 4>;

/// Chooses the sign of each quaternion so that it is nearest to the previous complete row.
void MakeContinuous(QuaternionRows& rows);
/// Chooses the sign of each quaternion so that it is nearest to the same row of `to`.
void AlignTo(const QuaternionRows& to, QuaternionRows& rows);

/// Makes all quaternions of a trace continuous.
void MakeOrientationsContinuous(Trace& trace);

}  // namespace taut::compare
