#include "supervision/flat_line.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {
namespace {

constexpr double kRounding = 1e-6;  // of the value: numbers of 32 bits tremble by less
constexpr double kBits = 1e-9;      // of the value: differences of equal steps
constexpr double kFar = 16.0;       // resolutions
constexpr double kLeastWhite = 0.45, kMostWhite = 0.85;
constexpr double kPeak = 0.25;   // of the sum of squares, at most
constexpr double kSurely = 0.5;  // of the variance that a window shows
constexpr int kLarge = 8;        // steps of two resolutions: rounding alone makes none
constexpr int kNever = std::numeric_limits<int>::max();

}  // namespace

void FlatLine::push(double step) {
  steps_[static_cast<std::size_t>(next_)] = step;
  next_ = (next_ + 1) % kWindow;
  known_ = std::min(known_ + 1, kWindow);
}

void FlatLine::add(double value) {
  if (!started_) {
    started_ = true;
    value_ = largest_ = smallest_ = value;
    return;
  }
  if (value == value_) {
    if (repeats_ == 0) {
      allowed_ = allowed();
      moves_ = isInMotion();
    }
    if (repeats_ < kNever) ++repeats_;
    return;
  }
  const int missed = std::min(repeats_, kWindow);
  const bool late = isRepeated();
  for (int k = missed; k > 0; --k) push(late ? (value - value_) / (missed + 1) : 0.0);
  push(late ? (value - value_) / (missed + 1) : value - value_);
  repeats_ = 0;
  allowed_ = kNever;
  value_ = value;
  largest_ = std::max(largest_, value);
  smallest_ = std::min(smallest_, value);
}

double FlatLine::resolution() const {
  double least = 0.0, before = 0.0;
  const auto take = [&](double size) { least = least == 0.0 ? size : std::min(least, size); };
  for (int k = 0; k < kWindow; ++k) {
    const double now = step(k), turn = std::abs(now - before);
    if (now != 0.0) take(std::abs(now));
    if (before != 0.0 && turn > kBits * std::abs(value_)) take(turn);
    before = now;
  }
  return least;
}

/// Next to nothing where no resolution explains the steps.
double FlatLine::grid() const {
  const double nothing = kRounding * std::abs(value_);
  double common = 0.0;
  for (int k = kWindow - known_; k < kWindow; ++k) {
    double rest = std::abs(step(k));
    while (rest > nothing) {
      const double over = std::fmod(common, rest);
      common = rest;
      rest = std::min(over, common - over);
    }
  }
  return common;
}

bool FlatLine::isInMotion() const {
  if (known_ < kFirst || 4 * changes() < 3 * known_) return false;
  const double last = step(kWindow - 1), next = 2.0 * last - step(kWindow - 2);
  const bool goes_on = next / last > 0.5;  // not if the last is 0
  return goes_on && std::abs(last) > kFar * std::max(grid(), kRounding * std::abs(value_));
}

int FlatLine::changes() const {
  return known_ - static_cast<int>(std::count(steps_.begin(), steps_.begin() + known_, 0.0));
}

/// Of a run that begins now.
int FlatLine::allowed() const {
  if (known_ < kWindow || changes() < kFewest) return kNever;
  const double q = resolution();
  double products = 0.0, squares = 0.0, peak = 0.0, before = 0.0;
  int large = 0;
  for (int k = 0; k < kWindow; ++k) {
    large += std::abs(step(k)) > 1.5 * q ? 1 : 0;
    if (k == 0) continue;
    const double turn = step(k) - step(k - 1);
    squares += turn * turn;
    peak = std::max(peak, turn * turn);
    products += turn * before;
    before = turn;
  }
  const double white = -products / squares;
  const double noise = -kSurely * products / (4 * (kWindow - 1));
  const bool trembles =
      white > kLeastWhite && white < kMostWhite && peak < kPeak * squares && large >= kLarge;
  if (!trembles || !(noise > std::pow(kRounding * value_, 2))) return kNever;
  const double by_noise = std::erf(q / std::sqrt(8.0 * noise));
  const double seen = (kWindow - changes() + 1.0) / (kWindow + 2.0);
  return static_cast<int>(std::ceil(std::log(kChance) / std::log(std::max(by_noise, seen))));
}

}  // namespace fpc
