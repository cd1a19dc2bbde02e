#include "control/pi/decoupling.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr double kSnap = 1e-9;  // samples

double delaySamples(const FopdtMatrix& model, std::size_t i, double sample_time_min) {
  const double samples = (model[i][1 - i].dead_time - model[i][i].dead_time) / sample_time_min;
  const double whole = std::round(samples);
  return std::abs(samples - whole) < kSnap ? whole : samples;
}

}  // namespace

std::string InvertedDecoupling::refusal(const FopdtMatrix& model, double sample_time_min) {
  double longest = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const double delay = delaySamples(model, i, sample_time_min);
    if (delay < 0.0)
      return "output " + std::to_string(i + 1) + " answers the other input " +
             exactText(-delay * sample_time_min) +
             " min before its own: decoupling it would need the future of that input (pair the "
             "loops the other way or delay the other input)";
    longest = std::max(longest, delay);
  }
  if (longest < 1.0)
    return "both cross dead times exceed the direct ones by less than a sample: each input would "
           "wait for the other (take a shorter sample time)";
  return "";
}

InvertedDecoupling::InvertedDecoupling(const FopdtMatrix& model, double sample_time_min) {
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      model[i][j].validate("model: element " + std::to_string(i + 1) + std::to_string(j + 1) +
                           ": ");
  const std::string reason = refusal(model, sample_time_min);
  require(reason.empty(), "decoupling", "elements that can be decoupled: " + reason);
  for (std::size_t i = 0; i < 2; ++i) {
    Path& path = paths_[i];
    path.a_own = std::exp(-sample_time_min / model[i][i].time_constant);
    path.a_cross = std::exp(-sample_time_min / model[i][1 - i].time_constant);
    path.scale = (1.0 - path.a_cross) / (1.0 - path.a_own);
    path.ratio = model[i][1 - i].gain / model[i][i].gain;
    const double delay = delaySamples(model, i, sample_time_min);
    path.whole = static_cast<int>(std::floor(delay));
    path.fraction = delay - path.whole;
    path.past.assign(static_cast<std::size_t>(path.whole) + 3, 0.0);
  }
}

/// v(k - whole - more), where v(k) is `present`.
double InvertedDecoupling::Path::delayed(double present, int more) const {
  const std::size_t lag = static_cast<std::size_t>(whole) + static_cast<std::size_t>(more);
  if (lag == 0) return present;
  return past[(next + past.size() - lag) % past.size()];
}

double InvertedDecoupling::Path::at(double present) const {
  const auto value = [&](int more) {
    const double newer = delayed(present, more);
    return fraction > 0.0 ? newer + fraction * (delayed(present, more + 1) - newer) : newer;
  };
  return a_cross * filtered + scale * (value(0) - a_own * value(1));
}

void InvertedDecoupling::rest(double input_1, double input_2) {
  const std::array<double, 2> other{input_2, input_1};
  for (std::size_t i = 0; i < 2; ++i) {
    std::fill(paths_[i].past.begin(), paths_[i].past.end(), other[i]);
    paths_[i].filtered = other[i];
  }
}

void InvertedDecoupling::record(double input_1, double input_2) {
  const std::array<double, 2> other{input_2, input_1};
  for (std::size_t i = 0; i < 2; ++i) {
    Path& path = paths_[i];
    path.filtered = path.at(other[i]);  // at k-1, whose input is now known
    path.past[path.next] = other[i];
    path.next = (path.next + 1) % path.past.size();
  }
}

void InvertedDecoupling::setGains(const std::array<std::array<double, 2>, 2>& gains) {
  for (std::size_t i = 0; i < 2; ++i) paths_[i].ratio = gains[i][1 - i] / gains[i][i];
}

std::array<double, 2> InvertedDecoupling::apply(const std::array<double, 2>& asked) {
  std::array<double, 2> input = asked;
  const std::size_t first = paths_[0].whole >= 1 ? 0 : 1;  // the one that does not wait
  for (const std::size_t i : {first, 1 - first}) {
    cross_[i] = paths_[i].ratio * paths_[i].at(input[1 - i]);
    input[i] = asked[i] - cross_[i];
  }
  return input;
}

}  // namespace fpc
