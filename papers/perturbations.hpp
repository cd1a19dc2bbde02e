// Wrong plants and laws, to see which verdicts of the papers' rows notice.
#pragma once

#include <string>
#include <vector>

namespace fpc::papers {

std::vector<std::string> perturbationNames();  ///< of papers/perturbations.yaml
/// From now on every loop is changed. @throws InputError for a name that is unknown
void perturb(const std::string& name);

}  // namespace fpc::papers
