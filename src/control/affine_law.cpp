#include "control/affine_law.hpp"

#include <cmath>
#include <utility>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

void validate(const AffineTerm& term, const std::string& key, Eigen::Index targets) {
  require(term.target >= 0 && term.target < targets, key + "target", "one of the targets");
  require(!term.disturbances.empty(), key + "of", "at least one signal");
  require(std::isfinite(term.about) && term.about != 0.0, key + "about", "a number other than 0");
  require(std::isfinite(term.gain), key + "gain", "a finite number");
}

double product(const AffineTerm& term, VectorRef disturbances) {
  double value = 1.0;
  for (const Eigen::Index i : term.disturbances) value *= disturbances[i];
  return value;
}

}  // namespace

AffineLaw::AffineLaw(std::vector<AffineTerm> terms, Eigen::Index targets)
    : terms_(std::move(terms)), value_(terms_.size(), 0.0), sum_(Vector::Zero(targets)) {
  for (std::size_t i = 0; i < terms_.size(); ++i)
    validate(terms_[i], "term[" + std::to_string(i) + "].", targets);
}

const Vector& AffineLaw::follow(VectorRef disturbances) {
  sum_.setZero();
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const AffineTerm& term = terms_[i];
    const double aim = term.gain * (product(term, disturbances) / term.about - 1.0);
    if (std::isfinite(aim)) value_[i] = aim;
    sum_[term.target] += value_[i];
  }
  return sum_;
}

}  // namespace fpc
