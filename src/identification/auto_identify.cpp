#include "identification/auto_identify.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "identification/auto_coupling.hpp"
#include "identification/auto_verdict.hpp"
#include "identification/record_remarks.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kFewestRows = 60;
constexpr double kTogether = 0.15;  // of the work, for outputs that depend on each other

void checkParams(const DataSet& data, const AutoParams& p) {
  require(p.work > 0.0, "work", "a number > 0");
  require(p.budget_s >= 0.0, "budget_s", "a number > 0, or 0 for none");
  require(p.blocks >= 2, "blocks", "at least 2");
  require(p.window >= 1, "window", "at least 1");
  require(p.longest_delay >= 0, "longest_delay", "0 (by the record) or more samples");
  require(p.known.empty() || p.known.size() == data.outputs.size(), "known", "one for each output");
  require(p.most_rows >= 200 && p.most_last >= p.most_rows, "most_rows", "200 <= it <= most_last");
  require(data.rows() >= kFewestRows, data.source,
          "at least " + std::to_string(kFewestRows) + " rows for --auto, got " +
              std::to_string(data.rows()));
  require(data.inputs.size() + data.disturbances.size() > 0, data.source,
          "at least one input or disturbance");
}

TsModel emptyModel(const DataSet& data) {
  TsModel model;
  model.name = "auto";
  model.source = "Identified from " + data.source +
                 " by search over structures, judged by free runs over held-out blocks.";
  model.sample_time_s = data.sample_time_s;
  model.outputs = data.outputs;
  model.inputs = data.inputs;
  model.disturbances = data.disturbances;
  for (const auto& repair : data.repairs) model.source += " " + repair + ".";
  return model;
}

SignalInfo& causeOf(DataSet& data, Index column) {
  const auto j = static_cast<std::size_t>(column) - data.outputs.size();
  return j < data.inputs.size() ? data.inputs[j] : data.disturbances[j - data.inputs.size()];
}

/// A signal at rest has a range as well, so that another value is told to lie outside.
void setRest(SignalInfo& signal, const Eigen::Ref<const Vector>& values) {
  if (std::isfinite(signal.lower) || std::isfinite(signal.upper)) return;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    const double margin = v != 0.0 ? 1e-6 * std::abs(v) : 1e-9;
    signal.lower = v - margin;
    signal.upper = v + margin;
    return;
  }
}

/// The same without outliers; what tells nothing is marked as constant, with a remark. Signals that
/// something is known of are kept; so are all if no other is left.
DataSet prepared(const DataSet& given, const AutoParams& params,
                 std::vector<std::string>& remarks) {
  DataSet data = withoutOutliers(given);
  const auto n_y = static_cast<Index>(data.outputs.size());
  const auto isKnown = [&](Index c) {
    const auto j = static_cast<std::size_t>(c - n_y);
    return std::any_of(params.known.begin(), params.known.end(), [j](const PriorKnowledge& k) {
      return (j < k.gain.size() && k.gain[j] != 0) || (j < k.monotone.size() && k.monotone[j] != 0);
    });
  };
  if (static_cast<Index>(data.constant.size()) != data.values.cols())
    data.constant.assign(static_cast<std::size_t>(data.values.cols()), false);
  for (Index c = n_y; c < data.values.cols(); ++c) setRest(causeOf(data, c), data.values.col(c));
  if (!params.keep_still)
    for (const Index c : stillCauses(data)) {
      if (isKnown(c) || data.constant[static_cast<std::size_t>(c)]) continue;
      data.constant[static_cast<std::size_t>(c)] = true;
      remarks.push_back(causeOf(data, c).name +
                        " is left out: so few moves cannot be told from a coincidence "
                        "(--keep-inputs keeps it)");
    }
  if (std::all_of(data.constant.begin() + n_y, data.constant.end(), [](bool c) { return c; }))
    data.constant.assign(data.constant.size(), false);
  return data;
}

/// The shortest reach that an output asks for; 0: none does.
Index commonReach(const DataSet& data, const AutoParams& params) {
  Index reach = 0;
  for (std::size_t i = 0; i < data.outputs.size(); ++i) {
    const Index own = reachOf(
        prepareAuto(data, static_cast<int>(i), params.blocks, params.most_rows, params.most_last));
    if (own > 0 && (reach == 0 || own < reach)) reach = own;
  }
  return reach;
}

/// The search over outputs on a record that is prepared.
AutoIdentification search(const DataSet& full, const AutoParams& given,
                          const AutoCallback& callback, AutoIdentification result) {
  const int windows = 2 * given.blocks;
  const bool thinned = full.rows() > given.most_last;
  const DataSet data = thinned ? subsample(full, given.most_last, windows) : full;
  if (thinned || full.rows() > given.most_rows)
    result.remarks.push_back("long record: the search uses " +
                             std::to_string(std::min(full.rows(), given.most_rows)) + " rows in " +
                             std::to_string(given.blocks) + " windows, the last fit " +
                             std::to_string(std::min(full.rows(), given.most_last)) + " of " +
                             std::to_string(full.rows()) + " rows");
  result.model = emptyModel(data);
  result.model.outputs = full.outputs;
  result.linear = result.model;
  result.linear.name += "_linear";
  const auto begin = Clock::now();
  const std::size_t n_y = data.outputs.size();
  AutoParams params = given;
  if (params.reach < 0) params.reach = commonReach(data, params);
  result.reach = params.reach;
  if (params.reach > 0) {
    params.states = false;  // their starts are estimated from rows that runs of this length lack
    result.remarks.insert(
        result.remarks.begin(),
        "a free run says nothing of this process (a pole at or beyond 1: it integrates or is "
        "unstable by itself): models are fitted and judged by runs of " +
            std::to_string(params.reach) + " samples, each from measured ones");
  }
  std::atomic<bool> stopped{false};
  std::mutex guard;
  WorkMeter meter;
  SearchLimits limits;
  limits.meter = &meter;
  limits.threads = params.threads;
  limits.window = params.window;
  limits.proceed = [&stopped] { return !stopped.load(); };
  const auto allow = [&](double share) {
    meter.limit = std::max(params.work * share * WorkMeter::kPerUnit,
                           meter.spent + 1.0);  // each output has its first linear models
    if (params.budget_s > 0.0)
      limits.deadline = begin + std::chrono::duration_cast<Clock::duration>(
                                    std::chrono::duration<double>(params.budget_s * share));
  };
  std::vector<SearchedOutput> alone;
  for (std::size_t i = 0; i < n_y; ++i) {
    allow(static_cast<double>(i + 1) / static_cast<double>(n_y) *
          (n_y > 1 ? 1.0 - kTogether : 1.0));
    limits.progress = [&](double part) {
      const std::lock_guard<std::mutex> lock(guard);
      const double done = (static_cast<double>(i) + part) / static_cast<double>(n_y);
      if (callback && !callback({data.outputs[i].name + ": structures", done})) stopped = true;
    };
    alone.push_back(searchOutput(data, static_cast<int>(i), params, limits, result));
  }
  allow(1.0);
  limits.progress = {};
  coupleOutputs(alone, limits, result);
  result.work = meter.spent / WorkMeter::kPerUnit;
  if (result.state.outputs.size() != n_y) {  // a file holds states of all outputs or of none
    result.state.outputs.clear();
    for (auto& found : result.outputs) found.state = found.blend = {};
  }
  for (std::size_t i = 0; i < n_y; ++i) {
    decide(result.outputs[i]);
    if (!result.outputs[i].fuzzy_model) result.model.submodels[i] = result.linear.submodels[i];
  }
  result.cancelled = stopped;
  result.model.validate();
  result.linear.validate();
  result.state.validate(result.model);
  return result;
}

}  // namespace

const std::string& name(ModelKind kind) {
  static const std::vector<std::string> names{"linear", "regressors", "state", "blend"};
  return names.at(static_cast<std::size_t>(kind));
}

AutoIdentification autoIdentify(const DataSet& data, const AutoParams& params,
                                const AutoCallback& callback) {
  checkParams(data, params);
  AutoIdentification result;
  ReadRows read = readRows(data, params.rows);
  result.remarks = std::move(read.remarks);
  result.same_row = std::move(read.same);
  result.remarks.insert(result.remarks.end(), data.repairs.begin(), data.repairs.end());
  const DataSet clean = prepared(asRead(data, result.same_row), params, result.remarks);
  return search(clean, params, callback, std::move(result));
}

}  // namespace fpc
