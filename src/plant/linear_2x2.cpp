// The linear example on which the fuzzy optimal law is explained: two outputs, two inputs, four
// lags x(k) = p x(k-1) + u(k-1), all moved together.
//
//   y1 = -0.7664 x11 + 0.9 x12        p11 = 0.9401  p12 = 0.9524
//   y2 = -0.6055 x21 + 1.3472 x22     p21 = 0.9083  p22 = 0.9306
//
// Such a lag is a continuous one, gain 1/(1 - p) and time constant -Te / ln(p), under an input that
// is held: the transfer matrix of these four lags, moved exactly by its stepper, is the printed
// difference equation at sample times of Te = 1 s, to rounding.
//
// Source: taieb2017, eq. 4.
#include <cmath>

#include "plant/transfer_matrix.hpp"

namespace fpc {
namespace {

constexpr double kSampleTime = 1.0;  // [s]

TransferElement lag(const char* output, const char* input, double factor, double pole) {
  return {output, input, factor / (1.0 - pole), -kSampleTime / std::log(pole)};
}

TransferMatrix linearExample() {
  TransferMatrix m;
  m.name = "linear_2x2";
  m.title = "Linear example, four discrete lags, 2 inputs, 2 outputs (taieb2017, eq. 4)";
  m.time_unit_s = 1.0;
  m.outputs = {{"y1", "-", 0.0, -1e4, 1e4}, {"y2", "-", 0.0, -1e4, 1e4}};
  m.inputs = {{"u1", "-", 0.0, -1e3, 1e3}, {"u2", "-", 0.0, -1e3, 1e3}};
  m.elements = {lag("y1", "u1", -0.7664, 0.9401), lag("y1", "u2", 0.9, 0.9524),
                lag("y2", "u1", -0.6055, 0.9083), lag("y2", "u2", 1.3472, 0.9306)};
  return m;
}

const bool kLinear2x2Registered = registerPlant("linear_2x2", [](const PlantParameters& given) {
  auto plant = std::make_unique<TransferMatrixPlant>(linearExample());
  parameterValues(plant->description(), given);  // has none: refuses every name
  return plant;
});

}  // namespace
}  // namespace fpc
