// A fitted recursion of the output's past as a submodel in the signals' own units.
#include <cmath>

#include "identification/auto_candidate.hpp"

namespace fpc {

using Eigen::Index;

OutputModel toSubmodel(const AutoData& data, const Fitted& fitted) {
  const RecurrentShape& shape = fitted.shape;
  OutputModel model;
  std::vector<Regressor> phi;
  for (Index i = 0; i < shape.states; ++i)
    phi.push_back({SignalKind::kOutput, data.output, static_cast<int>(i)});
  phi.insert(phi.end(), fitted.exogenous.begin(), fitted.exogenous.end());
  const auto columnOf = [&](const Regressor& r) { return data.data->column(r.kind, r.index); };
  for (const Index i : shape.regressors)
    model.regressors.push_back(phi[static_cast<std::size_t>(i)]);
  if (shape.rules > 1)
    for (const Index i : shape.antecedents)
      model.antecedents.push_back(phi[static_cast<std::size_t>(i)]);
  const double y_scale = data.scale[data.output];
  for (Index r = 0; r < shape.rules; ++r) {
    Rule rule;
    const Index at = shape.at(r, 0), p = shape.terms() - 1;
    rule.coefficients.resize(p);
    rule.offset = data.shift[data.output] + y_scale * fitted.parameters[at + p];
    for (Index j = 0; j < p; ++j) {
      const Index column = columnOf(model.regressors[static_cast<std::size_t>(j)]);
      rule.coefficients[j] = fitted.parameters[at + j] * y_scale / data.scale[column];
      rule.offset -= rule.coefficients[j] * data.shift[column];
    }
    for (std::size_t j = 0; j < model.antecedents.size(); ++j) {
      const Index column = columnOf(model.antecedents[j]), z = static_cast<Index>(j);
      const double centre = fitted.parameters[shape.centre(r) + z];
      const double width = std::exp(fitted.parameters[shape.logWidth(r) + z]);
      rule.antecedents.push_back(
          {MembershipShape::kGaussian,
           {data.shift[column] + data.scale[column] * centre, data.scale[column] * width}});
    }
    model.rules.push_back(std::move(rule));
  }
  countRows(*data.data, data.output, model);
  return model;
}

void countRows(const DataSet& data, int output, OutputModel& model) {
  const Regression rows = makeRegression(data, model.regressors, model.antecedents, output);
  for (auto& rule : model.rules) rule.data_count = 0;
  FiringResult firing;
  for (Index k = 0; k < rows.rows(); ++k) {
    Index most = 0;
    if (model.rules.size() > 1) {
      firingWeights(model, rows.antecedents.row(k).transpose(), firing);
      firing.weights.maxCoeff(&most);
    }
    ++model.rules[static_cast<std::size_t>(most)].data_count;
  }
}

}  // namespace fpc
