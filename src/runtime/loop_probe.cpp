#include "runtime/loop_probe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "config/disturbance_source.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "runtime/factory.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kApproach = 500;     // samples of the course before the point
constexpr Index kMostToRest = 3000;  // after it
constexpr Index kWindow = 50;        // in which a loop at rest does not move
constexpr double kRest = 1e-7;       // of the ranges
constexpr double kSwing = 1e-3;      // of the ranges: no rest ...
constexpr double kStays = 0.9;       // ... that does not shrink by so much in 750 samples
constexpr double kPulse = 1e-3;      // of an input's range
constexpr double kAtLimit = 1e-6;    // likewise
constexpr double kBend = 0.2;        // of the response that is not odd in the pulse
constexpr Index kFirstResponse = 400, kLongestResponse = 6400;

double rangeOf(double lower, double upper) {
  const double range = upper - lower;
  return std::isfinite(range) && range > 0.0 ? range : 1.0;
}

Vector rangesOf(const std::vector<SignalInfo>& signals) {
  Vector ranges(countOf(signals));
  for (std::size_t i = 0; i < signals.size(); ++i)
    ranges[static_cast<Index>(i)] = rangeOf(signals[i].lower, signals[i].upper);
  return ranges;
}

/// The members of the loop, called as in a run; what they ask for may be displaced on its way to
/// the plant without their knowledge.
class ProbedLoop {
 public:
  explicit ProbedLoop(const LoopFile& loop)
      : simulation_(loop.simulation), controller_(makeControllerSession(loop)) {
    if (loop.targets.enabled) layer_.emplace(makeTargetSession(loop));
    if (loop.has_clp) optimizer_.emplace(makeOptimizerSession(loop));
    controller_.announce(1);
    if (layer_) {
      layer_->announce(1);
      layer_->setModel(loop.model);
    }
    if (optimizer_) optimizer_->announce(1);
    if (controller_.controller().needsModel()) controller_.setModel(loop.model);
    displaced_ = Vector::Zero(loop.simulation.actuator.initial.size());
  }

  /// Answers a sample; `pulse` is added to what goes to the plant. False if the plant fails.
  bool step(const Vector& pulse) {
    Measurement now = simulation_.measurement();
    now.input_applied -= displaced_;
    if (layer_ && layer_->receive(now) == Receipt::kAnswered) controller_.aim(layer_->answer());
    controller_.receive(now);
    command_ = optimizer_ ? optimized(controller_.answer()) : controller_.answer().base.input;
    displaced_ = pulse;
    simulation_.advance(command_ + pulse);
    return simulation_.state().trouble.empty() && command_.allFinite();
  }
  const Vector& command() const { return command_; }
  const Measurement& measurement() const { return simulation_.measurement(); }
  const std::string& trouble() const { return simulation_.state().trouble; }

 private:
  const Vector& optimized(const ControllerAnswer& answer) {
    if (answer.has_prediction) optimizer_->receive(answer.prediction);
    optimizer_->receive(answer.base);
    return optimizer_->action().input;
  }

  Simulation simulation_;
  ControllerSession controller_;
  std::optional<TargetSession> layer_;
  std::optional<OptimizerSession> optimizer_;
  Vector command_, displaced_;
};

/// A pulse of this size at one sample; none by default.
struct Pulse {
  Index at{-1};
  Vector size{};
};

/// A loop played from its start on, as far as it is asked.
class Played {
 public:
  Played(const LoopFile& loop, Pulse pulse)
      : probed_(loop),
        pulse_(std::move(pulse)),
        none_(Vector::Zero(loop.simulation.actuator.initial.size())) {}

  /// False if the plant fails on the way: trouble().
  bool to(Index samples, const LoopFile& loop) {
    const Index known = inputs_.cols();
    if (samples <= known) return trouble_.empty();
    inputs_.conservativeResize(none_.size(), samples);
    outputs_.conservativeResize(countOf(loop.plant_info.outputs), samples);
    for (Index k = known; k < samples && trouble_.empty(); ++k) {
      outputs_.col(k) = probed_.measurement().outputs;
      const bool moved = probed_.step(k == pulse_.at ? pulse_.size : none_);
      inputs_.col(k) = probed_.command();
      if (!moved)
        trouble_ = probed_.trouble().empty() ? "an input is not finite" : probed_.trouble();
    }
    return trouble_.empty();
  }
  const Matrix& inputs() const { return inputs_; }    ///< n_u, a column a sample
  const Matrix& outputs() const { return outputs_; }  ///< n_y
  const std::string& trouble() const { return trouble_; }

 private:
  ProbedLoop probed_;
  Pulse pulse_;
  Vector none_;
  Matrix inputs_, outputs_;
  std::string trouble_;
};

/// Largest less smallest value of each row, of the ranges.
double moveOf(const Matrix& values, const Vector& ranges, Index from, Index count) {
  const Matrix part = values.middleCols(from, count);
  return ((part.rowwise().maxCoeff() - part.rowwise().minCoeff()).array() / ranges.array())
      .maxCoeff();
}

/// Mean time between two crossings of the mean in the same direction.
double periodOf(const Matrix& values, Index from, Index count, double sample_time) {
  Index row = 0;
  const Matrix part = values.middleCols(from, count);
  (part.rowwise().maxCoeff() - part.rowwise().minCoeff()).maxCoeff(&row);
  const double mean = part.row(row).mean();
  Index first = -1, last = -1, crossings = 0;
  for (Index k = 1; k < count; ++k) {
    if (!(part(row, k - 1) <= mean && part(row, k) > mean)) continue;
    if (first < 0) first = k;
    last = k;
    ++crossings;
  }
  return crossings < 2
             ? 0.0
             : static_cast<double>(last - first) / static_cast<double>(crossings - 1) * sample_time;
}

class Probing {
 public:
  Probing(const LoopFile& loop, const CoursePoint& point)
      : loop_(loop),
        limits_(loop.simulation.actuator.limits),
        y_range_(rangesOf(loop.plant_info.outputs)),
        start_(std::min<Index>(point.step, kApproach)),
        base_(loop, {}) {
    found_.point = point;
    u_range_.resize(limits_.lower.size());
    for (Index i = 0; i < u_range_.size(); ++i)
      u_range_[i] = rangeOf(limits_.lower[i], limits_.upper[i]);
  }

  LoopProbe run() {
    if (!settle()) return std::move(found_);
    takeRest();
    const auto& held = found_.at_limit;
    if (std::all_of(held.begin(), held.end(), [](bool b) { return b; })) {
      found_.result = ProbeResult::kHeld;
      return std::move(found_);
    }
    sendPulses();
    for (Index n = kFirstResponse; respond(n); n *= 2) {
      const PulseResponse& response = *found_.response;
      if (!response.hasDecayed() && 2 * n <= kLongestResponse) continue;
      found_.growth = response.growth();
      found_.result = !response.hasDecayed() && found_.growth > 1.0 ? ProbeResult::kGrows
                                                                    : ProbeResult::kLinear;
      break;
    }
    return std::move(found_);
  }

 private:
  /// Finds the sample at which the loop rests.
  bool settle() {
    for (rest_ = start_ + kWindow; rest_ <= start_ + kMostToRest; rest_ += kWindow) {
      if (!base_.to(rest_ + 1, loop_)) return fail(base_.trouble());
      if (moveOf(base_.inputs(), u_range_, rest_ - kWindow, kWindow) < kRest &&
          moveOf(base_.outputs(), y_range_, rest_ - kWindow, kWindow) < kRest)
        return true;
    }
    rest_ = start_ + kMostToRest;
    const Index quarter = kMostToRest / 4, end = base_.inputs().cols();
    const double before = moveOf(base_.inputs(), u_range_, end - 2 * quarter, quarter),
                 after = moveOf(base_.inputs(), u_range_, end - quarter, quarter);
    if (after < kSwing || after < kStays * before) return true;  // it creeps
    const Matrix last = base_.inputs().rightCols(quarter);
    found_.result = ProbeResult::kSwings;
    takeRest();
    found_.swing = last.rowwise().maxCoeff() - last.rowwise().minCoeff();
    found_.period_s =
        periodOf(base_.inputs(), end - quarter, quarter, loop_.plant_info.sample_time_s);
    return false;
  }

  void takeRest() {
    found_.input = base_.inputs().col(rest_);
    found_.outputs = base_.outputs().col(rest_);
    for (Index i = 0; i < u_range_.size(); ++i)
      found_.at_limit.push_back(found_.input[i] <= limits_.lower[i] + kAtLimit * u_range_[i] ||
                                found_.input[i] >= limits_.upper[i] - kAtLimit * u_range_[i]);
  }

  /// One up and one down at each input that has room.
  void sendPulses() {
    for (Index j = 0; j < u_range_.size(); ++j) {
      double size = kPulse * u_range_[j];
      if (std::isfinite(limits_.move[j])) size = std::min(size, 0.1 * limits_.move[j]);
      if (found_.at_limit[static_cast<std::size_t>(j)]) size = 0.0;
      Pulse pulse{rest_, Vector::Zero(u_range_.size())};
      pulse.size[j] = size;
      up_.emplace_back(loop_, pulse);
      pulse.size[j] = -size;
      down_.emplace_back(loop_, pulse);
      sizes_.push_back(size);
    }
  }

  /// Half the difference of a pulse and its opposite, in parts of the pulse: inputs in parts of
  /// their ranges, or a unit would change the singular values.
  bool respond(Index n) {
    const Index samples = rest_ + n, n_u = u_range_.size();
    if (!base_.to(samples, loop_)) return fail(base_.trouble());
    std::vector<Matrix> reached;
    for (Index j = 0; j < n_u; ++j) {
      const auto at = static_cast<std::size_t>(j);
      Matrix response = Matrix::Zero(n_u, n);
      if (sizes_[at] > 0.0) {
        Played &up = up_[at], &down = down_[at];
        if (!up.to(samples, loop_)) return fail(up.trouble());
        if (!down.to(samples, loop_)) return fail(down.trouble());
        const auto parts = u_range_.cwiseInverse().asDiagonal();
        const Matrix odd = parts * (up.inputs() - down.inputs()).rightCols(n),
                     even =
                         parts * (up.inputs() + down.inputs() - 2.0 * base_.inputs()).rightCols(n);
        if (even.cwiseAbs().maxCoeff() > kBend * odd.cwiseAbs().maxCoeff()) {
          found_.result = ProbeResult::kBends;
          return false;
        }
        response = odd * (u_range_[j] / (2.0 * sizes_[at]));
      }
      response(j, 0) += 1.0;
      reached.push_back(std::move(response));
    }
    found_.response.emplace(std::move(reached), loop_.plant_info.sample_time_s);
    return true;
  }

  bool fail(const std::string& words) {
    found_.result = ProbeResult::kFailed;
    found_.words = words;
    return false;
  }

  const LoopFile& loop_;
  const InputLimits& limits_;
  Vector y_range_, u_range_;
  Index start_, rest_{};
  Played base_;
  std::vector<Played> up_, down_;  // of each input
  std::vector<double> sizes_;
  LoopProbe found_;
};

/// Parts of the values' spread over the course; what never changes does not count.
Matrix scaled(const Matrix& values) {
  Matrix parts = values;
  for (Index i = 0; i < values.rows(); ++i) {
    const double low = values.row(i).minCoeff(), high = values.row(i).maxCoeff();
    if (high > low)
      parts.row(i) = (values.row(i).array() - low) / (high - low);
    else
      parts.row(i).setZero();
  }
  return parts;
}

}  // namespace

LoopCourse::LoopCourse(const LoopFile& loop) : sample_time_(loop.plant_info.sample_time_s) {
  requireSimulated(loop);
  const auto samples = static_cast<Index>(loop.simulation.samples);
  require(samples > 0, loop.name + ": sampling.duration_h", "a time > 0: a course that ends");
  const SampleClock clock(sample_time_, loop.simulation.start_time_s);
  SetpointSource setpoint(loop.setpoint, namesOf(loop.plant_info.outputs), clock);
  const DisturbanceRecord record = makeDisturbance(loop);
  const std::vector<Quantity> about = disturbancesOf(loop);
  std::vector<std::string> names;
  for (const Quantity& q : about) names.push_back(q.name);
  for (const auto& u : loop.plant_info.inputs) names.push_back("input/" + u.name);
  for (const auto& y : loop.plant_info.outputs) names.push_back("output/" + y.name);
  CommandTable commands(names);
  for (const auto& [time_h, command] : loop.simulation.disturbance_commands)
    commands.accept(command, clock.firstStepAtHours(time_h));
  const auto n_d = static_cast<Index>(about.size());
  setpoints_.resize(countOf(loop.plant_info.outputs), samples);
  disturbances_.resize(n_d, samples);
  for (Index k = 0; k < samples; ++k) {
    setpoints_.col(k) = setpoint.advance(static_cast<std::uint32_t>(k));
    commands.advance(static_cast<std::uint32_t>(k));
    for (Index i = 0; i < n_d; ++i) {
      const Quantity& q = about[static_cast<std::size_t>(i)];
      const double value = record.values.size() > 0
                               ? record.values(i, std::min(k, record.values.cols() - 1))
                               : loop.simulation.disturbance_nominal[i];
      disturbances_(i, k) =
          std::clamp(commands.apply(static_cast<std::size_t>(i), value), q.lower, q.upper);
    }
  }
}

std::vector<CoursePoint> LoopCourse::points(int count) const {
  const Matrix y = scaled(setpoints_.array().isNaN().select(0.0, setpoints_)),
               d = scaled(disturbances_);
  Matrix z(y.rows() + d.rows(), y.cols());
  z << y, d;
  std::vector<Index> chosen;
  Index next = 0;
  (z.colwise() - z.rowwise().mean().eval()).colwise().squaredNorm().minCoeff(&next);
  Eigen::RowVectorXd far =
      Eigen::RowVectorXd::Constant(z.cols(), std::numeric_limits<double>::infinity());
  constexpr double kSame = 1e-6;
  while (static_cast<int>(chosen.size()) < count && (chosen.empty() || far[next] > kSame)) {
    chosen.push_back(next);
    far = far.cwiseMin((z.colwise() - z.col(next)).colwise().squaredNorm());
    far.maxCoeff(&next);
  }
  std::sort(chosen.begin(), chosen.end());
  std::vector<CoursePoint> points;
  for (const Index k : chosen)
    points.push_back({static_cast<std::uint32_t>(k), setpoints_.col(k), disturbances_.col(k)});
  return points;
}

LoopFile LoopCourse::stayingAt(const LoopFile& loop, const CoursePoint& point) const {
  LoopFile staying = loop;
  SimulationParams& sim = staying.simulation;
  const Index last = point.step, first = std::max<Index>(0, last - kApproach);
  sim.samples = 0;
  sim.noise_std.setZero();
  sim.disturbance_noise_std.setZero();
  sim.disturbance_commands.clear();
  for (DriveParams& drive : sim.actuator.drives) drive.backlash = drive.stiction = 0.0;
  for (auto& entry : sim.instruments.sensors) {
    SensorParams& sensor = entry.second;
    sensor.noise_std = sensor.resolution = sensor.lost = 0.0;
    sensor.stuck_from_h = std::numeric_limits<double>::infinity();
  }
  sim.disturbance.values = disturbances_.middleCols(first, last - first + 1);
  SetpointParams& asked = staying.setpoint;
  asked.commands.clear();
  asked.schedule.clear();
  asked.rate_per_h.setConstant(std::numeric_limits<double>::infinity());
  asked.initial = setpoints_.col(first);
  for (Index k = first + 1; k <= last; ++k)
    if (!(setpoints_.col(k) - setpoints_.col(k - 1)).isZero(0.0))
      asked.schedule.push_back(
          {static_cast<double>(k - first) * sample_time_ / 3600.0, setpoints_.col(k), 0.0});
  staying.plausibility.enabled = false;
  staying.standstill = {};
  return staying;
}

LoopProbe probeLoop(const LoopFile& staying, const CoursePoint& point) {
  return Probing(staying, point).run();
}

}  // namespace fpc
