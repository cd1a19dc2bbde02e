#include "model/linear_model.hpp"

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Polynomial = std::vector<double>;  // in 1/z

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial c(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
  return c;
}

double sum(const Polynomial& p) {
  double total = 0.0;
  for (const double value : p) total += value;
  return total;
}

class Submodel {
 public:
  void add(SignalKind kind, int index, int lag, double coefficient) {
    model.regressors.push_back({kind, index, lag});
    coefficients.push_back(coefficient);
  }
  OutputModel finish(double offset) {
    Rule rule;
    rule.coefficients = Eigen::Map<const Vector>(coefficients.data(),
                                                 static_cast<Eigen::Index>(coefficients.size()));
    rule.offset = offset;
    model.rules.push_back(std::move(rule));
    return std::move(model);
  }
  OutputModel model;
  std::vector<double> coefficients;
};

double pointOf(const LinearPoint& point, const LinearElement& e) {
  return e.kind == SignalKind::kInput ? point.inputs[e.index] : point.disturbances[e.index];
}

OutputModel submodelOf(int output, const std::vector<LinearElement>& elements,
                       const LinearPoint& point, double sample_time_min) {
  std::vector<SampledFopdt> lags;
  for (const auto& e : elements) lags.push_back(sampled(e.element, sample_time_min));
  Polynomial denominator{1.0};
  for (const auto& lag : lags) denominator = product(denominator, {1.0, -lag.a});
  Submodel result;
  for (std::size_t i = 1; i < denominator.size(); ++i)
    result.add(SignalKind::kOutput, output, static_cast<int>(i) - 1, -denominator[i]);
  double offset = sum(denominator) * point.outputs[output];
  for (std::size_t j = 0; j < elements.size(); ++j) {
    const double gain = elements[j].element.gain;
    Polynomial numerator{gain * lags[j].near};
    if (lags[j].far != 0.0) numerator.push_back(gain * lags[j].far);
    for (std::size_t i = 0; i < lags.size(); ++i)
      if (i != j) numerator = product(numerator, {1.0, -lags[i].a});
    for (std::size_t i = 0; i < numerator.size(); ++i)
      result.add(elements[j].kind, elements[j].index, lags[j].delay + static_cast<int>(i),
                 numerator[i]);
    offset -= sum(numerator) * pointOf(point, elements[j]);
  }
  return result.finish(offset);
}

}  // namespace

TsModel linearModel(const TsModel& names, const std::vector<LinearElement>& elements,
                    const LinearPoint& point) {
  const auto size = [](const std::vector<SignalInfo>& s) {
    return static_cast<Eigen::Index>(s.size());
  };
  require(point.outputs.size() == size(names.outputs) &&
              point.inputs.size() == size(names.inputs) &&
              point.disturbances.size() == size(names.disturbances),
          "linear model: point", "one value for each signal of the model");
  TsModel model = names;
  model.submodels.clear();
  for (int output = 0; output < size(names.outputs); ++output) {
    std::vector<LinearElement> own;
    for (const auto& e : elements) {
      require(e.kind != SignalKind::kOutput && e.output >= 0 && e.output < size(names.outputs) &&
                  e.index >= 0 && e.index < size(names.signals(e.kind)),
              "linear model: element", "indices of the model's signals");
      e.element.validate("linear model: ");
      if (e.output == output) own.push_back(e);
    }
    require(!own.empty(), "linear model: output " + std::to_string(output), "at least one element");
    model.submodels.push_back(submodelOf(output, own, point, names.sample_time_s / 60.0));
  }
  model.validate();
  return model;
}

}  // namespace fpc
