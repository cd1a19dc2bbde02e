// The trial of a law that runs beside the one in charge and moves nothing.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/input_limits.hpp"
#include "supervision/candidate_params.hpp"
#include "supervision/horizon_errors.hpp"
#include "supervision/model_trial.hpp"

namespace fpc {

/// What is known of a candidate.
struct CandidateFigures {
  struct Horizon {
    int samples{};
    double ratio{kNaN};    ///< its error over that of "it stays as it is", root mean squares
    double present{kNaN};  ///< the same of the model of the law in charge, if it has one
    Bounded squares;       ///< squares of the first ratio
    Bounded against;       ///< squares of its error over those of the law in charge
  };
  TrialResult result{TrialResult::kOpen};
  std::string why;  ///< it is wrong, or open
  TrialFigures model;
  std::vector<Horizon> horizons;
  double difference{kNaN};  ///< rms of its input minus that of the law in charge, of the range
  double at_limit{kNaN};    ///< share of samples in which it would have met a limit
  double outside{kNaN};     ///< share of samples outside the data of its model
  double confidence{};      ///< of each pair of bounds
};
/// One line of at most 300 characters.
std::string textOf(const CandidateFigures& figures);
/// A JSON object.
std::string jsonOf(const CandidateFigures& figures);

/// Judged once `samples` samples are kept, and again with 2, 3, 5, 7 and 10 times as many; then
/// anew. The confidence of a look is 1 - (1 - confidence) / (kLooks 2^w) in window w = 0, 1, ...:
/// all looks together keep the asked one, however long it takes. Right: ModelTrial says so, at the
/// longest horizon its squares are not surely kWorse times those of "it stays" or of the law in
/// charge, and it was inside its data for all but kOutside of the time.
class CandidateTrial {
 public:
  static constexpr int kLooks = 6;
  static constexpr double kWorse = 1.2, kOutside = 0.2;

  /// Models are matched to the plant; `present`: of the law in charge, may be null.
  /// @throws InputError naming the field.
  CandidateTrial(const TsModel& model, const TsModel* present, const CandidateParams& params,
                 InputLimits limits, std::vector<bool> moved);
  void reset();      ///< begins anew, as if never begun
  void interrupt();  ///< a sample was lost
  /// Sample k. No allocation after the first.
  void look(const Measurement& now);
  /// What the law in charge and the candidate ask for at the sample looked at last.
  void compare(VectorRef law, VectorRef candidate, VectorRef applied);
  /// Judges if it is time to; true if it did.
  bool judgeIfDue();
  /// Of the last judgement.
  const CandidateFigures& figures() const { return figures_; }
  /// Now, at the confidence of the next look; for those who ask in between.
  CandidateFigures judge() const;
  /// A window ended without a verdict.
  bool windowEnded() const { return ended_; }
  Eigen::Index samples() const { return trial_.kept(); }
  const ForecastParts& parts() const { return trial_.parts(); }
  const TsModel& model() const { return parts().local().model(); }

 private:
  Bounded ratio(std::size_t h, bool to_present, double t) const;

  CandidateParams params_;
  InputLimits limits_;
  ModelTrial trial_;
  HorizonErrors errors_, present_;
  CandidateFigures figures_;
  Vector point_;
  double squares_{};
  Eigen::Index compared_{}, limited_{}, outside_{}, seen_{};
  int look_{}, window_{};
  bool ended_{false};
};

}  // namespace fpc
