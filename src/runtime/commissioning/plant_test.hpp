// Stage 3: an experiment that is designed while it runs. All inputs switch at random times between
// two levels around what the present control asks, each by itself (generalised binary noise,
// tulleken1990): how long a level is held follows the settling time known so far, its height the
// noise and the operator's limits. A step that is predicted to lead an output out of its limits is
// turned before it happens.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "fmbpc/base/input_limits.hpp"
#include "identification/process_fit.hpp"
#include "runtime/commissioning/plant_record.hpp"

namespace fpc {

struct PlantTestParams {
  InputLimits limits;        ///< of the inputs
  Vector lower, upper;       ///< n_y, that no output may leave
  Vector hold;               ///< n_y, where outputs are
  Vector noise, deviation;   ///< n_y, as watched
  Vector start_input;        ///< n_u
  bool closed{};             ///< levels are added to a control that stays in charge
  Eigen::Index most_rows{};  ///< of the test
  double gain_tolerance{
      0.15};  ///< of the largest gain of an output, inputs in parts of their ranges
  std::uint64_t seed{1};
};

enum class TestEnd {
  kNone,      ///< goes on
  kEnough,    ///< the bounds asked for are reached
  kTime,      ///< the plant time is used up
  kNeedsLoop  ///< the plant is unstable or integrates, and no control holds it
};
const char* wordOf(TestEnd end);

/// Sees a plant sample by sample, in whatever process: choose(), then add(). A new model is fitted
/// now and then within add(), which then takes longer.
class PlantTest {
 public:
  /// `watched`: the record until now, with which the fits begin. @throws InputError on sizes.
  PlantTest(PlantTestParams params, PlantRecord watched);
  /// What is to be sent at this sample; `present`: what the control in charge asks, or the start
  /// input.
  const Vector& choose(const Measurement& now, const Vector& present);
  /// What was sent at this sample, the choice or, where that came too late, something else.
  void add(const Measurement& now, VectorRef sent);
  TestEnd end() const { return end_; }
  const std::string& reason() const { return reason_; }
  const PlantRecord& record() const { return record_; }
  const std::vector<ProcessFit>& fits() const { return fits_; }  ///< one per output, or none yet
  std::uint64_t turned() const { return turned_; }  ///< steps that were turned or left out
  const Vector& amplitude() const { return amplitude_; }
  double settling() const { return settling_; }  ///< [s], of what is known; 0: nothing
  Eigen::Index rows() const { return record_.rows() - watched_rows_; }
  /// Rows at the end in which inputs were no longer tested: a measured disturbance had not moved.
  Eigen::Index listened() const { return tested_ > 0 ? rows() - tested_ : 0; }

 private:
  void know();
  void judge();
  bool knowsDisturbances() const;
  bool needsLoop(const ProcessFit& fit) const;
  void setAmplitudes();
  Vector excess(const std::vector<int>& levels) const;
  void leaveUnsure(std::vector<int>& levels) const;
  void follow();
  void predict(const Vector& present);
  bool nearLimitUnknown() const;
  double effect(const ElementEstimate& e) const;
  Vector sent(const std::vector<int>& levels, const Vector& present, VectorRef previous) const;

  PlantTestParams params_;
  PlantRecord record_;
  Eigen::Index watched_rows_{}, next_fit_{}, n_y_{}, n_u_{};
  Eigen::Index tested_{}, last_row_{};  // rows() when the inputs were known, and of the end
  std::vector<ProcessFit> fits_;
  struct Track {  // of one element: its response so far
    bool seen{false};
    SampledElement sampled;
    std::vector<double> a;  // whole denominator
    std::vector<double> w;
    double margin{};  // bound of its gain, in parts of it
    double rest{};    // of the input
    /// w(k), behind w(k - 1) and those before it, of which `before` has the last ones; input(k):
    /// from `rest`.
    template <typename Input>
    double next(Eigen::Index k, const std::vector<double>& before, const Input& input) const;
  };
  std::vector<Track> tracks_;  // [output * n_u + input]
  std::vector<Matrix> ahead_;  // [input * 3 + level + 1]: n_y H changes
  Vector amplitude_, span_, sent_, last_output_, room_;
  std::vector<int> level_, left_;
  std::mt19937_64 engine_;
  std::uint64_t turned_{};
  double settling_{}, dead_time_{};  // [s], longest of what is known
  int enough_{}, unheld_{};          // fits in a row that say so
  TestEnd end_{TestEnd::kNone};
  std::string reason_;
};

}  // namespace fpc
