// Terms of an affine law of what is measured: setpoint.plan, standstill.fallback_plan.
#include <algorithm>

#include "config/read.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {

SetpointPlanTerm readPlanTerm(YamlSection& item, const std::string& key,
                              const std::vector<std::string>& targets,
                              const std::vector<std::string>& outputs,
                              const std::vector<std::string>& disturbances) {
  SetpointPlanTerm term;
  term.output = indexByName(item, key, targets);
  std::vector<std::string> of, known = outputs;
  known.insert(known.end(), disturbances.begin(), disturbances.end());
  item.subset("of", of, known);
  if (of.empty()) item.fail("of", "a list of " + join(known));
  for (const auto& name : of) {
    const Eigen::Index place = std::find(known.begin(), known.end(), name) - known.begin();
    const auto n_y = static_cast<Eigen::Index>(outputs.size());
    if (place < n_y)
      term.outputs.push_back(place);
    else
      term.disturbances.push_back(place - n_y);
  }
  for (const char* number : {"about", "gain"}) need(item, number, "a number");
  item.number("about", term.about, kFinite);
  if (term.about == 0.0) item.fail("about", "a number other than 0");
  item.number("gain", term.gain, kFinite);
  item.number("lag_h", term.lag_h, kFiniteNotNegative);
  item.finish();
  return term;
}

}  // namespace fpc
