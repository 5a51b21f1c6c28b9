/// Metric of motions by the squared displacements of a structure's points (docs/theory/statics.md,
/// section 2).
#pragma once

#include "analysis/structure.h"

namespace taut::analysis {

/// Assembles the sum of squared displacements of all points at which members, joints or loads act,
/// as a quadratic form of motions. If its points do not measure a motion of a body, its center of
/// mass counts as well, then translation and rotation times reach. So the metric is positive
/// definite on `Structure::Effective`.
Eigen::MatrixXd PointMetric(const ModelDef& def, const Structure& structure);

/// Returns the generalized eigenvalues of `stiffness` and `metric` in the span of `motions`,
/// ascending; empty if the metric is not positive there.
Eigen::VectorXd EigenvaluesOver(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& metric,
                                const Eigen::MatrixXd& motions);

}  // namespace taut::analysis
