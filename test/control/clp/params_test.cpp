// Every field of the section `clp` is checked, and the message names it.
#include "control/clp/fixture.hpp"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"

namespace fpc::clp_test {
namespace control_clp_params_test {

Vector numbers(std::initializer_list<double> list) {
  Vector v(static_cast<Eigen::Index>(list.size()));
  std::copy(list.begin(), list.end(), v.data());
  return v;
}

struct BadField {
  const char* name;
  std::function<void(ClpParams&)> spoil;
};

TEST(ClpParams, EachBadFieldIsNamed) {
  const double nan = std::nan("");
  const std::vector<BadField> fields = {
      {"perturbation_steps", [](ClpParams& p) { p.perturbation_steps = 0; }},
      {"weight_perturbation", [](ClpParams& p) { p.weight_perturbation = numbers({1.0}); }},
      {"weight_perturbation",
       [](ClpParams& p) {
         p.weight_perturbation = numbers({1.0, 0.0});
       }},
      {"weight_tracking",
       [](ClpParams& p) {
         p.weight_tracking = numbers({1.0, -1.0});
       }},
      {"weight_state_output",
       [=](ClpParams& p) {
         p.weight_state_output = numbers({1.0, nan});
       }},
      {"weight_input",
       [](ClpParams& p) {
         p.weight_input = numbers({0.0, 1.0});
       }},
      {"increment_lower", [](ClpParams& p) { p.bounds = ClpBounds::kIncremental; }},
      {"increment_upper", [](ClpParams& p) { p.increment_upper = numbers({1.0}); }},
      {"increment_upper",
       [](ClpParams& p) {
         p.increment_lower = numbers({1.0, 1.0});
         p.increment_upper = numbers({2.0, 0.0});
       }},
      {"output_lower",
       [=](ClpParams& p) {
         p.output_lower = numbers({nan, 0.0});
       }},
      {"output_upper",
       [](ClpParams& p) {
         p.output_lower = numbers({1.0, 1.0});
         p.output_upper = numbers({2.0, 0.0});
       }},
      {"output_penalty", [](ClpParams& p) { p.output_penalty = 0.0; }},
      {"clp.bounds", [](ClpParams& p) { p.target_outputs = {0}; }},
      {"clp.bounds",
       [](ClpParams& p) {
         p.target_outputs = {0, 0};
       }},
      {"clp.bounds",
       [](ClpParams& p) {
         p.target_outputs = {0, 2};
       }},
      {"max_iterations", [](ClpParams& p) { p.qp.max_iterations = 0; }},
  };
  EXPECT_NO_THROW(ClpParams().validate(2, 2));
  for (const BadField& field : fields) {
    ClpParams params;
    field.spoil(params);
    try {
      params.validate(2, 2);
      ADD_FAILURE() << field.name << " was accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(field.name), std::string::npos) << error.what();
    }
  }
}

TEST(ClpParams, MoreOutputsThanInputsNeedTargetsForLqOnly) {
  ClpParams params;
  EXPECT_NO_THROW(params.validate(2, 1));
  params.cost = ClpCostKind::kLq;
  EXPECT_THROW(params.validate(2, 1), InputError);
  params.target_outputs = {1};
  EXPECT_NO_THROW(params.validate(2, 1));
}

TEST(ClpParams, ConstructionChecksLimitsAndSizes) {
  Case made = sludgeLike(5);
  ClpParams params;
  params.perturbation_steps = 5;
  EXPECT_THROW(ClosedLoopParadigm(params, made.limits, 3, 2, 2), InputError);
  EXPECT_THROW(ClosedLoopParadigm(params, made.limits, 0, 2, 1), InputError);
  made.limits.lower[0] = 5000.0;
  EXPECT_THROW(made.make(params), InputError);
}

}  // namespace control_clp_params_test
}  // namespace fpc::clp_test
