#include "runtime/commissioning/process_models.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <optional>

#include "base/decompositions.hpp"
#include "base/files.hpp"
#include "base/finite_json.hpp"
#include "base/statistics.hpp"
#include "config/identified_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"

namespace fpc {
namespace {

using Eigen::Index;
namespace fs = std::filesystem;

constexpr double kWeak = 0.1;         // of the strongest direction's gain
constexpr double kFar = 1e3;          // of a curve's width: how far its ends reach
constexpr double kRare = 0.02;        // share of the values of a disturbance at either end
constexpr double kLostAtRest = 1e-4;  // of a denominator's value at rest

TsModel modelNames(const CommissioningBrief& brief) {
  const PlantInfo& plant = brief.loop.plant_info;
  TsModel names;
  names.name = brief.loop.name;
  names.source = "commissioning of " + brief.loop.name;
  names.sample_time_s = plant.sample_time_s;
  names.outputs = plant.outputs;
  names.inputs = plant.inputs;
  names.disturbances = plant.disturbances;
  // A model of lags is trusted as far as the operator lets the plant go.
  for (std::size_t i = 0; i < names.outputs.size(); ++i) {
    names.outputs[i].lower = brief.lower[static_cast<Index>(i)];
    names.outputs[i].upper = brief.upper[static_cast<Index>(i)];
  }
  return names;
}

/// As what moves the output most, without its dead time: loads come in where inputs do.
ProcessElement loadOf(const ProcessElement& strongest) {
  ProcessElement load = strongest;
  load.gain = strongest.integrating ? 1.0 / 3600.0 : 1.0;
  load.dead_time = load.lead = 0.0;
  return load;
}

/// Among the inputs that were seen, by its gain over the input's range.
std::size_t strongest(const ProcessFit& fit, const std::vector<SignalInfo>& inputs) {
  double most = -1.0;
  std::size_t found = 0;
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    const double range = inputs[j].upper - inputs[j].lower;
    const double effect =
        std::abs(fit.elements[j].element.gain) * (std::isfinite(range) ? range : 1.0);
    if (!fit.elements[j].seen || effect <= most) continue;
    most = effect;
    found = j;
  }
  return found;
}

/// It may take the output anywhere, within a sample where it integrates.
SignalInfo loadSignal(const SignalInfo& output, ProcessKind kind, double sample_time_s) {
  const bool integrating = kind == ProcessKind::kIntegrating;
  const double width = (output.upper - output.lower) * (integrating ? 3600.0 / sample_time_s : 1.0);
  return {loadName(output.name), output.unit + (integrating ? "/h" : ""), -width, width};
}

double sumOf(const std::vector<double>& polynomial) {
  return std::accumulate(polynomial.begin(), polynomial.end(), 0.0);
}

/// The common denominator of an output's elements keeps its value at rest: of many slow poles the
/// coefficients cancel to nothing but rounding.
bool isSound(const ProcessFit& fit, double sample_time_s,
             const std::vector<ProcessElement>& elements) {
  std::vector<double> all{1.0};
  double exact = 1.0;
  for (std::size_t j = 0; j < elements.size(); ++j) {
    if (!fit.elements[j].seen) continue;
    const std::vector<double> own = sampled(elements[j], sample_time_s).own;
    all = product(all, own);
    exact *= sumOf(own);
  }
  return std::abs(sumOf(all) - exact) < kLostAtRest * std::abs(exact);
}

/// Until it is: the shortest of two lags becomes dead time.
void dropLags(const ProcessFit& fit, double sample_time_s, std::vector<ProcessElement>& elements) {
  while (!isSound(fit, sample_time_s, elements)) {
    ProcessElement* least = nullptr;
    for (std::size_t j = 0; j < elements.size(); ++j) {
      ProcessElement& e = elements[j];
      const bool two = fit.elements[j].seen && !e.integrating && e.time_constant > 0.0 &&
                       e.second > 0.0 && e.damping >= 1.0 && e.lead == 0.0;
      if (two && (least == nullptr || e.second < least->second)) least = &e;
    }
    if (least == nullptr) return;
    if (least->second > least->time_constant) std::swap(least->second, least->time_constant);
    least->dead_time += least->second;
    least->second = 0.0;
  }
}

/// Two rules in the place of one, with other gains at either end of a curve; `change`: of this
/// model.
void bend(const GainCurve& curve, double change, int output, Index inputs, const LinearPoint& point,
          OutputModel& model) {
  Regressor along{SignalKind::kOutput, output, 0};
  if (curve.signal >= 0) {  // what acts first
    along = {SignalKind::kInput, static_cast<int>(curve.signal), std::numeric_limits<int>::max()};
    for (const Regressor& r : model.regressors)
      if (r.kind == along.kind && r.index == along.index) along.lag = std::min(along.lag, r.lag);
  }
  model.antecedents = {along};
  const Rule straight = model.rules.front();
  model.rules.clear();
  const double width = curve.upper - curve.lower, far = kFar * width;
  for (const bool upper : {false, true}) {
    Rule rule = straight;
    for (std::size_t k = 0; k < model.regressors.size(); ++k) {
      const Regressor& r = model.regressors[k];
      const Index element = r.kind == SignalKind::kInput ? r.index : inputs + r.index;
      if (r.kind == SignalKind::kOutput || element >= curve.factor.size()) continue;
      double& c = rule.coefficients[static_cast<Index>(k)];
      const double factor = curve.factorAt(element, upper, change);
      const double rest =
          r.kind == SignalKind::kInput ? point.inputs[r.index] : point.disturbances[r.index];
      rule.offset += (1.0 - factor) * c * rest;
      c *= factor;
    }
    rule.antecedents = {{MembershipShape::kTrapezoidal,
                         upper ? std::vector<double>{curve.lower, curve.upper, curve.upper + far,
                                                     curve.upper + 2.0 * far}
                               : std::vector<double>{curve.lower - 2.0 * far, curve.lower - far,
                                                     curve.lower, curve.upper}}};
    model.rules.push_back(std::move(rule));
  }
}

TsModel modelOf(TsModel names, const std::vector<ProcessFit>& fits, int member,
                const std::vector<bool>& loads) {
  std::vector<SampledLinearElement> all;
  const Index n_u = countOf(names.inputs);
  LinearPoint point = modelRest(fits, n_u);
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const ProcessFit& fit = fits[i];
    std::vector<ProcessElement> elements;
    for (std::size_t j = 0; j < fit.elements.size(); ++j)
      elements.push_back(member < 0 ? fit.elements[j].element
                                    : fit.ensemble[static_cast<std::size_t>(member)][j]);
    dropLags(fit, names.sample_time_s, elements);
    const std::size_t most = strongest(fit, names.inputs);
    int place = 0, poles = -1;
    for (std::size_t j = 0; j < fit.elements.size(); ++j) {
      if (!fit.elements[j].seen) continue;
      if (j == most) poles = place;
      ++place;
      const bool input = static_cast<Index>(j) < n_u;
      all.push_back({static_cast<int>(i), input ? SignalKind::kInput : SignalKind::kDisturbance,
                     static_cast<int>(input ? j : j - static_cast<std::size_t>(n_u)),
                     sampled(elements[j], names.sample_time_s)});
    }
    if (!loads[i]) continue;
    all.push_back({static_cast<int>(i), SignalKind::kDisturbance,
                   static_cast<int>(countOf(names.disturbances)),
                   sampled(loadOf(elements[most]), names.sample_time_s), poles});
    names.disturbances.push_back(loadSignal(names.outputs[i], fit.kind, names.sample_time_s));
  }
  const Index measured = point.disturbances.size();
  point.disturbances.conservativeResize(countOf(names.disturbances));
  point.disturbances.tail(point.disturbances.size() - measured).setZero();
  TsModel model = linearModel(names, all, point);
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const std::optional<GainCurve>& curve = fits[i].curve;
    if (!curve) continue;
    const double change =
        member < 0 ? curve->change : curve->ensemble[static_cast<std::size_t>(member)];
    bend(*curve, change, static_cast<int>(i), n_u, point, model.submodels[i]);
  }
  model.validate();
  return model;
}

OrderedJson elementJson(const ProcessElement& e) {
  return {{"gain", e.gain},
          {"time_constant_s", e.time_constant},
          {"second_s", e.second},
          {"damping", e.damping},
          {"lead_s", e.lead},
          {"dead_time_s", e.dead_time},
          {"integrating", e.integrating}};
}

ProcessElement elementOf(const OrderedJson& json) {
  ProcessElement e;
  e.gain = json.at("gain");
  e.time_constant = json.at("time_constant_s");
  e.second = json.at("second_s");
  e.damping = json.at("damping");
  e.lead = json.at("lead_s");
  e.dead_time = json.at("dead_time_s");
  e.integrating = json.at("integrating");
  return e;
}

const char* wordOf(ProcessKind kind) {
  return kind == ProcessKind::kStable        ? "stable"
         : kind == ProcessKind::kIntegrating ? "integrating"
                                             : "unstable";
}

IdentifiedModel identifiedOf(const ProcessModels& models, const TsModel& model) {
  IdentifiedModel found;
  found.model = model;
  const double z = normalBound(0.95);
  for (const ProcessFit& fit : models.fits) {
    IdentifiedOutput o;
    o.best = ModelKind::kRegressors;
    o.free_run_width = z * fit.free_run;
    o.one_step_width = z * fit.one_step;
    found.outputs.push_back(o);
  }
  return found;
}

std::string memberFile(const std::string& folder, std::size_t member) {
  return inFolder(inFolder(folder, "ensemble"), std::to_string(member + 1) + ".yaml");
}

/// Of the element, per hour of an integrator.
double gainOf(const ProcessElement& e) { return e.gain * (e.integrating ? 3600.0 : 1.0); }

/// n_y n_u.
Matrix gainsOf(const std::vector<ProcessFit>& fits, Index inputs) {
  Matrix gains(static_cast<Index>(fits.size()), inputs);
  for (std::size_t i = 0; i < fits.size(); ++i)
    for (Index j = 0; j < inputs; ++j) {
      const ElementEstimate& e = fits[i].elements[static_cast<std::size_t>(j)];
      gains(static_cast<Index>(i), j) = gainOf(e.element);
    }
  return gains;
}

Vector vectorOf(const std::vector<double>& values) {
  return Eigen::Map<const Vector>(values.data(), countOf(values));
}

Vector movesOf(const Matrix& disturbances) {
  Vector moves = Vector::Zero(disturbances.cols());
  for (Index k = 0; k < moves.size(); ++k) {
    std::vector<double> seen;
    for (const double value : disturbances.col(k))
      if (std::isfinite(value)) seen.push_back(value);
    if (!seen.empty()) moves[k] = 0.5 * (quantile(seen, 1.0 - kRare) - quantile(seen, kRare));
  }
  return moves;
}

/// What toJson() made of them.
std::vector<ProcessFit> fitsOf(const OrderedJson& json) {
  std::vector<ProcessFit> fits;
  for (const auto& output : json.at("outputs")) {
    ProcessFit fit;
    const std::string kind = output.at("kind");
    for (const ProcessKind k : {ProcessKind::kIntegrating, ProcessKind::kUnstable})
      if (kind == wordOf(k)) fit.kind = k;
    fit.rows = output.at("rows");
    fit.one_step = output.at("one_step");
    fit.free_run = output.at("free_run");
    fit.output = output.at("rest");
    fit.noise = vectorOf(output.at("noise"));
    fit.input = vectorOf(output.at("inputs_mean"));
    for (const auto& element : output.at("elements")) {
      ElementEstimate e;
      e.element = elementOf(element);
      e.seen = element.at("seen");
      e.gain_bound = numberOrInfinity(element.at("gain_bound"));
      e.dead_time_bound = element.at("dead_time_bound_s");
      e.time_bound = element.at("time_bound_s");
      fit.ensemble.resize(element.at("ensemble").size());
      for (std::size_t m = 0; m < fit.ensemble.size(); ++m)
        fit.ensemble[m].push_back(elementOf(element.at("ensemble")[m]));
      fit.elements.push_back(e);
    }
    fits.push_back(std::move(fit));
  }
  return fits;
}

}  // namespace

std::string loadName(const std::string& output) { return "load_" + output; }

LinearPoint modelRest(const std::vector<ProcessFit>& fits, Index inputs) {
  const Vector& all = fits.front().input;
  LinearPoint point{Vector(static_cast<Index>(fits.size())), all.head(inputs),
                    all.tail(all.size() - inputs)};
  for (std::size_t i = 0; i < fits.size(); ++i)
    point.outputs[static_cast<Index>(i)] = fits[i].curve ? fits[i].curve->output : fits[i].output;
  return point;
}

ProcessModels modelsOf(const TsModel& names, const std::vector<ProcessFit>& fits, int members,
                       const std::vector<bool>& loads) {
  ProcessModels models;
  models.fits = fits;
  models.model = modelOf(names, fits, -1, loads);
  for (int member = 0; member < members; ++member)
    models.ensemble.push_back(modelOf(names, fits, member, loads));
  models.disturbance_moves = Vector::Zero(countOf(names.disturbances));
  return models;
}

void takeNoiseInOperation(const PlantRecord& watched, Index first, const Vector& least,
                          ProcessModels& models) {
  const Matrix inputs = watched.inputsAndDisturbances();
  for (std::size_t i = 0; i < models.fits.size(); ++i) {
    Vector output = watched.outputs().col(static_cast<Index>(i));
    output.head(std::min(first, output.size()))
        .setConstant(std::numeric_limits<double>::quiet_NaN());
    const auto noise = noiseBeside(models.fits[i], inputs, output, watched.info().sample_time_s);
    if (!noise) continue;
    models.fits[i].noise = noise->terms;
    models.fits[i].one_step = std::max(noise->one_step, least[static_cast<Index>(i)]);
  }
}

ProcessModels findModels(const CommissioningBrief& brief, const PlantRecord& record, int members,
                         const std::function<bool(const ProcessModels&)>& holds) {
  const TsModel names = modelNames(brief);
  const Matrix inputs = record.inputsAndDisturbances();
  ProcessFitParams params;
  params.ensemble = members;
  const auto fitted = [&](std::size_t i) {
    params.seed = brief.seed + 1000 * i;
    return fitProcess(inputs, record.outputs().col(static_cast<Index>(i)), names.sample_time_s,
                      params);
  };
  const auto made = [&](const std::vector<ProcessFit>& of) {
    ProcessModels models = modelsOf(names, of, members, brief.counted());
    models.disturbance_moves = movesOf(record.disturbances());
    return models;
  };
  const auto moved = [&](const ProcessFit& fit) {
    return std::any_of(fit.elements.begin(), fit.elements.begin() + countOf(names.inputs),
                       [](const ElementEstimate& e) { return e.seen; });
  };
  std::vector<ProcessFit> fits;
  for (std::size_t i = 0; i < names.outputs.size(); ++i) {
    fits.push_back(fitted(i));
    require(moved(fits.back()), "output " + names.outputs[i].name,
            "an input that was seen to move it: test again");
  }
  const auto withCurves = [&](const ProcessModels& straight) {
    std::vector<ProcessFit> curved = straight.fits;
    bool any = false;
    for (std::size_t i = 0; i < curved.size(); ++i) {
      params.seed = brief.seed + 1000 * i;
      curved[i].curve =
          gainCurve(curved[i], inputs, countOf(names.inputs),
                    record.outputs().col(static_cast<Index>(i)), names.sample_time_s, params);
      any = any || curved[i].curve;
    }
    if (!any) return straight;
    const ProcessModels fuzzy = made(curved);
    return holds(fuzzy) ? fuzzy : straight;
  };
  const ProcessModels found = made(fits);
  ProcessModels models = found;
  for (const ProcessKind kind : {ProcessKind::kUnstable, ProcessKind::kIntegrating}) {
    if (holds(models)) return withCurves(models);
    params.kinds.pop_back();
    for (std::size_t i = 0; i < fits.size(); ++i)
      if (fits[i].kind == kind) fits[i] = fitted(i);
    if (!std::all_of(fits.begin(), fits.end(), moved)) return found;
    models = made(fits);
  }
  return holds(models) ? withCurves(models) : found;
}

std::vector<WeakDirection> weakDirections(const ProcessModels& models, const Vector& input_range,
                                          const Vector& output_range) {
  const Index n_u = input_range.size(), n_y = output_range.size();
  const auto scaled = [&](const Matrix& gains) {
    return Matrix(output_range.cwiseInverse().asDiagonal() * gains * input_range.asDiagonal());
  };
  const Matrix gains = scaled(gainsOf(models.fits, n_u));
  const Eigen::JacobiSVD<Matrix> svd = svdOf(gains, Eigen::ComputeFullU | Eigen::ComputeFullV);
  std::vector<WeakDirection> weak;
  const Vector values = svd.singularValues();
  for (Index k = 1; k < std::min(n_u, n_y); ++k) {
    const double share = values[k] / values[0];
    // The gain of this direction as every member of the ensemble has it.
    bool certain = true;
    const std::size_t members = models.fits.front().ensemble.size();
    for (std::size_t m = 0; m < members; ++m) {
      Matrix one(n_y, n_u);
      for (Index i = 0; i < n_y; ++i)
        for (Index j = 0; j < n_u; ++j) {
          const ProcessElement& e =
              models.fits[static_cast<std::size_t>(i)].ensemble[m][static_cast<std::size_t>(j)];
          one(i, j) =
              models.fits[static_cast<std::size_t>(i)].elements[static_cast<std::size_t>(j)].seen
                  ? gainOf(e)
                  : 0.0;
        }
      if (svd.matrixU().col(k).dot(scaled(one) * svd.matrixV().col(k)) <= 0.0) certain = false;
    }
    if (share < kWeak || !certain) weak.push_back({svd.matrixV().col(k), share, certain});
  }
  return weak;
}

OrderedJson toJson(const ProcessModels& models, const PlantInfo& plant) {
  OrderedJson json = {{"outputs", OrderedJson::array()}};
  for (std::size_t i = 0; i < models.fits.size(); ++i) {
    const ProcessFit& fit = models.fits[i];
    OrderedJson output = {{"name", plant.outputs[i].name},
                          {"kind", wordOf(fit.kind)},
                          {"rows", fit.rows},
                          {"one_step", fit.one_step},
                          {"free_run", fit.free_run},
                          {"noise", std::vector<double>(fit.noise.begin(), fit.noise.end())},
                          {"rest", fit.curve ? fit.curve->output : fit.output},
                          {"elements", OrderedJson::array()}};
    for (std::size_t j = 0; j < fit.elements.size(); ++j) {
      const ElementEstimate& e = fit.elements[j];
      OrderedJson element = {
          {"from", j < plant.inputs.size() ? plant.inputs[j].name
                                           : plant.disturbances[j - plant.inputs.size()].name},
          {"seen", e.seen}};
      element.update(elementJson(e.element));
      element["gain_bound"] = numberOrNull(e.gain_bound);
      element["dead_time_bound_s"] = e.dead_time_bound;
      element["time_bound_s"] = e.time_bound;
      element["ensemble"] = OrderedJson::array();
      for (const auto& member : fit.ensemble) element["ensemble"].push_back(elementJson(member[j]));
      output["elements"].push_back(std::move(element));
    }
    if (fit.curve) {
      const GainCurve& curve = *fit.curve;
      output["gain_curve"] = {
          {"along", curve.signal < 0 ? plant.outputs[i].name
                                     : plant.inputs[static_cast<std::size_t>(curve.signal)].name},
          {"lower", curve.lower},
          {"upper", curve.upper},
          {"factor", std::vector<double>(curve.factor.begin(), curve.factor.end())},
          {"change", curve.change},
          {"change_bound", curve.bound}};
    }
    output["inputs_mean"] = std::vector<double>(fit.input.begin(), fit.input.end());
    json["outputs"].push_back(std::move(output));
  }
  json["disturbance_moves"] =
      std::vector<double>(models.disturbance_moves.begin(), models.disturbance_moves.end());
  return json;
}

void writeModels(const ProcessModels& models, const std::string& folder) {
  makeFolder(inFolder(folder, "ensemble"));
  writeText(writeIdentified(identifiedOf(models, models.model)), inFolder(folder, "model.yaml"));
  for (std::size_t m = 0; m < models.ensemble.size(); ++m)
    writeText(writeIdentified(identifiedOf(models, models.ensemble[m])), memberFile(folder, m));
}

ProcessModels readModels(const std::string& folder) {
  ProcessModels models;
  const std::string file = inFolder(folder, "model.json");
  std::ifstream stream(file);
  require(static_cast<bool>(stream), file, "the file that stage model writes");
  try {
    const OrderedJson json = OrderedJson::parse(stream);
    models.fits = fitsOf(json);
    models.disturbance_moves = vectorOf(json.at("disturbance_moves"));
  } catch (const nlohmann::json::exception& e) {
    throw InputError(file + ": expected what stage model writes (" + e.what() + ")");
  }
  const IdentifiedModel found = readIdentified(inFolder(folder, "model.yaml"));
  models.model = found.model;
  for (std::size_t m = 0; fs::is_regular_file(memberFile(folder, m)); ++m)
    models.ensemble.push_back(readIdentified(memberFile(folder, m)).model);
  return models;
}

}  // namespace fpc
