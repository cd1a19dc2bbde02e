// What a loop has heard of the signals of other loops that stand for signals of its own: the same
// in one process and over topics.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "config/plant_loops.hpp"
#include "fmbpc/base/exchange.hpp"

namespace fpc {

/// In lockstep a source whose samples do not follow each other without a gap from its first one on
/// is never ready again: nothing may be made up. At time t a link has the value of its source's
/// latest sample that is not later than t. In lockstep that sample is waited for; otherwise the
/// latest that has come counts, whatever its time, and stays.
class LinkInbox {
 public:
  /// Keeps those links that are for the plant, or those that are for the controller.
  enum class Of { kPlant, kController };
  LinkInbox(const std::vector<LoopLink>& links, Of of, bool lockstep);

  bool empty() const { return sources_.empty(); }
  /// Who is to be heard: name of the loop, and what of it.
  std::set<std::pair<std::string, LoopLink::Of>> sources() const;
  /// A sample of loop `from`. values: column 0 are its outputs, its inputs as asked, or as planned,
  /// then column i those of i samples later. What is not finite or of wrong size changes no value.
  /// planned: of inputs as asked, whether they are its law's own (isLawsOwn()): only then is there
  /// a plan to wait for, and one that counts.
  void hear(const std::string& from, LoopLink::Of of, const StepHeader& sample,
            const Eigen::Ref<const Matrix>& values, bool planned = true);
  /// Lockstep: everything that is needed at this time has come. Otherwise always.
  bool ready(std::int64_t time_ns);
  /// Names of the loops that are waited for.
  std::vector<std::string> missing() const;
  /// Overrides of the disturbances, or of the setpoints, from the next sample on; none: no value
  /// has come.
  std::optional<Command> command(std::int64_t time_ns);
  /// Once for each plan that another law made at the sample before this one (not in lockstep: that
  /// came since the last call): of which disturbance, and what it will be from this sample on, as
  /// its link acts a sample later.
  void plans(std::int64_t time_ns, const std::function<void(const std::string&, VectorRef)>& take);
  /// Puts in what the plant's inputs are in truth: the outputs of inner loops.
  void replaceInputs(std::int64_t time_ns, const std::vector<SignalInfo>& inputs,
                     Eigen::Ref<Vector> input);
  /// Whether a person may command the signal: @throws InputError if it has a link.
  void refuseLinked(const Command& command) const;

 private:
  struct Item {
    std::int64_t time_ns;
    Vector values;            // of the time, and of the samples after it
    bool asked{}, planned{};  // of a plan: its action has come, and is the law's own
    bool whole() const { return asked && (!planned || values.size() > 0); }
  };
  struct Source {
    LoopLink link;
    std::uint64_t run_id{};
    std::deque<Item> items;  // in the order of time; none that is not needed any more
    std::int64_t newest_ns{};
    bool heard{}, gap{};
  };
  Vector rowOf(const LoopLink& link, const Eigen::Ref<const Matrix>& values) const;
  Item& itemOf(Source& source, const StepHeader& sample);
  void hearPlan(Source& source, LoopLink::Of of, const StepHeader& sample,
                const Eigen::Ref<const Matrix>& values, bool planned);
  bool has(const Source& source, std::int64_t time_ns) const;
  std::optional<double> valueAt(Source& source, std::int64_t time_ns) const;

  bool lockstep_;
  std::vector<Source> sources_;
  std::vector<std::string> missing_;
};

}  // namespace fpc
