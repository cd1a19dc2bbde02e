#include "model/linear_model.hpp"

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Polynomial = std::vector<double>;  // in 1/z

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

double pointOf(const LinearPoint& point, const SampledLinearElement& e) {
  return e.kind == SignalKind::kInput ? point.inputs[e.index] : point.disturbances[e.index];
}

OutputModel submodelOf(int output, const std::vector<SampledLinearElement>& elements,
                       const LinearPoint& point) {
  Polynomial shared{1.0};
  for (const auto& e : elements)
    if (e.element.shared.size() > 1) shared = e.element.shared;
  Polynomial denominator = shared;
  for (const auto& e : elements)
    if (e.poles_of < 0) denominator = product(denominator, e.element.own);
  Submodel result;
  for (std::size_t i = 1; i < denominator.size(); ++i)
    result.add(SignalKind::kOutput, output, static_cast<int>(i) - 1, -denominator[i]);
  double offset = sum(denominator) * point.outputs[output];
  for (std::size_t j = 0; j < elements.size(); ++j) {
    const SampledElement& own = elements[j].element;
    Polynomial numerator = own.b;
    if (own.shared.size() < shared.size()) numerator = product(numerator, shared);
    const int poles = elements[j].poles_of;
    const std::size_t with = poles < 0 ? j : static_cast<std::size_t>(poles);
    for (std::size_t i = 0; i < elements.size(); ++i)
      if (i != with && elements[i].poles_of < 0)
        numerator = product(numerator, elements[i].element.own);
    for (std::size_t i = 0; i < numerator.size(); ++i)
      result.add(elements[j].kind, elements[j].index, own.delay + static_cast<int>(i),
                 numerator[i]);
    offset -= sum(numerator) * pointOf(point, elements[j]);
  }
  return result.finish(offset);
}

SampledElement sampledLag(const Fopdt& element, double sample_time_min) {
  const SampledFopdt lag = sampled(element, sample_time_min);
  SampledElement result;
  result.own = {1.0, -lag.a};
  result.b = {element.gain * lag.near};
  if (lag.far != 0.0) result.b.push_back(element.gain * lag.far);
  result.delay = lag.delay;
  return result;
}

}  // namespace

TsModel linearModel(const TsModel& names, const std::vector<SampledLinearElement>& elements,
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
    std::vector<SampledLinearElement> own;
    for (const auto& e : elements) {
      require(e.kind != SignalKind::kOutput && e.output >= 0 && e.output < size(names.outputs) &&
                  e.index >= 0 && e.index < size(names.signals(e.kind)),
              "linear model: element", "indices of the model's signals");
      if (e.output == output) own.push_back(e);
    }
    require(!own.empty(), "linear model: output " + std::to_string(output), "at least one element");
    model.submodels.push_back(submodelOf(output, own, point));
  }
  model.validate();
  return model;
}

TsModel linearModel(const TsModel& names, const std::vector<LinearElement>& elements,
                    const LinearPoint& point) {
  std::vector<SampledLinearElement> all;
  for (const auto& e : elements) {
    e.element.validate("linear model: ");
    all.push_back({e.output, e.kind, e.index, sampledLag(e.element, names.sample_time_s / 60.0)});
  }
  return linearModel(names, all, point);
}

}  // namespace fpc
