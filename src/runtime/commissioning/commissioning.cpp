#include "runtime/commissioning/commissioning.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include "base/files.hpp"
#include "base/finite_json.hpp"
#include "base/text_hash.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/commissioning/bench.hpp"
#include "runtime/commissioning/design.hpp"
#include "runtime/commissioning/plant_test.hpp"
#include "runtime/commissioning/process_models.hpp"
#include "runtime/commissioning/watch.hpp"

namespace fpc {
namespace {

using Eigen::Index;
namespace fs = std::filesystem;
using Stage = CommissioningStage;

constexpr double kWatchShare = 0.1;  // of the plant time
constexpr std::uint32_t kFewestWatched = 60, kMostWatched = 400;

const char kFingerprint[] = "fingerprint";

std::uint32_t watchedSamples(const CommissioningBrief& brief) {
  const auto share = static_cast<std::uint32_t>(kWatchShare * brief.samples());
  return std::clamp(share, std::min(kFewestWatched, brief.samples() / 2), kMostWatched);
}

OrderedJson byName(const std::vector<SignalInfo>& signals, const Vector& values) {
  OrderedJson json = OrderedJson::object();
  for (std::size_t i = 0; i < signals.size(); ++i)
    json[signals[i].name] = numberOrNull(values[static_cast<Index>(i)]);
  return json;
}

/// Rows of the plant under its present control.
PlantRecord watchedRows(StagedPlant& plant, const CommissioningBrief& brief) {
  PlantRecord record(brief.loop.plant_info);
  for (std::uint32_t k = 0; k < watchedSamples(brief); ++k) {
    const StagedPlant::Sample& sample = plant.next();
    record.add(sample.now, plant.send(sample.present));
  }
  return record;
}

}  // namespace

Stage commissioningStage(const std::string& word, const std::string& field) {
  const auto words = wordsOf(Stage{});
  const auto at = std::find(words.begin(), words.end(), word);
  require(at != words.end(), field, "one of " + join(words));
  return static_cast<Stage>(at - words.begin());
}

Commissioning::Commissioning(const std::string& brief, std::string folder,
                             CommissioningOptions options)
    : brief_(readBrief(brief, options.running)),
      folder_(fs::absolute(folder).lexically_normal().string()),
      options_(std::move(options)) {
  makeFolder(folder_);
}

std::string Commissioning::file(Stage stage) const {
  return inFolder(folder_, wordOf(stage) + ".json");
}
std::string Commissioning::lawFile() const {
  return inFolder(folder_, brief_.loop.name + "_law.yaml");
}
std::string Commissioning::piFile() const {
  return inFolder(folder_, brief_.loop.name + "_pi.yaml");
}

/// Of what the stage is made from: the brief, the loop, and the options of it and those before it.
std::string Commissioning::fingerprint(Stage stage) const {
  std::string from = brief_.text + brief_.loop.resolved;
  if (stage > Stage::kModel) from += " evaluations " + std::to_string(options_.evaluations);
  if (stage >= Stage::kModel) from += " members " + std::to_string(options_.members);
  return textHash(from);
}

OrderedJson Commissioning::figures(Stage stage) const {
  std::ifstream stream(file(stage));
  if (!stream) return nullptr;
  const OrderedJson json = OrderedJson::parse(stream, nullptr, false);
  if (json.is_discarded() || !json.is_object() ||
      json.value(kFingerprint, "") != fingerprint(stage))
    return nullptr;
  return json;
}

OrderedJson Commissioning::figures() const {
  OrderedJson all = OrderedJson::object();
  for (int s = 0; s < kCommissioningStages; ++s) {
    const auto stage = static_cast<Stage>(s);
    all[wordOf(stage)] = done(stage) ? figures(stage) : OrderedJson(nullptr);
  }
  return all;
}

bool Commissioning::done(Stage stage) const {
  for (int s = 0; s <= static_cast<int>(stage); ++s)
    if (figures(static_cast<Stage>(s)).is_null()) return false;
  return true;
}

void Commissioning::finish(Stage stage, OrderedJson figures) {
  figures[kFingerprint] = fingerprint(stage);
  writeText(figures.dump(2) + "\n", file(stage));
}

void Commissioning::show(Stage stage, const std::string& text) const {
  if (options_.show) options_.show(stage, text);
}

void Commissioning::undo(Stage first) {
  for (int s = kCommissioningStages - 1; s >= static_cast<int>(first); --s) {
    std::error_code none;
    fs::remove(file(static_cast<Stage>(s)), none);
  }
}

void Commissioning::run(Stage last) {
  for (int s = 0; s <= static_cast<int>(last); ++s) {
    const auto stage = static_cast<Stage>(s);
    if (done(stage)) continue;
    undo(stage);
    switch (stage) {
      case Stage::kBrief:
        finish(stage, state());
        break;
      case Stage::kWatch:
        finish(stage, watchPlant());
        break;
      case Stage::kTest:
        finish(stage, testPlant());
        break;
      case Stage::kModel:
        finish(stage, findModel());
        break;
      case Stage::kDesign:
        finish(stage, design());
        break;
    }
  }
}

OrderedJson Commissioning::state() const {
  writeText(brief_.text, inFolder(folder_, "brief.yaml"));
  const PlantInfo& plant = brief_.loop.plant_info;
  OrderedJson held = OrderedJson::array();
  for (std::size_t i = 0; i < plant.outputs.size(); ++i)
    if (brief_.held[i]) held.push_back(plant.outputs[i].name);
  return {{"loop", brief_.loop.name},
          {"brief", brief_.file},
          {"present_control", brief_.closed ? "closed" : "open"},
          {"samples", brief_.samples()},
          {"lower", byName(plant.outputs, brief_.lower)},
          {"upper", byName(plant.outputs, brief_.upper)},
          {"hold", byName(plant.outputs, brief_.hold)},
          {"held", held},
          {"moves", byName(plant.inputs, brief_.move)}};
}

/// The plant that lives, or the simulated one from its start on.
template <typename Use>
void Commissioning::withPlant(Use use) const {
  if (options_.alive) return use(*options_.alive);
  Bench bench(brief_);
  use(bench);
}

OrderedJson Commissioning::watchPlant() {
  const std::uint32_t samples = watchedSamples(brief_);
  show(Stage::kWatch, std::to_string(samples) + " samples under the present control");
  PlantRecord record;
  withPlant([&](StagedPlant& plant) { record = watchedRows(plant, brief_); });
  watched_ = record;
  record.write(inFolder(folder_, "watch.csv"));
  OrderedJson json = toJson(watch(record));
  json["samples"] = samples;
  return json;
}

OrderedJson Commissioning::testPlant() {
  const Watched watched = watchedOf(figures(Stage::kWatch));
  require(!watched.grave, folder_ + ": watch",
          "instruments that can be trusted: " + join(watched.remarks, "; "));
  const ActuatorParams& actuator = brief_.loop.simulation.actuator;
  PlantTestParams params;
  params.limits = actuator.limits;
  params.limits.move = brief_.move;
  params.lower = brief_.lower;
  params.upper = brief_.upper;
  const auto n_y = countOf(watched.outputs);
  params.hold.resize(n_y);
  params.noise.resize(n_y);
  params.deviation.resize(n_y);
  for (Index i = 0; i < n_y; ++i) {
    const WatchedOutput& y = watched.outputs[static_cast<std::size_t>(i)];
    params.hold[i] = y.mean;
    params.noise[i] = y.noise;
    params.deviation[i] = y.settled ? y.deviation : y.noise;
    require(y.mean > brief_.lower[i] && y.mean < brief_.upper[i], folder_ + ": watch: " + y.name,
            "an output inside its limits before it is tested, got a mean of " + shortText(y.mean));
  }
  params.start_input = actuator.initial;
  params.closed = brief_.closed;
  params.seed = brief_.seed;
  params.most_rows = static_cast<Index>(brief_.samples() - watchedSamples(brief_));
  std::optional<PlantTest> tested;
  Vector lowest = Vector::Constant(n_y, 1e300), highest = -lowest;
  withPlant([&](StagedPlant& plant) {
    // A simulated plant's life begins at its start: what was watched is played again.
    PlantRecord watched_rows = options_.alive ? watched_ : watchedRows(plant, brief_);
    if (watched_rows.rows() == 0) watched_rows = PlantRecord(brief_.loop.plant_info);
    while (!tested || tested->end() == TestEnd::kNone) {
      const StagedPlant::Sample& sample = plant.next();
      if (!tested) {
        if (watched_rows.rows() == 0) params.start_input = sample.now.input_applied;
        tested.emplace(params, std::move(watched_rows));
      }
      for (Index i = 0; i < n_y; ++i) {
        const double y = plant.trueOutputs()[i];
        if (std::isfinite(y)) lowest[i] = std::min(lowest[i], y);
        if (std::isfinite(y)) highest[i] = std::max(highest[i], y);
      }
      const Vector sent = sample.sent.size() > 0
                              ? sample.sent
                              : plant.send(tested->choose(sample.now, sample.present));
      const bool first_fit = tested->fits().empty();
      tested->add(sample.now, sent);
      if (tested->rows() % 200 == 0 || (first_fit && !tested->fits().empty()))
        show(Stage::kTest, std::to_string(tested->rows()) + " samples, settling " +
                               shortText(tested->settling()) + " s");
    }
    plant.release();
  });
  const PlantTest& test = *tested;
  test.record().write(inFolder(folder_, "test.csv"));
  const PlantInfo& plant = brief_.loop.plant_info;
  const double Ts = plant.sample_time_s;
  std::uint64_t left = 0;  // limits, on the plant's own outputs
  for (Index i = 0; i < n_y; ++i)
    left += lowest[i] < brief_.lower[i] || highest[i] > brief_.upper[i] ? 1 : 0;
  OrderedJson bounds = OrderedJson::array();
  for (std::size_t i = 0; i < test.fits().size(); ++i)
    for (std::size_t j = 0; j < plant.inputs.size(); ++j) {
      const ElementEstimate& e = test.fits()[i].elements[j];
      bounds.push_back({{"output", plant.outputs[i].name},
                        {"input", plant.inputs[j].name},
                        {"gain", e.element.gain},
                        {"gain_bound", numberOrNull(e.gain_bound)},
                        {"dead_time_s", e.element.dead_time},
                        {"dead_time_bound_s", e.dead_time_bound}});
    }
  OrderedJson json = {
      {"ended", wordOf(test.end())},
      {"reason", test.reason()},
      {"samples", test.rows()},
      {"listened", test.listened()},
      {"hours", static_cast<double>(test.rows()) * Ts / 3600.0},
      {"settling_s", test.settling()},
      {"settling_times", test.settling() > 0.0
                             ? OrderedJson(static_cast<double>(test.rows()) * Ts / test.settling())
                             : OrderedJson(nullptr)},
      {"amplitude", byName(plant.inputs, test.amplitude())},
      {"turned", test.turned()},
      {"lowest", byName(plant.outputs, lowest)},
      {"highest", byName(plant.outputs, highest)},
      {"limits_left", left},
      {"bounds", bounds}};
  require(test.end() != TestEnd::kNeedsLoop, folder_ + ": test",
          "a plant that stays where it is, or a control: " + test.reason());
  return json;
}

OrderedJson Commissioning::findModel() {
  const PlantRecord record =
      PlantRecord::read(inFolder(folder_, "test.csv"), brief_.loop.plant_info);
  show(Stage::kModel, std::to_string(record.rows()) + " rows");
  const ProcessModels models =
      findModels(brief_, record, options_.members,
                 [this](const ProcessModels& found) { return presentHolds(brief_, found); });
  writeModels(models, folder_);
  return toJson(models, brief_.loop.plant_info);
}

OrderedJson Commissioning::design() {
  const Watched watched = watchedOf(figures(Stage::kWatch));
  Vector noise(countOf(watched.outputs)), rounding = noise;
  for (Index i = 0; i < noise.size(); ++i) {
    const WatchedOutput& y = watched.outputs[static_cast<std::size_t>(i)];
    noise[i] = y.noise;
    rounding[i] = y.resolution / std::sqrt(12.0);
  }
  ProcessModels models = readModels(folder_);
  takeNoiseInOperation(PlantRecord::read(inFolder(folder_, "watch.csv"), brief_.loop.plant_info),
                       watched.first, rounding, models);
  DesignParams params;
  params.evaluations = options_.evaluations;
  params.threads = options_.threads;
  params.seed = brief_.seed;
  params.show = [this](const std::string& text) { show(Stage::kDesign, text); };
  const Design result = designLaws(brief_, noise, inFolder(folder_, "model.yaml"), models, params);
  writeText(result.law, lawFile());
  writeText(result.pi, piFile());
  OrderedJson json = toJson(result, brief_.loop.plant_info);
  json["offered"] = result.offers_law ? lawFile() : result.offers_pi ? piFile() : "none";
  return json;
}

}  // namespace fpc
