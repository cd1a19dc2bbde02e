// Heavy-oil fractionator of Shell's control problem: seven outputs, three inputs and two loads,
// each of the 35 elements a lag with a dead time. One number per column moves all its gains:
//
//   K = K_nominal + epsilon_j dK,   -1 <= epsilon_j <= 1
//
// The type transfer_matrix of fmbpc moves it; this plant only says what its gains are.
// Source: prett1987. Signals are deviations from the operating point.
#include "arena_plant.hpp"

#include <fmbpc/base/yaml_section.hpp>

#include <string>

namespace {

using fpc::Vector;
using fpc::VectorRef;

struct Element {
  double gain, uncertainty, time_constant, dead_time;  // [min]
};

constexpr int kOutputs = 7, kInputs = 3, kSources = 5;
constexpr const char* kOutput[kOutputs] = {"y1", "y2", "y3", "y4", "y5", "y6", "y7"};
constexpr const char* kSource[kSources] = {"u1", "u2", "u3", "l1", "l2"};

// clang-format off
constexpr Element kElement[kOutputs][kSources] = {
    {{4.05, 2.11, 50, 27}, {1.77, 0.39, 60, 28}, {5.88, 0.59, 50, 27}, {1.20, 0.12, 45, 27}, {1.44, 0.16, 40, 27}},
    {{5.39, 3.29, 50, 18}, {5.72, 0.57, 60, 14}, {6.90, 0.89, 40, 15}, {1.52, 0.13, 25, 15}, {1.83, 0.13, 20, 15}},
    {{3.66, 2.29, 9, 2}, {1.65, 0.35, 30, 20}, {5.53, 0.67, 40, 2}, {1.16, 0.08, 11, 0}, {1.27, 0.08, 6, 0}},
    {{5.92, 2.34, 12, 11}, {2.54, 0.24, 27, 12}, {8.10, 0.32, 20, 2}, {1.73, 0.02, 5, 0}, {1.79, 0.04, 19, 0}},
    {{4.13, 1.71, 8, 5}, {2.38, 0.93, 19, 7}, {6.23, 0.30, 10, 2}, {1.31, 0.03, 2, 0}, {1.26, 0.02, 22, 0}},
    {{4.06, 2.39, 13, 8}, {4.18, 0.35, 33, 4}, {6.53, 0.72, 9, 1}, {1.19, 0.08, 19, 0}, {1.17, 0.01, 24, 0}},
    {{4.38, 3.11, 33, 20}, {4.42, 0.73, 44, 22}, {7.20, 1.33, 19, 0}, {1.14, 0.18, 27, 0}, {1.26, 0.18, 32, 0}}};
// clang-format on

/// The section `key`: signals first..last within +-span.
std::string signalsText(const char* key, const char* const* first, const char* const* last,
                        const char* span) {
  std::string text = std::string("  ") + key + ":\n";
  for (; first != last; ++first)
    text +=
        std::string("    - {name: ") + *first + ", lower: -" + span + ", upper: " + span + "}\n";
  return text;
}

std::string matrixText(const Vector& epsilon) {
  std::string text = "matrix:\n";
  text += signalsText("outputs", kOutput, kOutput + kOutputs, "5");
  text += signalsText("inputs", kSource, kSource + kInputs, "0.5");
  text += signalsText("disturbances", kSource + kInputs, kSource + kSources, "0.5");
  text += "  elements:\n";
  for (int i = 0; i < kOutputs; ++i)
    for (int j = 0; j < kSources; ++j) {
      const Element& e = kElement[i][j];
      text += std::string("    - {output: ") + kOutput[i] + ", from: " + kSource[j] +
              ", gain: " + std::to_string(e.gain + epsilon[j] * e.uncertainty) +
              ", time_constant_min: " + std::to_string(e.time_constant) +
              ", dead_time_min: " + std::to_string(e.dead_time) + "}\n";
    }
  return text;
}

std::vector<fpc::Quantity> parameters() {
  std::vector<fpc::Quantity> all;
  for (int j = 1; j <= kSources; ++j)
    all.push_back({"epsilon_" + std::to_string(j), "-", 0.0, -1.0, 1.0});
  return all;
}

class ShellFractionator final : public fpc::Plant {
 public:
  explicit ShellFractionator(const fpc::PlantParameters& given) {
    description_.parameters = parameters();
    const Vector epsilon = fpc::parameterValues(description_, given);
    auto section = fpc::YamlSection::parse(matrixText(epsilon), "shell_fractionator");
    matrix_ = fpc::plantFactory("transfer_matrix", section)({});
    description_ = matrix_->description();
    description_.name = "shell_fractionator";
    description_.parameters = parameters();
    for (const char* load : {"l1", "l2"}) description_.hidden_disturbances.emplace_back(load);
  }
  const fpc::PlantDescription& description() const override { return description_; }
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    matrix_->derivatives(x, u, d, dxdt);
  }
  std::unique_ptr<fpc::PlantStepper> makeStepper(double sample_time_s) const override {
    return matrix_->makeStepper(sample_time_s);
  }

 private:
  fpc::PlantDescription description_;
  std::unique_ptr<fpc::Plant> matrix_;
};

const bool kRegistered = arena::registered<ShellFractionator>("shell_fractionator");

}  // namespace
