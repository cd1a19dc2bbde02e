#include "runtime/model_inbox.hpp"

#include <algorithm>
#include <utility>

#include "base/same_sample.hpp"

namespace fpc {

void ModelInbox::put(TsModel model, const StepHeader& made_from) {
  if (owed_ && isSameSample(*owed_, made_from)) owed_.reset();
  if (made_from.run_id != 0 && used_ && used_->is(model, made_from)) return;
  items_.push_back({made_from, std::move(model)});
}

void ModelInbox::hear(const IdentifierWord& word) {
  if (word.header.run_id != run_id_) return;
  if (!word.events.empty()) {
    if (words_.size() < kMostEvents) words_.push_back(word);
    return;
  }
  word_ = word.header;
  if (!word.model) return;
  const bool used =
      used_ && isSameSample(used_->made_from, word.header);  // it was faster than its word
  const bool here = used || std::any_of(items_.begin(), items_.end(), [&](const Item& item) {
                      return isSameSample(item.made_from, word.header);
                    });
  if (!here) owed_ = word.header;
}

// One sample may give two: what is learned online, and what was identified on demand.
bool ModelInbox::Used::is(const TsModel& model, const StepHeader& other) const {
  return isSameSample(made_from, other) && name == model.name && source == model.source;
}

bool ModelInbox::belongsBefore(const StepHeader& made_from, const StepHeader& next) const {
  return !in_step_ || made_from.run_id == 0 || made_from.run_id != next.run_id ||
         made_from.step < next.step;
}

bool ModelInbox::complete(const StepHeader& next) const {
  if (!in_step_ || next.step == 0) return true;
  const bool done = word_ && word_->run_id == next.run_id && word_->step + 1 >= next.step;
  return done && !(owed_ && owed_->run_id == next.run_id && owed_->step < next.step);
}

std::vector<TsModel> ModelInbox::take(const StepHeader& next) {
  std::vector<TsModel> due;
  std::deque<Item> later;
  for (Item& item : items_) {
    if (!belongsBefore(item.made_from, next)) {
      later.push_back(std::move(item));
      continue;
    }
    used_ = Used{item.made_from, item.model.name, item.model.source};
    due.push_back(std::move(item.model));
  }
  items_ = std::move(later);
  return due;
}

std::vector<Event> ModelInbox::takeEvents(const StepHeader& next) {
  std::vector<Event> due;
  std::deque<IdentifierWord> later;
  for (IdentifierWord& word : words_)
    if (word.header.run_id != next.run_id)
      continue;  // of a run that is over
    else if (belongsBefore(word.header, next))
      for (Event& event : word.events) {
        event.first = event.last = next.step;
        due.push_back(std::move(event));
      }
    else
      later.push_back(std::move(word));
  words_ = std::move(later);
  return due;
}

}  // namespace fpc
