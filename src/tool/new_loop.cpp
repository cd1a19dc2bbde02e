// fmbpc new loop --model FILE: a loop file that runs, with numbers from the model and its record.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "base/files.hpp"
#include "config/identified_file.hpp"
#include "config/loop_file.hpp"
#include "control/pi/tuning.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "plant/model_plant.hpp"
#include "tool/commands.hpp"
#include "tool/rehearsal.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;
using Eigen::Index;

constexpr int kLongestStep = 5000;  // samples
constexpr double kStepPart = 0.1;   // of an input's range
constexpr double kShortHorizon = 10, kLongHorizon = 60;
constexpr double kNoNoise = 1e-3;  // of an output's range, where the record's noise is unknown
constexpr double kSteps[] = {0.15, -0.15, 0.0};  // of the inputs' ranges, around the middle
constexpr double kLoad = 0.5;                    // of the first step of the setpoints
constexpr double kWeights[] = {0.01, 0.03, 0.1,  0.3,  1.0,
                               3.0,  10.0, 30.0, 100.0};           // of the moves, ranges squared
constexpr double kWalks[] = {1.0, 0.1, 0.01};                      // of the record's load
constexpr double kSlower[] = {1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0};  // than the rule's PI

/// What steps of the inputs do to the outputs around the model's nominal point.
struct StepResponses {
  Vector y, u, d;          // the point
  Matrix gain;             // n_y n_u
  Matrix time, dead_time;  // [s]; of no gain 0
  Vector y_range, u_range;
};

std::string digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

double rangeOr(const SignalInfo& s, double otherwise) {
  const double range = s.upper - s.lower;
  return std::isfinite(range) && range > 0.0 ? range : otherwise;
}

Vector nominalOf(const std::vector<Quantity>& quantities, Index count) {
  Vector values(count);
  for (Index i = 0; i < count; ++i) values[i] = quantities[static_cast<std::size_t>(i)].nominal;
  return values;
}

/// Outputs after a step of one input, a column a sample, until they rest.
Matrix stepResponse(const Plant& plant, double sample_time_s, const StepResponses& at, Index input,
                    double step) {
  const auto stepper = plant.makeStepper(sample_time_s);
  const auto n_d = static_cast<Index>(plant.description().disturbances.size());
  Vector d = Vector::Zero(n_d), u = at.u, x = at.y;
  d.head(at.d.size()) = at.d;
  stepper->reset(u, d);
  u[input] += step;
  Matrix response(x.size(), kLongestStep);
  int samples = 0;
  while (samples < kLongestStep) {
    stepper->advance(x, u, d);
    response.col(samples++) = x;
    const int window = std::max(20, samples / 4);
    if (samples > 2 * window &&
        ((response.middleCols(samples - window, window).rowwise().maxCoeff() -
          response.middleCols(samples - window, window).rowwise().minCoeff())
             .array() <= 1e-3 * at.y_range.array() * kStepPart)
            .all())
      break;
  }
  return response.leftCols(samples);
}

/// Time constant and dead time from the times of 28 and 63 % of the change.
void fitLag(const Matrix& response, Index output, double sample_time_s, Index input,
            StepResponses& found) {
  const double start = found.y[output], end = response(output, response.cols() - 1);
  const auto reaches = [&](double part) {
    for (Index k = 0; k < response.cols(); ++k)
      if ((response(output, k) - start) / (end - start) >= part)
        return static_cast<double>(k + 1) * sample_time_s;
    return static_cast<double>(response.cols()) * sample_time_s;
  };
  const double t28 = reaches(0.283), t63 = reaches(0.632);
  found.time(output, input) = std::max(1.5 * (t63 - t28), 0.5 * sample_time_s);
  found.dead_time(output, input) = std::max(t63 - found.time(output, input), 0.0);
}

StepResponses respond(const TsModel& model) {
  const ModelPlant plant(model, {}, {});
  const PlantDescription& about = plant.description();
  StepResponses found;
  const Index n_y = countOf(model.outputs), n_u = countOf(model.inputs);
  found.y = nominalOf(about.states, n_y);
  found.u = nominalOf(about.inputs, n_u);
  found.d = nominalOf(about.disturbances, countOf(model.disturbances));
  found.y_range = found.u_range = Vector();
  found.y_range.resize(n_y);
  found.u_range.resize(n_u);
  for (Index i = 0; i < n_y; ++i)
    found.y_range[i] = rangeOr(model.outputs[static_cast<std::size_t>(i)], 1.0);
  for (Index i = 0; i < n_u; ++i)
    found.u_range[i] = rangeOr(model.inputs[static_cast<std::size_t>(i)], 1.0);
  found.gain = found.time = found.dead_time = Matrix::Zero(n_y, n_u);
  for (Index j = 0; j < n_u; ++j) {
    const double step = kStepPart * found.u_range[j];
    const Matrix response = stepResponse(plant, model.sample_time_s, found, j, step);
    for (Index i = 0; i < n_y; ++i) {
      const double change = response(i, response.cols() - 1) - found.y[i];
      if (!std::isfinite(change) || std::abs(change) < 1e-3 * kStepPart * found.y_range[i])
        continue;
      found.gain(i, j) = change / step;
      fitLag(response, i, model.sample_time_s, j, found);
    }
  }
  return found;
}

/// Largest of the time that a response takes, over what matters.
double settlingOf(const StepResponses& r) { return (r.dead_time + 2.0 * r.time).maxCoeff(); }

struct Pair {
  Index input, output;
};

struct LawSetting {
  double move_weight, walk;  ///< see kWeights, kWalks
};

/// Inputs and outputs by their largest gains in parts of the ranges, each once.
std::vector<Pair> pairsOf(const StepResponses& r) {
  Matrix strength =
      (r.gain.array().abs().colwise() / r.y_range.array()).matrix() * r.u_range.asDiagonal();
  std::vector<Pair> pairs;
  Pair next{};
  while (strength.maxCoeff(&next.output, &next.input) > 0.0) {
    pairs.push_back(next);
    strength.row(next.output).setZero();
    strength.col(next.input).setZero();
  }
  return pairs;
}

class LoopWriter {
 public:
  LoopWriter(const NewArguments& a, const std::string& name, const IdentifiedModel& found,
             const std::string& model_file)
      : a_(a),
        name_(name),
        model_(found.model),
        file_(model_file),
        steps_(respond(found.model)),
        sample_(found.model.sample_time_s) {
    noise_ = noiseOf(model_, modelErrorsOf(found), steps_.y, steps_.u, steps_.d);
    known_noise_ = noise_.measurement.size() > 0 &&
                   (noise_.measurement.array() + noise_.load.array() > 0.0).all();
  }

  /// The loop file; `plant` as of NewArguments.
  std::string law(const LawSetting& setting, const std::string& plant_type) const {
    return head(plant_type) + plant(plant_type) + timing(plant_type) + "model:\n  file: " + file_ +
           "\n\n" + controller(setting) + actuator();
  }

  /// The same under proportional and integral controllers, tuned by the step responses, whole.
  std::string pi(double slower) const {
    return head("model") + plant("model") + timing("model") + piController(slower) + actuator();
  }

  /// As a file beside that of law().
  std::string piBeside(double slower) const {
    return "# The same loop by PI controllers, tuned by the model's step responses (rivera1986): "
           "what to fall back to, "
           "and what to beat.\nextends: " +
           name_ + ".yaml\ntitle: " + name_ + ", PI\n" + piController(slower);
  }

  /// A step of the setpoints, and the move of the inputs that makes it.
  RehearsalScale scale() const {
    const Vector step = aimOf(kSteps[0]) - steps_.y;
    return {step.cwiseAbs().cwiseMax(0.01 * steps_.y_range), kSteps[0] * steps_.u_range};
  }

 private:
  struct Signals {
    const std::vector<SignalInfo>& list;
    const SignalInfo& operator[](Index i) const { return list[static_cast<std::size_t>(i)]; }
  };
  Signals outputs() const { return {model_.outputs}; }
  Signals inputs() const { return {model_.inputs}; }

  static std::string mapping(const std::vector<SignalInfo>& signals, const Vector& values) {
    std::string text = "{";
    for (std::size_t i = 0; i < signals.size(); ++i)
      text += (i ? ", " : "") + signals[i].name + ": " + digits(values[static_cast<Index>(i)]);
    return text + "}";
  }

  std::string piController(double slower) const {
    std::string text = "controller:\n  type: pi\n  loops:\n";
    for (const Pair& p : pairsOf(steps_)) {
      const Fopdt lag{steps_.gain(p.output, p.input), steps_.time(p.output, p.input) / 60.0,
                      steps_.dead_time(p.output, p.input) / 60.0};
      const double lambda =
          slower * std::max({lag.dead_time, 0.5 * lag.time_constant, sample_ / 60.0});
      const PiTuning t = imcTuning(lag, lambda);
      text += "    - {input: " + inputs()[p.input].name + ", output: " + outputs()[p.output].name +
              ", kp: " + digits(t.kp) + ", ki_per_h: " + digits(t.kp * 60.0 / t.integral_time_min) +
              ", start: bumpless}  # gain " + digits(lag.gain) + ", lag " +
              digits(lag.time_constant) + " min, dead time " + digits(lag.dead_time) +
              " min; asked for a lag of " + digits(lambda) + " min\n";
    }
    return text;
  }

  std::string head(const std::string& plant_type) const {
    return "# Written by `fmbpc new loop` from " + file_ +
           ": numbers are of the model and its record, see them as a start.\n"
           "#   fmbpc run " +
           name_ + (plant_type == "model" ? ".yaml" : ".yaml --on-model") +
           "\n#   fmbpc stability " + name_ +
           ".yaml\n# All keys, units and defaults: docs/loop_file.md\ntitle: " + name_ + "\n\n";
  }

  std::string signalList(const char* key, const std::vector<SignalInfo>& signals,
                         double beyond) const {
    if (signals.empty()) return "";
    std::string text = std::string("  ") + key + ":\n";
    for (const SignalInfo& s : signals) {
      const double more = beyond * rangeOr(s, 0.0);
      text += "    - {name: " + s.name;
      if (!s.unit.empty()) text += ", unit: '" + s.unit + "'";
      if (std::isfinite(s.lower) && std::isfinite(s.upper))
        text += ", lower: " + digits(s.lower - more) + ", upper: " + digits(s.upper + more);
      text += "}\n";
    }
    return text;
  }

  std::string plant(const std::string& type) const {
    if (type == "model")
      return "plant:\n  type: model                    # rehearsed on the model itself, with its "
             "noise\n  model: " +
             file_ + "\n\n";
    std::string text =
        "plant:                           # ranges: of the record, outputs wider by half of it; "
        "put those of your plant\n  type: external\n  name: " +
        name_ + "\n" + signalList("outputs", model_.outputs, 0.5) +
        signalList("inputs", model_.inputs, 0.0) +
        signalList("disturbances", model_.disturbances, 0.5) + "\n";
    if (type == "external")
      return text +
             "gateway: {type: none}            # a node of yours speaks the loop protocol: "
             "docs/own_plant.md\n\n";
    text += "gateway:\n  type: " + type + "\n";
    int next = 0;
    if (type == "modbus")
      text += "  modbus: {host: 127.0.0.1, port: 502}  # put yours, and the registers below\n";
    text += "  tags:\n";
    for (const auto* group : {&model_.outputs, &model_.disturbances, &model_.inputs})
      for (const SignalInfo& s : *group) {
        const bool is_input = group == &model_.inputs;
        text += "    " + s.name + ": {";
        if (type == "modbus")
          text += "register: " + std::to_string(2 * next++) + (is_input ? "" : ", table: input") +
                  ", type: float32}\n";
        else
          text += "topic: " + name_ + "/" + s.name + "}\n";
      }
    return text + "\n";
  }

  /// Where the outputs rest under inputs beside the middle by so much of their ranges.
  Vector aimOf(double part) const {
    const std::optional<Vector> rest = restOf(model_, steps_.u + part * steps_.u_range, steps_.d);
    return rest && rest->allFinite() ? *rest : steps_.y;
  }

  /// What, added in each sample, would shift the outputs by a part of the first step.
  Vector load() const {
    const ModelPlant plant(model_, {}, {});
    Vector shift = kLoad * (aimOf(kSteps[0]) - steps_.y);
    for (Index i = 0; i < shift.size(); ++i)
      if (shift[i] == 0.0) shift[i] = kLoad * kStepPart * steps_.y_range[i];
    Vector change(shift.size()), d = Vector::Zero(steps_.d.size() + shift.size());
    d.head(steps_.d.size()) = steps_.d;
    plant.derivatives(steps_.y + shift, steps_.u, d, change);
    for (Index i = 0; i < shift.size(); ++i) {  // of an output that integrates at least a ramp
      const double least = std::abs(shift[i]) * sample_ / settlingOf(steps_);
      if (!(std::abs(change[i]) >= least)) change[i] = shift[i] < 0.0 ? least : -least;
    }
    return -change;
  }

  /// Steps of the setpoints, then, where the plant is the model, a load.
  std::string timing(const std::string& plant_type) const {
    const auto quarter =
        static_cast<int>(std::clamp(std::ceil(3.0 * settlingOf(steps_) / sample_), 50.0, 1000.0));
    const auto hours = [&](int samples) { return exactText(samples * sample_ / 3600.0); };
    const bool loaded = plant_type == "model";
    const int samples = (loaded ? 5 : 4) * quarter;
    std::ostringstream out;
    out << "sampling:\n  sample_time_s: " << exactText(sample_)
        << "\n  duration_h: " << hours(samples) << "      # " << samples
        << " samples\n\nsetpoint:                        # steps that the inputs' ranges allow\n  "
           "initial: "
        << mapping(model_.outputs, steps_.y) << "\n  schedule:\n";
    int k = 1;
    for (const double part : kSteps)
      out << "    - {time_h: " << hours(quarter * k++) << ", "
          << mapping(model_.outputs, aimOf(part)).substr(1) << "\n";
    out << "\n";
    if (!loaded) return out.str();
    out << "disturbance:                     # a load that would shift the outputs by half of the "
           "first step\n  commands:\n";
    const Vector shift = load();
    for (Index i = 0; i < shift.size(); ++i)
      out << "    - {time_h: " << hours(quarter * k) << ", name: load/" << outputs()[i].name
          << ", value: " << digits(shift[i]) << ", mode: offset}\n";
    out << "\n";
    return out.str();
  }

  std::string controller(const LawSetting& setting) const {
    const Vector y_weight = steps_.y_range.array().square().inverse(),
                 u_weight = setting.move_weight * steps_.u_range.array().square().inverse();
    Vector pole(steps_.y.size()), noise(pole.size()), walk(pole.size());
    for (Index i = 0; i < pole.size(); ++i) {
      Index j = 0;
      steps_.gain.row(i).cwiseAbs().maxCoeff(&j);
      const double asked = std::max({0.5 * steps_.time(i, j), steps_.dead_time(i, j), sample_});
      pole[i] = std::exp(-sample_ / asked);
      noise[i] = known_noise_ ? std::max(noise_.measurement[i], noise_.load[i])
                              : kNoNoise * steps_.y_range[i];
      walk[i] =
          setting.walk * (known_noise_ ? std::max(noise_.load[i], 0.02 * noise[i]) : noise[i]);
    }
    const double horizon =
        std::clamp(std::ceil(settlingOf(steps_) / sample_), kShortHorizon, kLongHorizon);
    std::ostringstream out;
    out << "controller:\n"
        << "  type: fmbpc\n"
        << "  law: iterated                  # plans along the model's path, inside the limits\n"
        << "  horizon_steps: " << horizon << "              # dead time and twice the slowest lag\n"
        << "  reference_pole: " << mapping(model_.outputs, pole)
        << "  # half the lag, or the dead time\n"
        << "  weight_output: " << mapping(model_.outputs, y_weight) << "  # 1 / range^2\n"
        << "  weight_move: " << mapping(model_.inputs, u_weight) << "  # "
        << digits(setting.move_weight) << " / range^2\n"
        << "  realisation: observer\n"
        << "  observer:"
        << (known_noise_ ? "                        # of the model's errors on its record\n"
                         : "                        # the model file does not say its errors: put "
                           "the noise of your sensors\n")
        << "    noise_std: " << mapping(model_.outputs, noise) << "\n"
        << "    disturbance_std: " << mapping(model_.outputs, walk) << "  # "
        << digits(setting.walk) << " of it. This and weight_move: of "
        << std::size(kWeights) * std::size(kWalks)
        << " pairs the cheapest on the model with a sensitivity peak below " << digits(kUsualPeak)
        << ", or the one with the lowest\n\n";
    return out.str();
  }

  std::string actuator() const {
    std::ostringstream out;
    out << "actuator:\n  initial: " << mapping(model_.inputs, steps_.u)
        << "\n  fallback: " << mapping(model_.inputs, steps_.u)
        << "  # after hold_samples without an action; put what is safe\n  hold_samples: 10\n";
    return out.str();
  }

  const NewArguments& a_;
  std::string name_;
  const TsModel& model_;
  std::string file_;
  StepResponses steps_;
  double sample_;
  ModelNoise noise_;
  bool known_noise_{};
};

std::string figuresOf(const std::string& name, const Rehearsed& chosen, const Judged& is,
                      const std::vector<SignalInfo>& outputs) {
  std::string text = "  " + name + ": cost " + digits(is.cost) + ", ISE";
  for (std::size_t i = 0; i < outputs.size(); ++i)
    text += " of " + outputs[i].name + " " + digits(is.ise[static_cast<Index>(i)]);
  return text + ", mean move " + digits(100.0 * is.movement) +
         " % of the range, sensitivity peak " + digits(chosen.peak) + "\n";
}

}  // namespace

int newLoop(const NewArguments& a) {
  require(!a.model.empty(), "--model", "a model file");
  const std::string file = fs::absolute(findModel(a.model)).lexically_normal().string();
  const IdentifiedModel found = readIdentified(file);
  const std::string name = a.name.empty() ? fs::path(file).stem().string() + "_loop" : a.name;
  const std::string target = inFolder(a.out, name + ".yaml"),
                    pi_target = inFolder(a.out, name + "_pi.yaml");
  for (const std::string& t : {target, pi_target})
    require(!fs::exists(t), t, "a file that is not there yet");
  const LoopWriter writer(a, name, found, file);
  std::vector<LawSetting> settings;
  std::vector<std::string> laws, pis;
  for (const double weight : kWeights)
    for (const double walk : kWalks) {
      settings.push_back({weight, walk});
      laws.push_back(writer.law(settings.back(), "model"));
    }
  for (const double slower : kSlower) pis.push_back(writer.pi(slower));
  const RehearsalScale scale = writer.scale();
  const Rehearsed law = chosenOf(laws, name, scale), pi = chosenOf(pis, name, scale);
  require(std::isfinite(law.cost) && std::isfinite(law.peak), "--model " + file,
          "a model on which law iterated comes to rest with one of " + std::to_string(laws.size()) +
              " settings");
  const auto placeOf = [](const std::vector<std::string>& texts, const Rehearsed& chosen) {
    return static_cast<std::size_t>(std::find(texts.begin(), texts.end(), chosen.text) -
                                    texts.begin());
  };
  makeFolder(a.out);
  writeText(writer.law(settings[placeOf(laws, law)], a.plant), target);
  writeText(writer.piBeside(kSlower[placeOf(pis, pi)]), pi_target);
  for (const std::string& t : {target, pi_target}) readLoop(t);  // says what does not fit
  const Judged of_law = judged(law.text, name, scale), of_pi = judged(pi.text, name, scale);
  const std::string rehearsal = a.plant == "model" ? "" : " --on-model";
  std::cout << "written: " << target << ", " << pi_target
            << "\non the model, with three seeds of noise that nothing was chosen by:\n"
            << figuresOf(name, law, of_law, found.model.outputs)
            << figuresOf(name + "_pi", pi, of_pi, found.model.outputs)
            << (of_law.cost < of_pi.cost
                    ? "The law costs " + digits(of_law.cost / of_pi.cost) +
                          " of what the PI does.\n"
                    : "The PI is cheaper: begin with it, or tune the law (fmbpc tune).\n")
            << "try it: fmbpc run " << target << " " << pi_target << rehearsal
            << "\n        fmbpc stability " << target << "\n";
  return 0;
}

}  // namespace fpc::tool
