/// Squared displacements of a structure's points as a measure of its motions
/// (docs/theory/statics.md, section 2).
#pragma once

#include "analysis/structure.h"

namespace taut::analysis {

/// The sum over all points at which members, joints or loads act of the squared displacement, as a
/// matrix of motions. Where a body's points leave a motion of it unmeasured, its center of mass
/// counts as well; what is unmeasured then, by translation and turn times reach. So it is positive
/// definite in the motions that count (`Structure::Effective`).
Eigen::MatrixXd PointMetric(const ModelDef& def, const Structure& structure);

/// Eigenvalues of `stiffness` over `metric` in the span of `motions`, ascending; none if the metric
/// is not positive there.
Eigen::VectorXd EigenvaluesOver(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& metric,
                                const Eigen::MatrixXd& motions);

}  // namespace taut::analysis
