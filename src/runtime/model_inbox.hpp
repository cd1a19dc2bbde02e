// Models on their way to a controller over topics. In one process a model made from sample k is
// used from sample k + 1 on; this keeps it so although messages of two topics have no order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "fmbpc/base/event.hpp"
#include "fmbpc/base/exchange.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// What the identifier says when it has done with sample k.
struct IdentifierWord {
  StepHeader header;
  bool model{};  ///< it has handed over a model made from this sample
  /// Not empty: this is no such word (one follows), but what went wrong at this sample.
  std::vector<Event> events{};
};

class ModelInbox {
 public:
  static constexpr std::size_t kMostEvents = 20;  ///< that wait; later ones are dropped

  /// `in_step`: no sample is answered before the identifier has done with the one before it
  /// (lockstep, and the loop identifies). Otherwise models are used when they come.
  explicit ModelInbox(bool in_step) : in_step_(in_step) {}

  /// From now on only words and models of this run count; what waits of others is used at once.
  void announce(std::uint64_t run_id) { run_id_ = run_id; }
  /// `made_from`: the sample; run 0: of none (a file, a person), used from the next sample on.
  /// A model that was used already is not used again (an identifier that comes back repeats it).
  void put(TsModel model, const StepHeader& made_from);
  void hear(const IdentifierWord& word);
  /// Whether `next` may be answered: nothing that belongs before it is still under way.
  bool complete(const StepHeader& next) const;
  /// Models to be used before `next` is answered, in their order. They are taken out; `next` of run
  /// 0 stands for a controller that has answered nothing yet.
  std::vector<TsModel> take(const StepHeader& next);
  /// Events of the samples before `next`; taken out, and then of it.
  std::vector<Event> takeEvents(const StepHeader& next);

 private:
  bool belongsBefore(const StepHeader& made_from, const StepHeader& next) const;

  struct Item {
    StepHeader made_from;
    TsModel model;
  };
  struct Used {
    StepHeader made_from;
    std::string name, source;
    bool is(const TsModel& model, const StepHeader& other) const;
  };
  bool in_step_;
  std::uint64_t run_id_{};
  std::deque<Item> items_;
  std::deque<IdentifierWord> words_;
  std::optional<StepHeader> word_;  // the latest
  std::optional<Used> used_;        // the model taken last
  std::optional<StepHeader> owed_;  // a model that was announced and has not come
};

}  // namespace fpc
