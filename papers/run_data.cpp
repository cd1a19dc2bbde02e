#include "papers/run_data.hpp"

#include <algorithm>

#include "fmbpc/base/input_error.hpp"

namespace fpc::papers {
namespace {

Eigen::Index indexOf(const std::vector<SignalInfo>& known, const std::string& name,
                     const std::string& loop) {
  const auto at = std::find_if(known.begin(), known.end(),
                               [&](const SignalInfo& signal) { return signal.name == name; });
  require(at != known.end(), loop, "a signal " + name);
  return at - known.begin();
}

}  // namespace

DataSet dataOf(const RunRecord& run, const Structure& structure) {
  const auto& samples = run.samples;
  const auto rows = static_cast<Eigen::Index>(samples.size()) - 1;
  Matrix values(rows, 0);
  const auto take = [&](const std::vector<StructureSignal>& signals,
                        const std::vector<SignalInfo>& known, auto&& value) {
    for (const auto& signal : signals) {
      const Eigen::Index i = indexOf(known, signal.info.name, run.loop);
      values.conservativeResize(rows, values.cols() + 1);
      for (Eigen::Index k = 0; k < rows; ++k)
        values(k, values.cols() - 1) = value(static_cast<std::size_t>(k))[i];
    }
  };
  take(structure.outputs, run.info.outputs,
       [&](std::size_t k) { return samples[k].measurement.outputs; });
  take(structure.inputs, run.info.inputs,
       [&](std::size_t k) { return samples[k + 1].measurement.input_applied; });
  take(structure.disturbances, run.info.disturbances,
       [&](std::size_t k) { return samples[k].measurement.disturbances; });
  return makeDataSet(values, structure, run.loop);
}

}  // namespace fpc::papers
