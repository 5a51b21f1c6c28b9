/// Metric of motions by the squared displacements of a structure's points (docs/theory/statics.md,
/// section 2).
#pragma once

#include "analysis/structure.h"

namespace taut::analysis {

/// Assembles the sum of squared displacements of all points at which members, joints or loads act,
/// as a quadratic form of motions. If a motion of a body moves none of its points, the body's
/// translations are added. If the form is still singular, the body's remaining rotations times its
/// reach are added. So the metric is positive definite on `Structure::Effective`.
Eigen::MatrixXd PointMetric(const ModelDef& def, const Structure& structure);

/// Returns the generalized eigenvalues of `stiffness` and `metric` in the span of `motions`, in
/// ascending order. Returns nothing if the metric is not positive definite there.
Eigen::VectorXd EigenvaluesOver(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& metric,
                                const Eigen::MatrixXd& motions);

}  // namespace taut::analysis
