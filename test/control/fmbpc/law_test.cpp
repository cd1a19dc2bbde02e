// The published law against its formula, written out a second time in plain loops.
#include "control/fmbpc/law.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "control/fmbpc/law_fixture.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_fmbpc_law_test {

using test::pair;

/// The biomass submodel of FM_1 without any of the library's arithmetic: products of exponentials,
/// weighted sums.
struct Biomass {
  double f{}, p{}, load{}, rest{};  // x(k+1) = f x + load q_i + p q_r + rest

  Biomass(const OutputModel& model, double x, double q_i, double q_r) {
    const double at[3] = {x, q_i, q_r};
    double total = 0.0;
    for (const Rule& rule : model.rules) {
      double degree = 1.0;
      for (std::size_t j = 0; j < 3; ++j)
        degree *= exponential(rule.antecedents[j].parameters, at[j]);
      total += degree;
      f += degree * rule.coefficients[0];
      load += degree * rule.coefficients[1];
      p += degree * rule.coefficients[2];
      rest += degree * rule.offset;
    }
    for (double* sum : {&f, &load, &p, &rest}) *sum /= total;
  }
  static double exponential(const std::vector<double>& c, double z) {
    if (z < c[1])
      return c[1] > c[0] ? std::exp(-7.0 * std::pow((z - c[1]) / (c[1] - c[0]), 2)) : 0.0;
    if (z > c[2])
      return c[3] > c[2] ? std::exp(-7.0 * std::pow((z - c[2]) / (c[3] - c[2]), 2)) : 0.0;
    return 1.0;
  }
};

/// FM_1 as a plant, but with more growth and a sensor that is off, so that y and y_m part.
test::ModelPlant otherPlant() {
  TsModel model = test::shippedModel("fm_1");
  for (auto& rule : model.submodels[1].rules) rule.offset += 4.0;
  test::ModelPlant plant(model, pair(200.0, 2000.0), Vector::Constant(1, 570.0),
                         pair(1300.0, 366.67));
  plant.output_bias = pair(0.0, 3.0);
  return plant;
}

Vector loadAt(std::uint32_t k) {
  return pair(1300.0 + 250.0 * std::sin(0.05 * k), 366.67 + 60.0 * std::cos(0.04 * k));
}

InputLimits pumpLimits() {
  InputLimits limits = test::wideLimits(1);
  limits.lower << 0.0;
  limits.upper << 1600.0;
  return limits;
}

/// Inputs (unclipped and sent) of a run of the law on that plant.
struct Inputs {
  std::vector<double> unclipped, sent;
  int predictions{};
};

Inputs runOnOtherPlant(
    const FmbpcParams& params, double s_setpoint, std::uint32_t samples,
    const std::function<void(const Measurement&, const ControllerOutput&)>& visit = {}) {
  FmbpcLaw law(params, pumpLimits(), test::activatedSludgeInfo());
  law.setModel(test::shippedModel("fm_1"));
  test::ModelPlant plant = otherPlant();
  SetpointSource setpoint =
      test::setpointOf(test::activatedSludgeInfo(), pair(s_setpoint, 2000.0),
                       {{10.0, pair(s_setpoint, 1900.0)}, {30.0, pair(s_setpoint, 2080.0)}});
  ControllerOutput output;
  Inputs inputs;
  for (std::uint32_t k = 0; k < samples; ++k) {
    plant.d = loadAt(k);
    const Measurement now = plant.measure(k);
    if (k == 0) law.reset(now);
    setpoint.advance(k);
    law.step(now, setpoint, output);
    inputs.predictions += output.predictive ? 1 : 0;
    inputs.unclipped.push_back(output.prediction.input_base_unclipped[0]);
    inputs.sent.push_back(output.input[0]);
    if (visit) visit(now, output);
    plant.advance(output.input);
  }
  return inputs;
}

TEST(PublishedLaw, EqualsErrorOverM2AlongARun) {
  for (const int horizon : {1, 6, 40, 180}) {
    SCOPED_TRACE("H = " + std::to_string(horizon));
    FmbpcParams params = test::publishedParams();
    params.coincidence_steps = horizon;
    const OutputModel model = test::shippedModel("fm_1").submodels[1];
    double z = 0.0, reference = 0.0, predicted = 0.0, gap = 0.0;
    int clipped = 0;
    Biomass local(model, 2000.0, 1300.0, 570.0);
    const Inputs inputs = runOnOtherPlant(
        params, 55.0, 250, [&](const Measurement& now, const ControllerOutput& output) {
          const double y = now.outputs[1], before = now.input_applied[0], q_i = now.disturbances[0];
          if (now.header.step == 0) z = reference = y;
          if (now.header.step > 0) z = predicted + local.p * before;
          local = Biomass(model, z, q_i, before);
          predicted = local.f * z + local.load * q_i + local.rest;
          double power = 1.0, sum = 0.0;
          for (int i = 0; i < horizon; ++i, power *= local.f) sum += power;
          const double setpoint = now.header.step < 50    ? 2000.0
                                  : now.header.step < 150 ? 1900.0
                                                          : 2080.0;
          const double decay = std::pow(0.96, horizon);
          const double asked = decay * reference + (1.0 - decay) * setpoint;
          const double e = asked - y + z - power * z - sum * (local.load * q_i + local.rest);
          const double u = e / (local.p * sum);
          EXPECT_NEAR(output.prediction.input_base_unclipped[0], u,
                      1e-8 * std::max(1.0, std::abs(u)));
          EXPECT_NEAR(output.reference[1], reference, 1e-9);
          EXPECT_EQ(output.input[0],
                    std::min(std::max(output.prediction.input_base_unclipped[0], 0.0), 1600.0));
          EXPECT_EQ(output.source, output.input == output.prediction.input_base_unclipped
                                       ? ActionSource::kBase
                                       : ActionSource::kClipped);
          clipped += output.source == ActionSource::kClipped ? 1 : 0;
          gap = std::max(gap, std::abs(y - z));
          reference = 0.96 * reference + 0.04 * setpoint;
        });
    EXPECT_EQ(inputs.predictions, 250);
    EXPECT_GT(gap, 1.0) << "plant and model were meant to differ";
    EXPECT_LT(clipped, 200);
  }
}

TEST(PublishedLaw, DoesNotMoveWithTheSubstrateSetpoint) {
  const Inputs low = runOnOtherPlant(test::publishedParams(), 55.0, 200),
               high = runOnOtherPlant(test::publishedParams(), 500.0, 200);
  EXPECT_EQ(low.unclipped, high.unclipped);
  EXPECT_EQ(low.sent, high.sent);
}

TEST(PublishedLaw, EqualsTheGeneralLawWithOnlyTheLastOutputWeighted) {
  FmbpcParams general = test::publishedParams();
  general.law = FmbpcForm::kGeneral;
  general.weight_output = pair(0.0, 1.0);
  general.weight_move = Vector::Zero(1);
  const Inputs a = runOnOtherPlant(test::publishedParams(), 55.0, 250),
               b = runOnOtherPlant(general, 55.0, 250);
  for (std::size_t k = 0; k < a.unclipped.size(); ++k)
    EXPECT_NEAR(a.unclipped[k], b.unclipped[k], 1e-8 * std::max(1.0, std::abs(a.unclipped[k])))
        << "sample " << k;
}

/// The extended-input form of the paper with sums in place of (A - I)^-1, in long double: M_a
/// (u(k), u(k-1))' = rhs.
double extendedInput(const PredictiveAction& now, const Vector& asked, int horizon) {
  using Long = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Long A = now.A.topLeftCorner(2, 2).cast<long double>();
  Long B(2, 2);
  B << now.B(0, 0), now.A(0, 2), now.B(1, 0), now.A(1, 2);
  Long P(2, 2);
  P << 1, 0, 1, 0;
  Long power = Long::Identity(2, 2), before = power, sum = Long::Zero(2, 2), sum_before = sum;
  for (int i = 0; i < horizon; ++i) {
    before = power;
    sum_before = sum;
    sum = sum + power;
    power = A * power;
  }
  const Long M_a = before * B + sum_before * B * P;
  const Long rhs = (asked - now.offset_output).cast<long double>() -
                   power * now.state.head(2).cast<long double>() -
                   sum * now.offset_state.head(2).cast<long double>();
  return static_cast<double>(M_a.fullPivLu().solve(rhs)(0, 0));
}

TEST(PublishedLaw, EqualsThePaperWithItsMatrixForSmallHorizons) {
  for (const int horizon : {1, 2, 3, 4}) {
    FmbpcParams params = test::publishedParams();
    params.coincidence_steps = horizon;
    params.prediction_steps = horizon;
    runOnOtherPlant(params, 55.0, 60, [&](const Measurement&, const ControllerOutput& output) {
      const PredictiveAction& now = output.prediction;
      const double paper = extendedInput(now, now.reference.col(horizon - 1), horizon);
      EXPECT_NEAR(now.input_base_unclipped[0], paper, 1e-8 * std::max(1.0, std::abs(paper)))
          << "H = " << horizon;
    });
  }
}

TEST(PublishedLaw, IsForOneInput) {
  PlantInfo info = test::activatedSludgeInfo();
  info.inputs.push_back(test::signal("q_p", "m3/h"));
  EXPECT_THROW(FmbpcLaw(test::publishedParams(), test::wideLimits(2), info), InputError);
}

}  // namespace control_fmbpc_law_test
}  // namespace fpc
