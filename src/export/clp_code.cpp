#include "export/clp_code.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "control/power_of_two.hpp"
#include "export/clp_text.hpp"
#include "export/math.hpp"
#include "export/print.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using ir::Kind;
using ir::Value;

/// The text of the optimizer with this loop's sizes and tables in front, under the block's name.
class ClpText {
 public:
  explicit ClpText(const std::string& block) : block_(block) {}

  void size(const std::string& name, Eigen::Index value) {
    types_ += "#define CLP_" + name + " " + std::to_string(value) + "\n";
  }
  void number(const std::string& name, double value) {
    types_ += "#define CLP_" + name + " " + realLiteral(value, false, 'e') + "\n";
  }
  void table(const std::string& name, const std::vector<double>& values) {
    list("double", name, values, [](double v) {
      return realLiteral(std::clamp(v, -ir::kLargest, ir::kLargest), false, 'e');
    });
  }
  void table(const std::string& name, const Vector& values) {
    table(name, std::vector<double>(values.data(), values.data() + values.size()));
  }
  void table(const std::string& name, const std::vector<int>& values) {
    list("int32_t", name, values, [](int v) { return std::to_string(v); });
  }
  ir::Native native() const {
    return {named(types_ + "\n" + kClpQpTypes + "\n" + kClpTypes + "\n"),
            "  " + block_ + "_clp_t clp;\n", named("\n" + tables_ + "\n" + withSolver())};
  }

 private:
  template <typename T, typename Print>
  void list(const std::string& kind, const std::string& name, const std::vector<T>& values,
            const Print& print) {
    if (values.empty()) return;
    tables_ +=
        "static const " + kind + " clp_" + name + "[" + std::to_string(values.size()) + "] = {";
    for (std::size_t i = 0; i < values.size(); ++i)
      tables_ += (i == 0 ? "" : ", ") + print(values[i]);
    tables_ += "};\n";
  }
  static std::string withSolver() {
    const std::string include = "#include \"qp.c\"\n";
    std::string text = kClp;
    return text.replace(text.find(include), include.size(), kClpQp);
  }
  /// In one pass: the block's own name may hold what is replaced.
  std::string named(const std::string& text) const {
    const std::pair<std::string, std::string> words[] = {{"clp_root", block_ + "_sqrt"},
                                                         {"CLP_NO_CALL", noCall(block_)},
                                                         {"clp_", block_ + "_clp_"},
                                                         {"CLP_", upperCase(block_) + "_CLP_"}};
    std::string to;
    for (std::size_t at = 0; at < text.size();) {
      const auto* word = std::find_if(std::begin(words), std::end(words), [&](const auto& w) {
        return text.compare(at, w.first.size(), w.first) == 0;
      });
      to += word == std::end(words) ? std::string(1, text[at]) : word->second;
      at += word == std::end(words) ? 1 : word->first.size();
    }
    return to;
  }

  std::string block_, types_, tables_;
};

/// Which row of the state each row comes from: see clp_advance().
std::vector<int> kindsOf(const LocalModel& layout, int n_y, int n_u, int n_d) {
  std::vector<int> kinds(static_cast<std::size_t>(layout.stateSize()), n_y);
  const auto at = [&](Eigen::Index row) -> int& { return kinds[static_cast<std::size_t>(row)]; };
  for (int i = 0; i < n_y; ++i) at(layout.outputState(i)) = i;
  for (int i = 0; i < n_u; ++i) at(layout.inputState(i, 1)) = n_y + 1 + i;
  for (int i = 0; i < n_d; ++i)
    if (layout.model().maxLag(SignalKind::kDisturbance, i) > 0)
      at(layout.disturbanceState(i, 1)) = n_y + 1 + n_u + i;
  return kinds;
}

Vector orOf(const Vector& given, Eigen::Index size, double value) {
  return given.size() > 0 ? given : Vector(Vector::Constant(size, value));
}

void describe(const BlockParts& parts, const LocalModel& layout, const PredictiveLawParams& law,
              int lead, ClpText& text) {
  const LoopFile& loop = parts.loop;
  const ClpParams& clp = loop.clp;
  const int n_y = parts.n_y, n_u = parts.n_u, n_c = clp.perturbation_steps;
  const bool lq = clp.cost == ClpCostKind::kLq, incremental = clp.bounds == ClpBounds::kIncremental;
  const Vector outputs = lq ? orOf(clp.weight_state_output, n_y, 1.0)
                            : orOf(clp.weight_tracking, n_y, 0.0),
               inputs = orOf(lq ? clp.weight_input : clp.weight_perturbation, n_u, 1.0);
  const Vector low = orOf(clp.output_lower, n_y, -kInfinity),
               high = orOf(clp.output_upper, n_y, kInfinity),
               weight = orOf(clp.output_weight, n_y, 1.0);
  std::vector<int> soft, rows, targets = clp.target_outputs;
  std::vector<double> soft_low, soft_high, soft_weight, unit, at_lead;
  for (int i = 0; i < n_y; ++i) {
    rows.push_back(static_cast<int>(layout.outputState(i)));
    at_lead.push_back(std::pow(law.reference_pole[i], lead + 1));
    if (!std::isfinite(low[i]) && !std::isfinite(high[i])) continue;
    soft.push_back(i);
    soft_low.push_back(low[i]);
    soft_high.push_back(high[i]);
    soft_weight.push_back(clp.output_penalty * weight[i]);
  }
  const auto& limits = loop.simulation.actuator.limits;
  for (int i = 0; i < n_u; ++i) unit.push_back(powerOfTwoNear(limits.upper[i] - limits.lower[i]));
  for (int i = 0; targets.empty() && i < n_u; ++i) targets.push_back(i);
  const int n_soft = static_cast<int>(soft.size()), moves = incremental ? 0 : n_u * (n_c - 1),
            n_rows = moves + 2 * n_soft * n_c;
  text.size("NX", layout.stateSize());
  text.size("NY", n_y);
  text.size("NU", n_u);
  text.size("ND", std::max(parts.n_d, 1));
  text.size("NC", n_c);
  text.size("INPUTS", n_u * n_c);
  text.size("SOFT", n_soft);
  text.size("SOFTS", std::max(n_soft, 1));
  text.size("MOVES", moves);
  text.size("N", n_u * n_c + n_soft);
  text.size("M", n_rows);
  text.size("ROWS", std::max(n_rows, 1));
  text.size("LQ", lq);
  text.size("TRACKS", (outputs.array() > 0.0).any());
  text.size("INCREMENTAL", incremental);
  text.size("TARGET", lq || incremental);
  text.table("kind", kindsOf(layout, n_y, n_u, parts.n_d));
  text.table("output_row", rows);
  text.table("unit", unit);
  text.table("pole", law.reference_pole);
  text.table("lead", at_lead);
  text.table("weight_output", outputs);
  text.table("root_output", Vector(outputs.cwiseSqrt()));
  if (lq) text.table("weight_input", inputs);
  text.table("root_input", Vector(inputs.cwiseSqrt()));
  text.table("soft", soft);
  text.table("soft_lower", soft_low);
  text.table("soft_upper", soft_high);
  text.table("soft_weight", soft_weight);
  if (incremental) {
    text.table("increment_lower", clp.increment_lower);
    text.table("increment_upper", clp.increment_upper);
  }
  if (lq || incremental) text.table("target", targets);
  text.number("DECAY", law.transfer_decay);
}

}  // namespace

ClpCode::ClpCode(BlockParts& parts, const LocalModel& model, const PredictiveLawParams& law,
                 int lead)
    : x(0),
      A(0),
      B(0),
      g(0),
      d(0),
      offset(0),
      K(0),
      L(0),
      bias(0),
      base(0),
      least(0),
      most(0),
      previous(0),
      u(0),
      source(0),
      b_(parts),
      p_(parts.p),
      away_(0),
      setpoint_(0),
      lower_(0),
      upper_(0),
      move_(0),
      status_(0),
      iterations_(0),
      active_(0),
      most_sets_(0),
      status_out_(0),
      iterations_out_(0),
      active_out_(0) {
  const int n_y = b_.n_y, n_u = b_.n_u, n_x = static_cast<int>(model.stateSize());
  x = member("x", n_x);
  A = member("A", n_y * n_x);
  B = member("B", n_y * n_u);
  g = member("g", n_y);
  d = member("d", std::max(b_.n_d, 1));
  offset = member("offset", n_y);
  K = member("K", n_u * n_x);
  L = member("L", n_u * n_y);
  bias = member("bias", n_u);
  base = member("base", n_u);
  least = member("least", n_u);
  most = member("most", n_u);
  previous = member("previous", n_u);
  u = member("u", n_u);
  source = member("source", 0, Kind::kInt);
  away_ = member("away", n_y);
  setpoint_ = member("setpoint", n_y);
  lower_ = member("lower", n_u);
  upper_ = member("upper", n_u);
  move_ = member("move", n_u);
  status_ = member("status", 0, Kind::kInt);
  iterations_ = member("iterations", 0, Kind::kInt);
  active_ = member("active", 0, Kind::kInt);
  most_sets_ = p_.input("iMostSets", Kind::kInt, b_.loop.clp.qp.max_iterations,
                        "working sets that the optimizer may try in a sample; then the law's "
                        "action is clipped");
  status_out_ =
      p_.output("iSolved", Kind::kInt,
                "1 solved, 3 more than iMostSets, 4 not solvable in numbers, 6 did not run");
  iterations_out_ =
      p_.output("iSets", Kind::kInt, "working sets tried; 0: the law keeps all limits");
  active_out_ = p_.output("iLimits", Kind::kInt, "limits that hold the plan");
  ClpText text(p_.name);
  describe(b_, model, law, lead, text);
  p_.native = text.native();
  ir::squareRoot(p_, 1.0);  // defines what the text calls
}

Value ClpCode::member(const std::string& name, int size, Kind kind) {
  return p_.member("clp." + name, kind, size);
}

void ClpCode::begin(const Value& reference, const Value& disturbances) {
  p_.loop(b_.n_y, [&](const Value& i) {
    p_.set(setpoint_[i], b_.setpoint[i]);
    p_.set(away_[i], reference[i] - b_.setpoint[i]);
  });
  for (int i = 0; i < b_.n_d; ++i) p_.set(d[i], disturbances[i]);
}

void ClpCode::run() {
  p_.loop(b_.n_u, [&](const Value& i) {
    p_.set(lower_[i], b_.lower[i]);
    p_.set(upper_[i], b_.upper[i]);
    p_.set(move_[i], b_.move[i]);
  });
  p_.statement(p_.name + "_clp_step(&s->clp, in->iMostSets);");
  p_.set(status_out_, status_);
  p_.set(iterations_out_, iterations_);
  p_.set(active_out_, active_);
}

void ClpCode::rest() {
  p_.set(status_out_, 6);
  p_.set(iterations_out_, 0);
  p_.set(active_out_, 0);
}

}  // namespace fpc
