// Takagi-Sugeno models as messages.
#include <optional>

#include "conversion_parts.hpp"
#include "fmbpc/model/model_match.hpp"

namespace fpc {
namespace {

using conversion::enumeration;
using conversion::list;
using conversion::number;
using conversion::structs;

static_assert(fmbpc::FuzzyRegressor::OUTPUT == number(SignalKind::kOutput));
static_assert(fmbpc::FuzzyRegressor::INPUT == number(SignalKind::kInput));
static_assert(fmbpc::FuzzyRegressor::DISTURBANCE == number(SignalKind::kDisturbance));
static_assert(fmbpc::FuzzySet::EXPONENTIAL == number(MembershipShape::kExponential));
static_assert(fmbpc::FuzzySet::GAUSSIAN == number(MembershipShape::kGaussian));
static_assert(fmbpc::FuzzySet::TRIANGULAR == number(MembershipShape::kTriangular));
static_assert(fmbpc::FuzzySet::TRAPEZOIDAL == number(MembershipShape::kTrapezoidal));

std::vector<fmbpc::FuzzyRegressor> regressorList(const std::vector<Regressor>& regressors) {
  std::vector<fmbpc::FuzzyRegressor> messages;
  messages.reserve(regressors.size());
  for (const Regressor& regressor : regressors) {
    fmbpc::FuzzyRegressor msg;
    msg.kind = number(regressor.kind);
    msg.index = regressor.index;
    msg.lag = regressor.lag;
    messages.push_back(msg);
  }
  return messages;
}

std::vector<Regressor> regressorStructs(const std::vector<fmbpc::FuzzyRegressor>& messages) {
  std::vector<Regressor> regressors;
  regressors.reserve(messages.size());
  for (const auto& msg : messages)
    regressors.push_back(
        {enumeration(msg.kind, SignalKind::kOutput, SignalKind::kDisturbance, "kind"), msg.index,
         msg.lag});
  return regressors;
}

void fillMultivariate(const MultivariateMembership& set, fmbpc::FuzzyRule& msg) {
  const Matrix& S = set.inverse_covariance;
  msg.center = conversion::numbers(set.center);
  for (Eigen::Index i = 0; i < S.rows(); ++i)
    for (Eigen::Index j = 0; j < S.cols(); ++j) msg.inverse_covariance.push_back(S(i, j));
}

std::optional<MultivariateMembership> multivariateStruct(const fmbpc::FuzzyRule& msg) {
  if (msg.center.empty() && msg.inverse_covariance.empty()) return {};
  const std::size_t n = msg.center.size();
  require(msg.inverse_covariance.size() == n * n, "inverse_covariance",
          std::to_string(n * n) + " numbers for a center of " + std::to_string(n));
  MultivariateMembership set;
  set.center = conversion::vector(msg.center);
  const auto size = static_cast<Eigen::Index>(n);
  set.inverse_covariance.resize(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < size; ++j)
      set.inverse_covariance(i, j) = msg.inverse_covariance[static_cast<std::size_t>(i * size + j)];
  return set;
}

fmbpc::FuzzyRule ruleMsg(const Rule& rule) {
  fmbpc::FuzzyRule msg;
  for (const Membership& membership : rule.antecedents) {
    fmbpc::FuzzySet set;
    set.shape = number(membership.shape);
    set.parameters = membership.parameters;
    msg.antecedents.push_back(set);
  }
  if (rule.multivariate) fillMultivariate(*rule.multivariate, msg);
  msg.coefficients = conversion::numbers(rule.coefficients);
  msg.offset = rule.offset;
  msg.data_count = rule.data_count;
  return msg;
}

Rule ruleStruct(const fmbpc::FuzzyRule& msg) {
  Rule rule;
  for (const auto& set : msg.antecedents)
    rule.antecedents.push_back({enumeration(set.shape, MembershipShape::kExponential,
                                            MembershipShape::kTrapezoidal, "shape"),
                                set.parameters});
  rule.multivariate = multivariateStruct(msg);
  rule.coefficients = conversion::vector(msg.coefficients);
  rule.offset = msg.offset;
  rule.data_count = msg.data_count;
  return rule;
}

fmbpc::FuzzySubmodel submodelMsg(const OutputModel& submodel) {
  fmbpc::FuzzySubmodel msg;
  msg.antecedents = regressorList(submodel.antecedents);
  msg.regressors = regressorList(submodel.regressors);
  for (const Rule& rule : submodel.rules) msg.rules.push_back(ruleMsg(rule));
  return msg;
}

OutputModel submodelStruct(const fmbpc::FuzzySubmodel& msg) {
  OutputModel submodel;
  submodel.antecedents = regressorStructs(msg.antecedents);
  submodel.regressors = regressorStructs(msg.regressors);
  for (const auto& rule : msg.rules) submodel.rules.push_back(ruleStruct(rule));
  return submodel;
}

void fillDomain(const ModelDomain& domain, fmbpc::FuzzyModel& msg) {
  if (domain.empty()) return;
  msg.domain_scale = conversion::numbers(domain.scale);
  msg.domain_radius = domain.radius;
  msg.domain_centres.assign(domain.centres.data(), domain.centres.data() + domain.centres.size());
}

ModelDomain domainStruct(const fmbpc::FuzzyModel& msg) {
  ModelDomain domain;
  if (msg.domain_centres.empty()) return domain;
  const std::size_t n = msg.domain_scale.size();
  require(n > 0 && msg.domain_centres.size() % n == 0, "domain_centres",
          "points of as many numbers as domain_scale");
  domain.scale = conversion::vector(msg.domain_scale);
  domain.radius = msg.domain_radius;
  domain.centres =
      Eigen::Map<const Matrix>(msg.domain_centres.data(), static_cast<Eigen::Index>(n),
                               static_cast<Eigen::Index>(msg.domain_centres.size() / n));
  return domain;
}

}  // namespace

fmbpc::FuzzyModel toMsg(const TsModel& matched) {
  const TsModel model = asIdentified(matched);
  fmbpc::FuzzyModel msg;
  msg.name = model.name;
  msg.source = model.source;
  msg.sample_time_s = model.sample_time_s;
  msg.outputs = list<fmbpc::SignalInfo>(model.outputs);
  msg.inputs = list<fmbpc::SignalInfo>(model.inputs);
  msg.disturbances = list<fmbpc::SignalInfo>(model.disturbances);
  for (const OutputModel& submodel : model.submodels)
    msg.submodels.push_back(submodelMsg(submodel));
  fillDomain(model.domain, msg);
  return msg;
}

StepHeader headerOf(const fmbpc::FuzzyModel& msg) { return conversion::stepHeader(msg); }

fmbpc::FuzzyModel toMsg(const TsModel& model, const StepHeader& made_from) {
  fmbpc::FuzzyModel msg = toMsg(model);
  msg.header.stamp = toStamp(made_from.time_ns);
  msg.run_id = made_from.run_id;
  msg.step = made_from.step;
  return msg;
}

fmbpc::Identified toMsg(const IdentifierWord& word) {
  fmbpc::Identified msg;
  msg.header.stamp = toStamp(word.header.time_ns);
  msg.run_id = word.header.run_id;
  msg.step = word.header.step;
  msg.model = word.model;
  msg.events = toMsg(word.events);
  return msg;
}

IdentifierWord fromMsg(const fmbpc::Identified& msg) {
  return {conversion::stepHeader(msg), msg.model != 0, fromMsg(msg.events)};
}

TsModel fromMsg(const fmbpc::FuzzyModel& msg) {
  TsModel model;
  model.name = msg.name;
  model.source = msg.source;
  model.sample_time_s = msg.sample_time_s;
  model.outputs = structs<SignalInfo>(msg.outputs);
  model.inputs = structs<SignalInfo>(msg.inputs);
  model.disturbances = structs<SignalInfo>(msg.disturbances);
  for (const auto& submodel : msg.submodels) model.submodels.push_back(submodelStruct(submodel));
  model.domain = domainStruct(msg);
  model.validate();
  return model;
}

}  // namespace fpc
