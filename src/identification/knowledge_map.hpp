// Constraints on consequents in other parameters than the model file's.
#pragma once

#include <functional>

#include "identification/prior_knowledge.hpp"

namespace fpc {

/// [coefficients, offset] of all rules behind each other.
Vector stackedConsequents(const std::vector<Rule>& rules);

/// The rows for n parameters of which the stacked consequents are an affine function.
KnowledgeRows inParameters(KnowledgeRows rows, Eigen::Index n,
                           const std::function<Vector(const Vector&)>& consequents);

}  // namespace fpc
