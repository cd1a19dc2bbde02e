// Is a model right? Judged on the samples of a loop that somebody else controls, without an
// experiment.
#pragma once

#include <string>
#include <vector>

#include "supervision/forecast_parts.hpp"
#include "supervision/jackknife.hpp"

namespace fpc {

enum class TrialResult { kOpen, kRight, kWrong };

/// What the samples say of a model.
struct TrialFigures {
  /// An input that acts `samples` later than the model says (earlier if negative): what that loses
  /// of the inputs' effect. Below 0 it explains more.
  struct Shift {
    int samples{};
    Bounded loss;
  };
  TrialResult result{TrialResult::kOpen};
  std::string why;                         ///< in words: what is wrong, or not known yet
  Eigen::Index samples{};                  ///< that were judged
  Bounded explained;                       ///< share of the inputs' effect
  std::vector<Bounded> gain;               ///< by input: the plant's gain over the model's
  std::vector<std::vector<Shift>> shifts;  ///< by input
};

/// The model's errors one sample ahead e(k) and its forecast's parts phi_i(k) from input i, made
/// white by an autoregression of kOrder, are compared with the same errors
/// - of a model on which no input acts, e + phi_1 + phi_2 ..., and
/// - of one to which any effect of the inputs was added that the samples ask for (least squares on
///   all inputs at the lags of the model and kSlack more on either side; it gives the
///   autoregression too).
/// Errors that are white do not depend on the past moves of a controller, so that feedback does not
/// bias what follows (the direct method of ljung1999, section 13.4). With S the sums of their
/// squares, over outputs each divided by its variance:
/// - explained = (S_none - S_model) / (S_none - S_any): 1 for a right model, 1 - (1 - g)^2 for one
///   whose gains are g times the plant's;
/// - gain c_i by least squares of e on the parts: the plant's over the model's;
/// - loss of a shift = (S_shift - S_model) / (S_none - S_any), for shifts that leave every input at
///   least its first sample.
/// Bounds of the first two: jackknife over kBlocks blocks of equal length and Student's t, so that
/// what only few stretches say widens them. Of a loss, whose difference of errors is d(k): as e is
/// white, sum 2 e d has the variance 4 sum d^2 if the errors' variance is the same everywhere, and
/// 4 sum e^2 d^2 if not; the larger counts, with the same t. Right: explained above kExplained,
/// every gain that matters within kGain of 1, a shift by two samples loses. Wrong: one of these is
/// surely not so. Else open. Symbols:  e, phi [of the output];  c, explained, loss 1
class ModelTrial {
 public:
  static constexpr int kOrder = 6, kSlack = 4, kBlocks = 20;
  static constexpr double kExplained = 0.9, kGain = 2.0;

  /// `model` is matched to the plant; `moved`: the inputs that a law may move, empty for all.
  /// @throws InputError unless capacity > 0 [samples].
  ModelTrial(const TsModel& model, Eigen::Index capacity, std::vector<bool> moved = {});
  void reset();      ///< forgets everything
  void interrupt();  ///< a sample was lost or not accepted
  /// Sample k. Does nothing once capacity() samples are kept. No allocation after the first.
  void look(const Measurement& now);
  Eigen::Index kept() const { return kept_; }
  Eigen::Index capacity() const { return inputs_.cols(); }
  const ForecastParts& parts() const { return parts_; }
  /// @param confidence of each bound pair, (0, 1). Allocates.
  TrialFigures judge(double confidence) const;

 private:
  struct Sums;
  bool fillSums(Eigen::Index output, Sums& sums) const;
  std::vector<Eigen::Index> usable(Eigen::Index output) const;
  bool actsOn(Eigen::Index output, Eigen::Index input) const;

  ForecastParts parts_;
  std::vector<std::string> names_;
  std::vector<bool> moved_;
  int reach_{};                    // samples before one that is judged
  Matrix errors_, inputs_;         // n_y N; n_u N
  std::vector<Matrix> effects_;    // of each shift: n_y n_u, N
  std::vector<Eigen::Index> age_;  // samples since the last interruption
  Eigen::Index kept_{}, running_{};
};

}  // namespace fpc
