// A known Takagi-Sugeno process for tests of identification: one output, one input, two rules that
// overlap.
#pragma once

#include <cmath>
#include <random>
#include <string>

#include "config/structure_file.hpp"
#include "identification/identify.hpp"

namespace fpc::test {

inline Structure knownStructure(const std::string& rest = "clusters: 3",
                                const std::string& settings = "") {
  return parseStructure(
      "name: known\nsample_time_s: 1\noutputs: {y: {}}\ninputs: {u: {}}\nsubmodels:\n  y:\n"
      "    regressors: [y(k), u(k)]\n    " +
          rest + "\n" + settings,
      "known.yaml");
}

/// y(k+1) = w1 (0.6 y + 0.4 u + 0.1) + w2 (0.85 y + 0.3 u - 0.2), w from Gaussians on u at -1
/// and 1.
inline TsModel knownModel() {
  TsModel model;
  model.sample_time_s = 1.0;
  model.outputs = {{"y", "", -10.0, 10.0}};
  model.inputs = {{"u", "", -10.0, 10.0}};
  OutputModel submodel;
  submodel.antecedents = {{SignalKind::kInput, 0, 0}};
  submodel.regressors = {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 0}};
  submodel.rules = {
      {{{MembershipShape::kGaussian, {-1.0, 0.7}}}, (Vector(2) << 0.6, 0.4).finished(), 0.1, 0},
      {{{MembershipShape::kGaussian, {1.0, 0.7}}}, (Vector(2) << 0.85, 0.3).finished(), -0.2, 0}};
  model.submodels = {submodel};
  return model;
}

/// A record of the known process; white noise of this deviation on y drives it, and is measured.
inline Matrix knownRecord(Eigen::Index rows, std::uint64_t seed, double noise = 0.0) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> level(-2.0, 2.0);
  std::normal_distribution<double> normal;
  const OutputModel submodel = knownModel().submodels.front();
  Matrix values(rows, 2);
  FiringResult firing;
  double y = 0.0;
  for (Eigen::Index k = 0; k < rows; ++k) {
    const double u = k % 5 == 0 || k == 0 ? level(generator) : values(k - 1, 1);
    values.row(k) << y, u;
    firingWeights(submodel, Vector::Constant(1, u), firing);
    const Vector x = values.row(k).transpose();
    double next = noise * normal(generator);
    for (std::size_t r = 0; r < 2; ++r)
      next += firing.weights[static_cast<Eigen::Index>(r)] *
              (submodel.rules[r].coefficients.dot(x) + submodel.rules[r].offset);
    y = next;
  }
  return values;
}

inline const std::string kKnownGrid =
    "antecedents: [u(k)]\n    sets: {u(k): [{gaussian: [-1, 0.7]}, {gaussian: [1, 0.7]}]}";

}  // namespace fpc::test
