// What is known of a process before any data, as constraints on the consequents of a Takagi-Sugeno
// model: linear ones are kept exactly by a quadratic programme, poles of high order by small steps.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

struct DataSet;

/// A rest of the process: with these values held, the output stays where it is.
struct KnownRest {
  Vector values;    ///< of all outputs, inputs, disturbances in this order; NaN: not stated
  double within{};  ///< the model's output may rest so far from it, unit of the output
};

/// Of one output. Signs: +1, -1, or 0 where nothing is known.
struct PriorKnowledge {
  std::vector<int> gain;      ///< per input, then disturbance: of every rule's steady-state gain
  std::vector<int> monotone;  ///< the same, and of the blended model at every sample of the data
  double max_pole{};          ///< > 0: no pole of a rule lies outside this radius
  std::vector<KnownRest> steady;

  bool empty() const {
    const auto unknown = [](int s) { return s == 0; };
    return std::all_of(gain.begin(), gain.end(), unknown) &&
           std::all_of(monotone.begin(), monotone.end(), unknown) && !(max_pole > 0.0) &&
           steady.empty();
  }
};

/// lower <= A theta <= upper on the stacked [coefficients, offset] of all rules, whose sets stay.
struct KnowledgeRows {
  Matrix A;
  Vector lower, upper;
};

/// Rows for one output of a model over a record, in the signals' own units. Poles are rows up to
/// two lags of the output; beyond them keepsPoles() decides.
/// @throws InputError if a steady state does not state a signal that the model depends on
KnowledgeRows knowledgeRows(const OutputModel& model, int output, const DataSet& data,
                            const PriorKnowledge& known);

/// All rules have their poles inside known.max_pole.
bool keepsPoles(const OutputModel& model, int output, const PriorKnowledge& known);

/// Moves theta to the nearest point inside the rows, in the metric of H (symmetric positive
/// definite). @return false if there is none
bool nearestInside(const KnowledgeRows& rows, const Matrix& H, Vector& theta);

/// Brings a model that was fitted by least squares to the nearest one that agrees with what is
/// known, near by the rules' own samples. @throws InputError naming the output if there is none
void imposeKnowledge(const DataSet& data, int output, const PriorKnowledge& known,
                     OutputModel& model);

/// What a model breaks, in words; empty: nothing.
std::vector<std::string> brokenKnowledge(const OutputModel& model, int output, const DataSet& data,
                                         const PriorKnowledge& known);

}  // namespace fpc
