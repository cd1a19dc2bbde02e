// The model's keeper as a member of the exchange: when to identify, what is learned online, and
// which models may be handed over. The node and the run in one process are made of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "fmbpc/model/ts_model.hpp"
#include "identification/online_learner.hpp"
#include "identification/record_identification.hpp"
#include "identification/sample_collector.hpp"

namespace fpc {

/// What identifyRecord() needs.
struct IdentificationJob {
  Matrix values;
  Structure structure;
  std::string source;  ///< provenance in words
  double share{};      ///< of the rows, held out
};

/// A model made from the samples up to k is handed over with the header of sample k; a controller
/// uses it from sample k + 1 on.
class IdentifierSession {
 public:
  explicit IdentifierSession(const LoopFile& loop);

  static constexpr double kKeptPatience = 1.0;  ///< [s] for a plant that keeps models

  /// The plant has announced a run, at this time [s] of any steady clock.
  void announce(std::uint64_t run_id, double now_s = 0.0);
  /// The plant says which model it has kept (run 0: none). Whether that is to be restored: it is
  /// of this run, and none has been handed over yet.
  bool hearKept(const StepHeader& made_from);
  /// Whether the model of the loop file is to be handed over: the plant has said what it has kept,
  /// or nothing for a while, and that was none.
  bool startDue(double now_s) const;
  /// The model of the loop file, matched to the plant; null if it names none. @throws InputError if
  /// it does not fit.
  const TsModel* start();
  /// A model that was in force before this object was made.
  const TsModel& restore(const TsModel& model);

  /// What a sample asks for.
  struct Due {
    Arrival arrival{Arrival::kOld};
    const TsModel* model{nullptr};                ///< learned online: to be handed over now
    std::string refusal{};                        ///< why there is no model, or no job
    EventCode refused{EventCode::kModelRefused};  ///< of a refusal
    std::optional<IdentificationJob> job{};       ///< model.identify.after: to be identified, once
  };
  /// @throws InputError naming a wrong size.
  Due take(const Measurement& measurement);
  /// An identification that somebody asks for, of the newest rows (0: all).
  /// @throws InputError without samples, or naming a signal of the structure.
  IdentificationJob job(Structure structure, std::size_t newest, double share) const;
  /// Takes an identified model: it must fit the plant and be stable at the present sample (see
  /// requireStable()); online learning goes on from it. @throws InputError otherwise, counted.
  const TsModel& accept(const TsModel& identified);

  const TsModel& model() const { return model_; }  ///< handed over last, matched to the plant
  const StepHeader& present() const { return collector_.last(); }  ///< the sample taken last
  std::uint64_t published() const { return published_; }
  std::uint64_t refused() const { return refused_; }
  const SampleCollector& collector() const { return collector_; }
  std::uint64_t learned() const { return learner_ ? learner_->samples() : 0; }

 private:
  void identify(Due& due);
  void learn(Due& due);
  TsModel matched(const TsModel& model) const;
  TsModel checked(const TsModel& model);
  const TsModel& use(TsModel matched);

  PlantInfo plant_;
  std::vector<std::string> estimated_;  // disturbances that nobody measures, by the controller
  IdentifyParams params_;
  double max_pole_;
  bool has_start_, has_identify_;
  TsModel start_, model_;
  SampleCollector collector_;
  std::optional<OnlineLearner> learner_;
  std::uint64_t published_{}, refused_{};
  bool done_by_itself_{false};
  std::optional<double> announced_s_;  // first
  bool kept_known_{false};             // what the plant has kept, if anything
};

}  // namespace fpc
