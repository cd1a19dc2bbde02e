#include "runtime/commissioning/plant_tap.hpp"

#include <chrono>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

PlantTap::PlantTap(double patience_s) : patience_s_(patience_s) {}

bool PlantTap::open() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !closed_;
}

Vector PlantTap::difference() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return difference_;
}

std::uint64_t PlantTap::late() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return late_;
}

void PlantTap::end(const std::string& why) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (closed_) return;
  closed_ = true;
  why_ = why;
  for_loop_.notify_all();
  for_stages_.notify_all();
}

void PlantTap::requireOpen() const {
  require(!closed_, "plant", "a loop that goes on: " + (why_.empty() ? "it is over" : why_));
}

void PlantTap::pass(const Measurement& now, const InputLimits& limits, VectorRef previous,
                    Vector& input) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (closed_) return;
  const std::uint64_t number = ++number_;
  queue_.push_back({number, {now, input, {}}});
  limits_ = limits;
  previous_ = previous;
  answered_ = false;
  for_stages_.notify_all();
  const auto settled = [&] { return answered_ || closed_; };
  if (std::isfinite(patience_s_))
    for_loop_.wait_for(lock, std::chrono::duration<double>(patience_s_), settled);
  else
    for_loop_.wait(lock, settled);
  if (closed_) return;
  const Vector law = input;
  if (answered_) {
    input = answer_;
  } else {
    ++late_;
    if (difference_.size() == law.size()) limits.clip(input += difference_, previous);
  }
  difference_ = input - law;
  if (answered_) return;
  if (current_number_ == number)
    current_.sent = input;
  else
    queue_.back().sample.sent = input;
}

const StagedPlant::Sample& PlantTap::next() {
  std::unique_lock<std::mutex> lock(mutex_);
  for_stages_.wait(lock, [&] { return !queue_.empty() || closed_; });
  requireOpen();
  current_number_ = queue_.front().number;
  current_ = std::move(queue_.front().sample);
  queue_.pop_front();
  return current_;
}

const Vector& PlantTap::send(VectorRef input) {
  const std::lock_guard<std::mutex> lock(mutex_);
  requireOpen();
  if (current_.sent.size() > 0) return current_.sent;  // too late
  answer_ = input;
  if (answer_ != current_.present) limits_.clip(answer_, previous_);
  current_.sent = answer_;
  answered_ = true;
  for_loop_.notify_all();
  return current_.sent;
}

}  // namespace fpc
