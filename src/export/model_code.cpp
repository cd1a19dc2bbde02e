#include "export/model_code.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "export/math.hpp"
#include "fmbpc/base/input_error.hpp"
#include "model/same_rules.hpp"

namespace fpc {

using ir::Kind;
using ir::Value;

namespace {

std::size_t place(int i) { return static_cast<std::size_t>(i); }

constexpr double kFaint = 1e-30;  // sum of degrees below which no rule fires

bool isLinear(MembershipShape shape) {
  return shape == MembershipShape::kTriangular || shape == MembershipShape::kTrapezoidal;
}

}  // namespace

ModelCode::ModelCode(BlockParts& parts, const TsModel& model, const std::string& prefix,
                     const std::string& tables)
    : A(0),
      B(0),
      g(0),
      b_(parts),
      p_(parts.p),
      layout_(model),
      prefix_(prefix),
      tables_(tables),
      a_(0),
      b1_(0),
      c_(0),
      n_(0),
      part_(0) {
  A = p_.works(prefix + "A", Kind::kReal, b_.n_y * n_x());
  B = p_.works(prefix + "B", Kind::kReal, b_.n_y * b_.n_u);
  g = p_.works(prefix + "g", Kind::kReal, b_.n_y);
  a_ = p_.work(prefix + "t1");
  b1_ = p_.work(prefix + "t2");
  c_ = p_.work(prefix + "t3");
  n_ = p_.work(prefix + "tn", Kind::kInt);
  part_ = p_.works(prefix + "part", Kind::kReal, 4);
  for (int o = 0; o < b_.n_y; ++o) {
    const int like = partitionOf(o);
    weights.push_back(like < o
                          ? weights[place(like)]
                          : p_.works(prefix + "w" + std::to_string(o), Kind::kReal,
                                     static_cast<int>(model.submodels[place(o)].rules.size())));
  }
}

Value ModelCode::table(const std::string& name, const std::vector<double>& values) {
  return p_.table(tables_ + name, values);
}

/// The first output that has the weights of this one.
int ModelCode::partitionOf(int output) const {
  const auto& submodels = layout_.model().submodels;
  int like = 0;
  while (!sameWeights(submodels[place(like)], submodels[place(output)])) ++like;
  return like;
}

Value ModelCode::placed(const Regressor& r, const Value& state, const Value& d) const {
  switch (r.kind) {
    case SignalKind::kOutput:
      return state[static_cast<int>(layout_.outputState(r.index, r.lag))];
    case SignalKind::kInput:
      return state[static_cast<int>(layout_.inputState(r.index, std::max(r.lag, 1)))];
    default:
      if (r.lag == 0) return d[r.index];
      return state[static_cast<int>(layout_.disturbanceState(r.index, r.lag))];
  }
}

/// Shoulders of each rule's set, and the widths of its flanks.
void ModelCode::declareFlanks(int output, const std::vector<std::size_t>& of, Flanks& flanks) {
  const OutputModel& submodel = layout_.model().submodels[place(output)];
  std::vector<double> lower, upper, left, right;
  flanks.least = flanks.least_span = std::numeric_limits<double>::infinity();
  for (const std::size_t antecedent : of)
    for (const Rule& rule : submodel.rules) {
      const Membership& m = rule.antecedents[antecedent];
      const std::vector<double>& p = m.parameters;
      if (m.shape == MembershipShape::kGaussian) {
        lower.push_back(p[0]);
        upper.push_back(p[0]);
        left.push_back(3.0 * p[1]);
        right.push_back(3.0 * p[1]);
      } else {
        const bool triangle = m.shape == MembershipShape::kTriangular;
        lower.push_back(p[1]);
        upper.push_back(p[triangle ? 1 : 2]);
        left.push_back(p[1] - p[0]);
        right.push_back(p[triangle ? 2 : 3] - p[triangle ? 1 : 2]);
      }
      for (const double width : {left.back(), right.back()})
        if (width > 0.0) flanks.least = std::min(flanks.least, 0.5 * width);
      const double span = upper.back() + right.back() - (lower.back() - left.back());
      if (span > 0.0) flanks.least_span = std::min(flanks.least_span, 0.5 * span);
    }
  flanks.lower = table(flanks.name + "Lower", lower);
  flanks.upper = table(flanks.name + "Upper", upper);
  flanks.left = table(flanks.name + "Left", left);
  flanks.right = table(flanks.name + "Right", right);
}

/// Adds the logarithms of these antecedents' degrees to the weights; linear flanks multiply
/// `product`.
void ModelCode::degrees(int output, const Group& group, const Value& z, const Value& alive,
                        const Value& product) {
  const OutputModel& submodel = layout_.model().submodels[place(output)];
  const int n = static_cast<int>(submodel.rules.size()), count = static_cast<int>(group.of.size());
  const Value& w = weights[place(output)];
  if (group.shape == MembershipShape::kGaussian) {
    std::vector<double> centre, width;
    for (const std::size_t antecedent : group.of)
      for (const Rule& rule : submodel.rules) {
        centre.push_back(rule.antecedents[antecedent].parameters[0]);
        width.push_back(rule.antecedents[antecedent].parameters[1]);
      }
    const Value centres = table(group.flanks.name + "Centre", centre),
                widths = table(group.flanks.name + "Width", width);
    p_.loop(count, [&](const Value& i) {
      p_.loop(n, [&](const Value& r) {
        p_.set(a_, (z[i + group.first] - centres[i * n + r]) / widths[i * n + r]);
        p_.set(w[r], w[r] - 0.5 * a_ * a_);
      });
    });
    return;
  }
  const Flanks& f = group.flanks;
  p_.loop(count, [&](const Value& i) {
    p_.loop(n, [&](const Value& r) {
      const Value at = i * n + r;
      p_.set(a_, z[i + group.first] - f.upper[at]);
      p_.set(b1_, f.right[at]);
      p_.when(z[i + group.first] < f.lower[at], [&] {
        p_.set(a_, f.lower[at] - z[i + group.first]);
        p_.set(b1_, f.left[at]);
      });
      p_.when(a_ > 0.0, [&] {
        if (!std::isfinite(f.least)) return p_.set(alive[r], false);
        const Value flank = isLinear(group.shape) ? b1_ >= f.least && a_ < b1_ : b1_ >= f.least;
        p_.when(
            flank,
            [&] {
              p_.set(c_, a_ / b1_);
              if (isLinear(group.shape))
                p_.set(product[r], product[r] * (1.0 - c_));
              else
                p_.set(w[r], w[r] - 7.0 * c_ * c_);
            },
            [&] { p_.set(alive[r], false); });
      });
    });
  });
}

/// Where no rule fires the nearest one has all the weight.
void ModelCode::nearest(int output, const std::vector<Group>& groups, const Value& z) {
  const int n = static_cast<int>(layout_.model().submodels[place(output)].rules.size());
  const Value& w = weights[place(output)];
  const Value far = p_.works(prefix_ + "far" + std::to_string(output), Kind::kReal, n);
  p_.loop(n, [&](const Value& r) { p_.set(far[r], 0.0); });
  for (const Group& group : groups) {
    const Flanks& f = group.flanks;
    p_.loop(static_cast<int>(group.of.size()), [&](const Value& i) {
      p_.loop(n, [&](const Value& r) {
        const Value at = i * n + r;
        const Value lower = f.lower[at] - f.left[at], upper = f.upper[at] + f.right[at];
        p_.set(a_, 0.0);
        p_.when(z[i + group.first] < lower, [&] { p_.set(a_, lower - z[i + group.first]); });
        p_.when(z[i + group.first] > upper, [&] { p_.set(a_, z[i + group.first] - upper); });
        p_.set(b1_, upper - lower);
        if (std::isfinite(f.least_span))
          p_.when(b1_ >= f.least_span, [&] { p_.set(a_, a_ / b1_); });
        p_.set(far[r], far[r] + a_);
      });
    });
  }
  p_.set(n_, 0);
  p_.loop(n, [&](const Value& r) { p_.when(far[r] < far[n_], [&] { p_.set(n_, r); }); });
  p_.loop(n, [&](const Value& r) { p_.set(w[r], 0.0); });
  p_.set(w[n_], 1.0);
}

/// Antecedents by the shape of their sets: each group is one loop.
std::vector<ModelCode::Group> ModelCode::groupsOf(int output) const {
  const OutputModel& submodel = layout_.model().submodels[place(output)];
  std::vector<Group> groups;
  int first = 0;
  for (const MembershipShape shape :
       {MembershipShape::kGaussian, MembershipShape::kExponential, MembershipShape::kTrapezoidal}) {
    Group group{shape, {}, first, {}};
    group.flanks.name = "O" + std::to_string(output) + std::string(1, "GEL"[groups.size()]);
    const auto belongs = [&](const Membership& m) {
      return isLinear(m.shape) ? isLinear(shape) : m.shape == shape;
    };
    for (std::size_t i = 0; i < submodel.antecedents.size(); ++i) {
      if (!belongs(submodel.rules.front().antecedents[i])) continue;
      for (const Rule& rule : submodel.rules)
        require(belongs(rule.antecedents[i]), "export: model " + layout_.model().name,
                "sets of one shape on each antecedent");
      group.of.push_back(i);
    }
    first += static_cast<int>(group.of.size());
    groups.push_back(std::move(group));
  }
  return groups;
}

void ModelCode::fire(int output, const Value& state, const Value& d) {
  const OutputModel& submodel = layout_.model().submodels[place(output)];
  const int n = static_cast<int>(submodel.rules.size());
  const Value& w = weights[place(output)];
  if (n == 1) return p_.set(w[0], 1.0);
  require(!submodel.rules.front().multivariate, "export: model " + layout_.model().name,
          "sets on one variable each: multivariate sets are not exported");
  const auto crisp = [&](const Membership& m) {
    return isLinear(m.shape) ||
           (m.shape == MembershipShape::kExponential &&
            (m.parameters[0] == m.parameters[1] || m.parameters[2] == m.parameters[3]));
  };
  bool may_miss = false, linear = false;
  for (const Rule& rule : submodel.rules)
    for (const Membership& m : rule.antecedents) {
      may_miss = may_miss || crisp(m);
      linear = linear || isLinear(m.shape);
    }
  const std::string name = std::to_string(output);
  const Value alive = p_.works(prefix_ + "alive" + name, Kind::kBool, n),
              product = p_.works(prefix_ + "product" + name, Kind::kReal, n),
              z = p_.works(prefix_ + "z" + name, Kind::kReal,
                           static_cast<int>(submodel.antecedents.size()));
  p_.loop(n, [&](const Value& r) {
    p_.set(w[r], 0.0);
    p_.set(alive[r], true);
    p_.set(product[r], 1.0);
  });
  std::vector<Group> groups = groupsOf(output);
  for (Group& group : groups) {
    for (std::size_t i = 0; i < group.of.size(); ++i)
      p_.set(z[group.first + static_cast<int>(i)],
             placed(submodel.antecedents[group.of[i]], state, d));
    if (group.of.empty()) continue;
    if (may_miss || group.shape != MembershipShape::kGaussian)
      declareFlanks(output, group.of, group.flanks);
    degrees(output, group, z, alive, product);
  }
  p_.words("weights: the largest degree counts as 1");
  p_.set(n_, -1);
  p_.set(c_, 0.0);
  p_.loop(n, [&](const Value& r) {
    const Value better = n_ < 0 || w[r] > c_;
    p_.when(may_miss ? alive[r] && better : better, [&] {
      p_.set(c_, w[r]);
      p_.set(n_, r);
    });
  });
  p_.loop(n, [&](const Value& r) {
    p_.set(a_, ir::exponential(p_, w[r] - c_));
    if (linear) p_.set(a_, a_ * product[r]);
    if (may_miss) p_.when(!alive[r], [&] { p_.set(a_, 0.0); });
    p_.set(w[r], a_);
  });
  sum(w, n);
  // Where a rule fires the sum is one or more, but for linear flanks.
  p_.when(
      b1_ >= (linear ? kFaint : 0.5),
      [&] {
        p_.loop(n, [&](const Value& r) {
          p_.set(w[r], w[r] / b1_);
          if (linear) p_.clamp(w[r], 0.0, 1.0);
        });
      },
      [&] {
        if (may_miss) nearest(output, groups, z);
      });
}

/// b1_ := the sum, in the order of Eigen's with two numbers at a time.
void ModelCode::sum(const Value& w, int n) {
  const Value& part = part_;
  const int width = n < 4 ? 2 : 4, twos = n / 2 * 2;
  p_.loop(width, [&](const Value& i) { p_.set(part[i], w[i]); });
  p_.loop(n / 4 - 1, [&](const Value& k) {
    p_.loop(4, [&](const Value& i) { p_.set(part[i], part[i] + w[k * 4 + i + 4]); });
  });
  p_.loop(2, [&](const Value& i) {
    if (width == 4) p_.set(part[i], part[i] + part[i + 2]);
    if (width == 4 && twos % 4 == 2) p_.set(part[i], part[i] + w[i + (twos - 2)]);
  });
  p_.set(b1_, part[0] + part[1]);
  if (n > twos) p_.set(b1_, b1_ + w[n - 1]);
}

void ModelCode::blend(const Value& state, const Value& d) {
  p_.loop(b_.n_y * n_x(), [&](const Value& i) { p_.set(A[i], 0.0); });
  p_.loop(b_.n_y * b_.n_u, [&](const Value& i) { p_.set(B[i], 0.0); });
  for (int o = 0; o < b_.n_y; ++o) {
    const OutputModel& submodel = layout_.model().submodels[place(o)];
    if (partitionOf(o) == o) fire(o, state, d);
    const int n = static_cast<int>(submodel.rules.size()),
              m = static_cast<int>(submodel.regressors.size());
    std::vector<double> coefficients, offsets, target;
    for (const Rule& rule : submodel.rules) {
      offsets.push_back(rule.offset);
      for (Eigen::Index i = 0; i < rule.coefficients.size(); ++i)
        coefficients.push_back(rule.coefficients[i]);
    }
    const std::string name = "O" + std::to_string(o);
    const Value table_of = table(name + "Coefficients", coefficients),
                offset = table(name + "Offsets", offsets);
    const Value blended = p_.works(prefix_ + "k" + std::to_string(o), Kind::kReal, m);
    const Value& w = weights[place(o)];
    p_.set(g[o], 0.0);
    p_.loop(m, [&](const Value& i) { p_.set(blended[i], 0.0); });
    p_.loop(n, [&](const Value& r) {
      p_.set(g[o], g[o] + w[r] * offset[r]);
      p_.loop(m,
              [&](const Value& i) { p_.set(blended[i], blended[i] + w[r] * table_of[r * m + i]); });
    });
    for (int i = 0; i < m; ++i) {
      const Regressor& r = submodel.regressors[place(i)];
      if (r.kind == SignalKind::kInput && r.lag == 0)
        p_.set(B[o * b_.n_u + r.index], blended[i]);
      else if (r.kind == SignalKind::kDisturbance && r.lag == 0)
        p_.set(g[o], g[o] + blended[i] * d[r.index]);
      else
        p_.set(A[o * n_x() + static_cast<int>(placed(r, A, d).node().of[0]->number)], blended[i]);
    }
  }
}

namespace {

/// Calls for the first row and the number of rows of each signal of the kind.
template <typename Visit>
void eachSignal(const LocalModel& layout, SignalKind kind, const Visit& visit) {
  const TsModel& model = layout.model();
  const bool output = kind == SignalKind::kOutput;
  const int least = kind == SignalKind::kDisturbance ? 0 : 1;
  for (std::size_t i = 0; i < model.signals(kind).size(); ++i) {
    const int index = static_cast<int>(i);
    const int rows = std::max(model.maxLag(kind, index) + (output ? 1 : 0), least);
    const Eigen::Index first = output                       ? layout.outputState(index)
                               : kind == SignalKind::kInput ? layout.inputState(index, 1)
                                                            : layout.disturbanceState(index, 1);
    visit(index, static_cast<int>(first), rows);
  }
}

}  // namespace

void ModelCode::rest(const Value& state, const Value& y, const Value& u, const Value& d) {
  const auto fill = [&](SignalKind kind, const Value& from) {
    eachSignal(layout_, kind, [&](int index, int first, int rows) {
      p_.loop(rows, [&](const Value& i) { p_.set(state[i + first], from[index]); });
    });
  };
  fill(SignalKind::kOutput, y);
  fill(SignalKind::kInput, u);
  fill(SignalKind::kDisturbance, d);
}

void ModelCode::shift(const Value& state, const Value& y, const Value& u, const Value& d) {
  const auto push = [&](SignalKind kind, const Value& newest) {
    eachSignal(layout_, kind, [&](int index, int first, int rows) {
      if (rows == 0) return;
      p_.loop(rows - 1, [&](const Value& i) {
        p_.set(state[Value(first + rows - 1) - i], state[Value(first + rows - 2) - i]);
      });
      p_.set(state[first], newest[index]);
    });
  };
  push(SignalKind::kOutput, y);
  push(SignalKind::kInput, u);
  push(SignalKind::kDisturbance, d);
}

void ModelCode::eachShift(const std::function<void(int row)>& see) const {
  for (const SignalKind kind : {SignalKind::kOutput, SignalKind::kInput, SignalKind::kDisturbance})
    eachSignal(layout_, kind, [&](int, int first, int rows) {
      for (int i = first; i + 1 < first + rows; ++i) see(i);
    });
}

GuardCode::GuardCode(BlockParts& parts, const TsModel& model)
    : b_(parts),
      p_(parts.p),
      model_(model),
      known_(knowsDomain(model)),
      trust_(0),
      square_(0),
      nearest_(0),
      a_(0),
      move_(0),
      lower_(0),
      upper_(0),
      acting_(0),
      trust_out_(0) {
  const GuardParams& guard = parts.loop.guard;
  const std::string where = parts.loop.name + ": guard.";
  if (guard.enabled) {
    require(!parts.loop.fallback, where + "fallback",
            "no fallback: the exported block has none but its substitutes");
    require(guard.lock_samples == 0, where + "lock_samples",
            "0: locks are not looked for in the exported block");
    require(guard.growing_swings == 0, where + "growing_swings",
            "0: swings are not looked for in the exported block");
  }
  trust_ = p_.work("trust");
  square_ = p_.work("square");
  nearest_ = p_.work("nearest");
  a_ = p_.work("guardA");
  move_ = p_.work("guardMove");
  lower_ = p_.work("guardLower");
  upper_ = p_.work("guardUpper");
  acting_ = p_.work("acting", Kind::kBool);
  trust_out_ = p_.output("rTrust", Kind::kReal, "1 inside the data of the model, 0 far from them");
}

/// trust_ := processTrustOf() the outputs and disturbances.
void GuardCode::distance() {
  const int n = b_.n_y + b_.n_d;
  const auto row = [&](int i) { return Eigen::Index{i < b_.n_y ? i : i + b_.n_u}; };
  const auto value = [&](int i) { return i < b_.n_y ? b_.y[i] : b_.d[i - b_.n_y]; };
  double from = 0.0, width = kRangeFade;
  if (model_.domain.empty()) {
    p_.set(nearest_, 0.0);
    for (int i = 0; i < n; ++i) {
      const SignalInfo& s =
          i < b_.n_y ? model_.outputs[place(i)] : model_.disturbances[place(i - b_.n_y)];
      const double range = s.upper - s.lower;
      if (!std::isfinite(range) || range <= 0.0) continue;
      p_.set(a_, 0.0);
      p_.when(value(i) < s.lower, [&] { p_.set(a_, (s.lower - value(i)) / range); });
      p_.when(value(i) > s.upper, [&] { p_.set(a_, (value(i) - s.upper) / range); });
      p_.set(nearest_, nearest_ + a_ * a_);
    }
  } else {
    const ModelDomain& domain = model_.domain;
    from = domain.radius;
    width = std::max(kDomainFade * domain.radius, kRangeFade);
    std::vector<int> counted;
    for (int i = 0; i < n; ++i)
      if (std::isfinite(domain.scale[row(i)])) counted.push_back(i);
    std::vector<double> centres, inverse;
    for (Eigen::Index c = 0; c < domain.centres.cols(); ++c)
      for (const int i : counted) centres.push_back(domain.centres(row(i), c));
    const int m = static_cast<int>(counted.size());
    for (const int i : counted) inverse.push_back(1.0 / domain.scale[row(i)]);
    p_.set(nearest_, 1e24);
    if (m > 0) {
      const Value centre = p_.table("centres", centres), scale = p_.table("centreScale", inverse);
      const Value point = p_.works("point", Kind::kReal, m);
      for (int i = 0; i < m; ++i) p_.set(point[i], value(counted[place(i)]));
      p_.loop(static_cast<int>(domain.centres.cols()), [&](const Value& c) {
        p_.set(square_, 0.0);
        p_.loop(m, [&](const Value& j) {
          p_.set(a_, (point[j] - centre[c * m + j]) * scale[j]);
          p_.set(square_, square_ + a_ * a_);
        });
        p_.when(square_ < nearest_, [&] { p_.set(nearest_, square_); });
      });
    } else {
      p_.set(nearest_, 0.0);
    }
  }
  p_.set(trust_, 1.0);
  p_.when(nearest_ > from * from, [&] {
    p_.set(a_, (ir::squareRoot(p_, nearest_) - from) / width);
    p_.when(
        a_ >= 1.0, [&] { p_.set(trust_, 0.0); },
        [&] {
          p_.when(a_ > 0.0, [&] {
            p_.set(trust_, 0.5 * (1.0 + ir::cosine(p_, 3.14159265358979323846 * a_)));
          });
        });
  });
}

/// The nearest to a limit that moves of `move_` reach.
void GuardCode::reach(const Value& to, const Value& limit, const Value& i) {
  p_.set(to, limit);
  p_.clamp(to, b_.applied[i] - move_, b_.applied[i] + move_);
  p_.clamp(to, b_.lower[i], b_.upper[i]);
}

/// What an optimizer may ask for where the model is trusted: the law's own limits, and where there
/// is a guard what moves from the applied input reach.
void GuardCode::leaveAll(ClpCode& optimizer) {
  p_.loop(b_.n_u, [&](const Value& i) {
    p_.set(optimizer.least[i], b_.lower[i]);
    p_.set(optimizer.most[i], b_.upper[i]);
    if (!b_.loop.guard.enabled) return;
    p_.set(move_, b_.move[i]);
    reach(optimizer.least[i], b_.lower[i], i);
    reach(optimizer.most[i], b_.upper[i], i);
  });
}

void GuardCode::step(ClpCode* optimizer) {
  const GuardParams& guard = b_.loop.guard;
  if (optimizer) leaveAll(*optimizer);
  if (!known_) return;
  p_.words("how far the model is trusted here, and how far the input may move");
  distance();
  p_.set(trust_out_, trust_);
  if (!guard.enabled) return;
  const double width = guard.trust_high - guard.trust_low;
  const double first = std::max(0.5, guard.least_move);
  p_.set(acting_, false);
  p_.when(b_.ok && trust_ < guard.trust_high, [&] {
    p_.set(a_, 0.0);
    if (width > 0.0) {
      p_.set(a_, (trust_ - guard.trust_low) / width);
      p_.clamp(a_, 0.0, 1.0);
    }
    p_.set(a_, guard.least_move + (first - guard.least_move) * a_);
    p_.loop(b_.n_u, [&](const Value& i) {
      p_.set(move_, b_.move[i]);
      p_.when(a_ * (b_.upper[i] - b_.lower[i]) < move_,
              [&] { p_.set(move_, a_ * (b_.upper[i] - b_.lower[i])); });
      reach(lower_, b_.lower[i], i);
      reach(upper_, b_.upper[i], i);
      p_.when(b_.u[i] < lower_, [&] {
        p_.set(b_.u[i], lower_);
        p_.set(acting_, true);
      });
      p_.when(b_.u[i] > upper_, [&] {
        p_.set(b_.u[i], upper_);
        p_.set(acting_, true);
      });
      if (!optimizer) return;
      p_.set(optimizer->least[i], lower_);
      p_.set(optimizer->most[i], upper_);
    });
  });
  p_.when(acting_, [&] { p_.set(b_.source, static_cast<int>(ActionSource::kGuarded)); });
}

void GuardCode::begin() { p_.set(trust_out_, 1.0); }

PredictiveCode::PredictiveCode(BlockParts& parts, const PredictiveLawParams& params,
                               const TsModel& model)
    : b_(parts),
      p_(parts.p),
      law_(params),
      reference_(0),
      start_(0),
      dm_(0),
      past_(0),
      guard_(parts, model),
      pending_(0),
      bias_(0),
      clipped_(0) {
  require(!params.preview, parts.loop.name + ": controller.preview",
          "false: a block gets setpoints as they come and cannot look ahead");
  require(model.unmeasured.empty(), parts.loop.name + ": controller.observer.estimated",
          "nothing: the exported block estimates no disturbance");
  reference_ = p_.states("reference", Kind::kReal, b_.n_y);
  start_ = p_.state("startPending", Kind::kBool, 1);
  pending_ = p_.state("lawPending", Kind::kBool);
  bias_ = p_.states("lawBias", Kind::kReal, b_.n_u);
  past_ = b_.n_d > 0 ? p_.states("pastD", Kind::kReal, b_.n_d) : Value(0.0);
  dm_ = p_.works("modelD", Kind::kReal, std::max(b_.n_d, 1));
  clipped_ = p_.work("clipped", Kind::kBool);
}

void PredictiveCode::reset() {
  p_.loop(b_.n_y, [&](const Value& i) { p_.set(reference_[i], b_.y[i]); });
  p_.loop(b_.n_u, [&](const Value& i) { p_.set(bias_[i], 0.0); });
  p_.set(pending_, true);
  p_.set(start_, true);
}

void PredictiveCode::beginOptimizer(const LocalModel& model, int lead) {
  if (b_.loop.has_clp) clp_.emplace(b_, model, law_, lead);
}

void PredictiveCode::step() {
  for (int i = 0; i < b_.n_y && law_.reference_holdback.size() > 0; ++i)
    if (std::isfinite(law_.reference_holdback[i]))
      p_.clamp(reference_[i], b_.y[i] - law_.reference_holdback[i],
               b_.y[i] + law_.reference_holdback[i]);
  for (int i = 0; i < b_.n_d; ++i) p_.set(dm_[i], b_.d[i]);
  p_.when(
      start_,
      [&] {
        for (int i = 0; i < b_.n_d; ++i) p_.set(past_[i], dm_[i]);
        startModel();
      },
      [&] { advanceModel(); });
  p_.set(start_, false);
  if (clp_) clp_->begin(reference_, dm_);
  propose();
  p_.loop(b_.n_u, [&](const Value& i) {
    p_.when(!ir::sane(b_.u[i]), [&] {
      p_.set(b_.ok, false);
      p_.set(b_.u[i], b_.applied[i]);
    });
  });
  p_.set(clipped_, false);
  p_.when(
      b_.ok,
      [&] {
        const Value asked = p_.works("proposal", Kind::kReal, b_.n_u);
        p_.loop(b_.n_u, [&](const Value& i) {
          p_.when(
              pending_,
              [&] {
                p_.set(bias_[i], b_.applied[i] - b_.u[i]);
                p_.set(b_.u[i], b_.applied[i]);
              },
              [&] { p_.set(b_.u[i], b_.u[i] + bias_[i]); });
          p_.set(asked[i], b_.u[i]);
          if (clp_) p_.set(clp_->base[i], b_.u[i]);
          if (clp_) p_.set(clp_->bias[i], bias_[i]);
          p_.set(bias_[i], bias_[i] * law_.transfer_decay);
        });
        p_.set(pending_, false);
        clipInputs(b_, b_.u, b_.applied);
        p_.loop(b_.n_u, [&](const Value& i) {
          p_.when(b_.u[i] != asked[i], [&] { p_.set(clipped_, true); });
        });
      },
      [&] {
        p_.set(pending_, true);
        p_.loop(b_.n_u, [&](const Value& i) { p_.set(bias_[i], 0.0); });
      });
  p_.when(clipped_, [&] { p_.set(b_.source, static_cast<int>(ActionSource::kClipped)); });
  guard_.step(optimizer());
  keep();
  for (int i = 0; i < b_.n_d; ++i) p_.set(past_[i], dm_[i]);
  p_.when(!healthy(), [&] { p_.set(start_, true); });
  for (int i = 0; i < b_.n_y; ++i)
    p_.set(reference_[i], law_.reference_pole[i] * reference_[i] +
                              (1.0 - law_.reference_pole[i]) * b_.setpoint[i]);
}

}  // namespace fpc
