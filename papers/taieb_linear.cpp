// The linear example (taieb2017, eqs. 4-6): how table 1's four columns come
// out with both inputs solved together, and why eq. 6 as printed cannot have given them.
#include <Eigen/Eigenvalues>
#include <cmath>

#include "control/fuzzy_lq/quadratic_law.hpp"
#include "papers/experiment.hpp"
#include "papers/runs.hpp"
#include "papers/taieb_steps.hpp"

namespace fpc::tool {
namespace {

struct Column {
  const char* name;
  double output[2], input[2];                            // Gamma_y, Gamma_u
  double offset[2], overshoot[2], settling[2], rise[2];  // as printed
};
constexpr Column kColumns[] = {
    {"1,1;1,1", {1, 1}, {1, 1}, {0, 0}, {40.41, 57.3988}, {12, 11}, {4.869, 7}},
    {"1,1;0.2,0.2", {1, 1}, {0.2, 0.2}, {0.003, 0.001}, {32.09, 36.36}, {10.5, 13}, {5.4701, 6.5}},
    {"1,0.1;1,0.1", {1, 0.1}, {1, 0.1}, {0.015, 0.02}, {9.33, 25.33}, {8, 16}, {4.6, 20}},
    {"0.3,0.3;1,0.1", {0.3, 0.3}, {1, 0.1}, {0, 0}, {26.33, 53.2}, {12, 17}, {5.5637, 21}}};

Vector two(const double values[2]) { return Eigen::Vector2d(values[0], values[1]); }

/// Eq. 4 with states x11, x12, x21, x22.
AffineModel example() {
  AffineModel m;
  m.A = Eigen::Vector4d(0.9401, 0.9524, 0.9083, 0.9306).asDiagonal();
  m.B = (Matrix(4, 2) << 1, 0, 0, 1, 1, 0, 0, 1).finished();
  m.C = (Matrix(2, 4) << -0.7664, 0.9, 0, 0, 0, 0, -0.6055, 1.3472).finished();
  m.g = Vector::Zero(4);
  return m;
}

QuadraticLaw lawOf(const Column& column, bool together) {
  const QuadraticWeights weights{two(column.output), Vector::Zero(2), two(column.input)};
  return makeQuadraticLaw(example(), {1, 1, together}, weights);
}

/// Of the closed loop with the state (x, u(k-1)).
double radius(const Column& column, bool together) {
  const AffineModel m = example();
  const QuadraticLaw law = lawOf(column, together);
  Matrix loop(6, 6);
  loop << m.A - m.B * law.K, m.B * law.previous, -law.K, law.previous;
  return loop.eigenvalues().cwiseAbs().maxCoeff();
}

Overrides weightsOf(const Column& column) {
  const auto pair = [](const char* a, const char* b, const double v[2]) {
    return std::string("{") + a + ": " + std::to_string(v[0]) + ", " + b + ": " +
           std::to_string(v[1]) + "}";
  };
  return {{"controller.weight_output", pair("y1", "y2", column.output)},
          {"controller.weight_input", pair("u1", "u2", column.input)}};
}

constexpr char kBehind[] = "linear_2x2, both inputs solved together";

Rows table1() {
  Rows rows;
  for (const Column& column : kColumns) {
    const double together = radius(column, true), each = radius(column, false);
    const std::string weights = std::string("weights ") + column.name;
    rows.push_back(check(weights + ", spectral radius, eq. 6 as printed", each, Direction::kLower,
                         1.0 - 1e-9, "-",
                         "the table shows step responses: each input by itself must be stable"));
    rows.push_back(check(weights + ", spectral radius, solved together", together,
                         Direction::kLower, 1.0 - 1e-9, "-", "ours"));
    const char* note = each > 1.0 ? "solved together, as eq. 6 diverges" : "solved together";
    for (Eigen::Index i = 0; i < 2; ++i) {
      const StepIndices step = meanOf(stepsOf("linear_2x2", i, 1.0, weightsOf(column)));
      const std::string of = weights + ", y" + std::to_string(i + 1) + ", ";
      rows.push_back(figure(of + "Ov", column.overshoot[i], step.overshoot, "%", {}, note));
      rows.push_back(figure(of + "Ts", column.settling[i], step.settling, "samples", {}, note));
      rows.push_back(figure(of + "Tr", column.rise[i], step.rise, "samples", {}, note));
      rows.push_back(figure(of + "Es", column.offset[i], 0.01 * step.offset, "-",
                            {0.1, Direction::kEqual, 0.5e-3}, "share of the step"));
    }
  }
  return rows;
}

/// The inputs under which the run without an offset comes to rest at the setpoints (6.1, 12.8),
/// and what the pull to (1, 1) leaves.
Rows offset() {
  const auto& samples = recordOf("linear_2x2_move").samples;
  const Vector u = samples.at(samples.size() - 2).action.input;  // the final sample has none
  Rows rows;
  for (const Eigen::Index i : {0, 1}) {
    rows.push_back(
        figure("steady input u" + std::to_string(i + 1) + ", printed as u_r", 1.0, u[i], "-"));
    rows.back().behind = "linear_2x2_move";
  }
  const auto left = [&](const char* what, const char* loop, double limit, const char* note) {
    const SampleRecord& last = recordOf(loop).samples.back();
    const double off = (last.measurement.outputs - last.tracking.setpoint).cwiseAbs().maxCoeff();
    rows.push_back(check(what, off, Direction::kLower, limit, "-", note));
    rows.back().behind = loop;
  };
  left("largest offset with u_r = 1", "linear_2x2", 0.0025,
       "u_r is nearly the steady input: the only reason why it is small");
  left("largest offset with u_r = 0 (eqs. 25, 27)", "linear_2x2_zero", 0.0025,
       "the paper prints Es 0.00; a pull to 0 always leaves one");
  left("largest offset with u_r = u(k-1)", "linear_2x2_move", 1e-6,
       "ours, the sound form: a penalty on moves");
  return rows;
}

const bool kRegistered = registerExperiments(
    {{"taieb_table_1", kTaieb, "table 1", "weights and step responses of the linear example",
      "32 numbers", kBehind, table1},
     {"taieb_equations_4_6", kTaieb, "eqs. 4-6, 25, 27", "offset of the linear example",
      "2 numbers", "linear_2x2, linear_2x2_zero, linear_2x2_move", offset}});

}  // namespace
}  // namespace fpc::tool
