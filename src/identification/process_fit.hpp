// Process elements from a record, with bounds that hold under feedback: the prediction errors of
// elements and noise are made small together, so that an input that answers to the output's noise
// does not bias them (ljung1999, secs. 4.2 and 13.4). An unstable pole or an integrator belongs to
// the noise as well (forssell2000).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "model/process_element.hpp"

namespace fpc {

/// What is common to the elements of an output.
enum class ProcessKind { kStable, kIntegrating, kUnstable };

struct ProcessFitParams {
  double longest_dead_time_s{};  ///< 0: a tenth of the record
  int most_noise_terms{10};      ///< of the autoregressive noise
  int blocks{10};                ///< of the record, for bounds where the model is not all of it
  int ensemble{20};              ///< drawn for ProcessFit::ensemble
  std::vector<ProcessKind> kinds{ProcessKind::kStable, ProcessKind::kIntegrating,
                                 ProcessKind::kUnstable};  ///< that are tried
  /// While a test goes on: kinds by Schwarz's criterion alone, normal bounds.
  bool passing{false};
  std::uint64_t seed{1};
  void validate() const;  ///< @throws InputError naming the field
};

/// Half widths of 95 % intervals.
struct ElementEstimate {
  ProcessElement element;
  bool seen{false};  ///< whether the record shows an effect; else gain 0, its bound a limit
  double gain_bound{}, dead_time_bound{}, time_bound{};  ///< time: of tau_1 + tau_2 + theta - beta
};

/// How the gains of a process change with a signal of the record: a fuzzy model of two rules that
/// have the poles of the elements. From `lower` to `upper` of the signal gains change along a line;
/// beyond they stay.
struct GainCurve {
  /// Column of the inputs, whose own gain changes; -1: the output, all gains change.
  Eigen::Index signal{-1};
  double lower{}, upper{};
  double output{};  ///< with this curve, instead of ProcessFit::output
  Vector factor;    ///< of each element's gain, in the middle
  double change{},
      bound{};  ///< of that factor from lower to upper; half width of its 95 % interval
  std::vector<double> ensemble;  ///< equally likely changes, as ProcessFit::ensemble
  /// Of the gain of an element at an end of the curve. It keeps its sign, which is what is known.
  double factorAt(Eigen::Index element, bool upper_end, double changed) const;
};

struct ProcessFit {
  ProcessKind kind{ProcessKind::kStable};
  std::vector<ElementEstimate> elements;  ///< one per column of the inputs
  Vector noise;                           ///< coefficients of the autoregressive noise
  double one_step{};                      ///< rms of the prediction errors
  double free_run{};  ///< rms of what the inputs alone do not explain; with a shared pole: one_step
  double output{};    ///< the output where the inputs are `input` and nothing else acts
  Vector input;       ///< means of the inputs
  Eigen::Index rows{};
  std::vector<std::vector<ProcessElement>> ensemble;  ///< elements of equally likely processes
  std::optional<GainCurve> curve;                     ///< see gainCurve()
};

/// Row k of `inputs` (rows x n) acts from then on, `output` is measured then; NaN where missing
/// (inputs are held over it, and before their first reading have its value). The process has rested
/// with the inputs of the first row.
/// @throws InputError for fewer than 30 rows, sizes, or inputs none of which moves.
ProcessFit fitProcess(const Matrix& inputs, const Vector& output, double sample_time_s,
                      const ProcessFitParams& params = {});

/// The curve whose change the record of a fit is surest of, beside the fitted noise, so that
/// feedback does not bias it; empty: 95 % bounds leave none, over all signals that were tried
/// together. Those are the output and the first `moved` columns, which a test moves again and
/// again: the few moves of a disturbance cannot be told from a drift. Inputs count from their
/// means.
std::optional<GainCurve> gainCurve(const ProcessFit& fit, const Matrix& inputs, Eigen::Index moved,
                                   const Vector& output, double sample_time_s,
                                   const ProcessFitParams& params = {});

/// What an output does beside its elements.
struct ProcessNoise {
  Vector terms;       ///< as ProcessFit::noise
  double one_step{};  ///< as ProcessFit::one_step
};

/// Of a fitted process on another record with the same columns; the inputs may stand still. After
/// large moves the noise of a fit holds what is not linear in the process as well; on a record of
/// normal operation it does not. Empty: fewer than 30 rows without a gap.
/// @throws InputError for sizes.
std::optional<ProcessNoise> noiseBeside(const ProcessFit& fit, const Matrix& inputs,
                                        const Vector& output, double sample_time_s);

}  // namespace fpc
