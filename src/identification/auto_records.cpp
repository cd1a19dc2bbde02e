// Long records thinned, several records joined: rows of nothing keep their pasts apart.
#include <algorithm>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "identification/auto_identify.hpp"

namespace fpc {

using Eigen::Index;

DataSet subsample(const DataSet& data, Index rows, int windows) {
  constexpr Index kGap = 40;
  const Index each = std::max<Index>(1, rows / windows);
  DataSet part = data;
  part.values = Matrix::Constant((each + kGap) * windows, data.values.cols(),
                                 std::numeric_limits<double>::quiet_NaN());
  for (Index w = 0; w < windows; ++w) {
    const Index first = (data.rows() - each) * w / std::max(1, windows - 1);
    part.values.middleRows(w * (each + kGap), each) = data.values.middleRows(first, each);
  }
  return part;
}

DataSet joinRecords(const std::vector<DataSet>& records) {
  constexpr Index kGap = 40;
  require(!records.empty(), "records", "at least one");
  DataSet all = records.front();
  for (std::size_t i = 1; i < records.size(); ++i) {
    const DataSet& next = records[i];
    require(next.values.cols() == all.values.cols() && next.sample_time_s == all.sample_time_s,
            next.source, "the signals and sample time of the first record");
    Matrix values = Matrix::Constant(all.rows() + kGap + next.rows(), all.values.cols(),
                                     std::numeric_limits<double>::quiet_NaN());
    values.topRows(all.rows()) = all.values;
    values.bottomRows(next.rows()) = next.values;
    all.values = values;
    all.source += " and " + next.source;
    all.repairs.insert(all.repairs.end(), next.repairs.begin(), next.repairs.end());
    const auto widen = [](std::vector<SignalInfo>& a, const std::vector<SignalInfo>& b) {
      for (std::size_t j = 0; j < a.size(); ++j) {
        a[j].lower = std::min(a[j].lower, b[j].lower);
        a[j].upper = std::max(a[j].upper, b[j].upper);
      }
    };
    widen(all.outputs, next.outputs);
    widen(all.inputs, next.inputs);
    widen(all.disturbances, next.disturbances);
    for (std::size_t j = 0; j < all.constant.size(); ++j)
      all.constant[j] = all.constant[j] && next.constant[j];
  }
  return all;
}

}  // namespace fpc
