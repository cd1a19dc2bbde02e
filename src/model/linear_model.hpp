// A matrix of lags with dead times as a Takagi-Sugeno model of one rule per output, so that every
// predictive law can use it.
#pragma once

#include <vector>

#include "base/fopdt.hpp"
#include "fmbpc/model/ts_model.hpp"
#include "model/process_element.hpp"

namespace fpc {

struct LinearElement {
  int output{};
  SignalKind kind{SignalKind::kInput};  ///< kInput or kDisturbance
  int index{};                          ///< of that input or disturbance
  Fopdt element;
};

/// Values at which the deviations of the elements are zero.
struct LinearPoint {
  Vector outputs, inputs, disturbances;
};

/// `names` brings names, units and sample time. Exact for inputs held over a sample: of each output
/// y(k+1) over the common denominator of its elements, the dead times (fractional ones too) in the
/// lags of the inputs. @throws InputError on indices, sizes, or an output without elements.
TsModel linearModel(const TsModel& names, const std::vector<LinearElement>& elements,
                    const LinearPoint& point);

/// The same of elements of any kind; of one output, integrators and unstable poles are one pole.
struct SampledLinearElement {
  int output{};
  SignalKind kind{SignalKind::kInput};
  int index{};
  SampledElement element;
  int poles_of{
      -1};  ///< place among the elements of the output of the one whose own poles these are
};
TsModel linearModel(const TsModel& names, const std::vector<SampledLinearElement>& elements,
                    const LinearPoint& point);

}  // namespace fpc
