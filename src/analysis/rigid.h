/// Motions of a structure as a whole.
#pragma once

#include "analysis/structure.h"

namespace taut::analysis {

/// Three translations, and three turns about the middle of all centres, as described: 6 columns.
Eigen::MatrixXd RigidMotions(const Structure& structure);

/// An orthonormal basis of what `rows` make nothing of: singular values up to `limit`.
Eigen::MatrixXd Nothing(const Eigen::MatrixXd& rows, double limit);

}  // namespace taut::analysis
