// Regression rows of one output: lagged signals at k against the output at k + 1.
#include <algorithm>
#include <cmath>

#include "identification/data_set.hpp"

namespace fpc {
namespace {

using Eigen::Index;

struct Source {
  Index column, lag;
};

std::vector<Source> sourcesOf(const DataSet& data, const std::vector<Regressor>& variables) {
  std::vector<Source> sources;
  for (const auto& v : variables) sources.push_back({data.column(v.kind, v.index), v.lag});
  return sources;
}

bool complete(const Matrix& values, const std::vector<Source>& sources, Index k) {
  return std::all_of(sources.begin(), sources.end(),
                     [&](const Source& s) { return std::isfinite(values(k - s.lag, s.column)); });
}

Matrix gather(const Matrix& values, const std::vector<Source>& sources,
              const std::vector<Index>& samples) {
  Matrix gathered(static_cast<Index>(samples.size()), static_cast<Index>(sources.size()));
  for (std::size_t j = 0; j < sources.size(); ++j)
    for (std::size_t i = 0; i < samples.size(); ++i)
      gathered(static_cast<Index>(i), static_cast<Index>(j)) =
          values(samples[i] - sources[j].lag, sources[j].column);
  return gathered;
}

}  // namespace

Regression makeRegression(const DataSet& data, const std::vector<Regressor>& regressors,
                          const std::vector<Regressor>& antecedents, int output) {
  const auto x = sourcesOf(data, regressors), z = sourcesOf(data, antecedents);
  const Index target = data.column(SignalKind::kOutput, output);
  Index longest = 0;
  for (const auto* list : {&x, &z})
    for (const auto& source : *list) longest = std::max(longest, source.lag);
  Regression rows;
  for (Index k = longest; k + 1 < data.rows(); ++k)
    if (std::isfinite(data.values(k + 1, target)) && complete(data.values, x, k) &&
        complete(data.values, z, k))
      rows.sample.push_back(k);
  rows.regressors = gather(data.values, x, rows.sample);
  rows.antecedents = gather(data.values, z, rows.sample);
  rows.target = gather(data.values, {{target, -1}}, rows.sample).col(0);
  return rows;
}

}  // namespace fpc
