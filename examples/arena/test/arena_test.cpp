// Each plant against its publication: operating points, gains, poles and zeros that are known on
// paper. Only headers that fmbpc installs. Ends with the number of things that are not so.
#include <fmbpc/plant/plant.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

using fpc::Vector;
using Matrix = Eigen::MatrixXd;

int failures = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::printf("not so: %s\n", what);
  ++failures;
}

void expectNear(double value, double known, double tolerance, const char* what) {
  if (std::abs(value - known) <= tolerance) return;
  std::printf("not so: %s is %.6g, known as %.6g\n", what, value, known);
  ++failures;
}

Vector nominal(const std::vector<fpc::Quantity>& quantities) {
  Vector values(static_cast<Eigen::Index>(quantities.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values[i] = quantities[static_cast<std::size_t>(i)].nominal;
  return values;
}

/// A plant at a point; x, u and d may be moved before it is asked.
struct Point {
  explicit Point(const std::string& name, const fpc::PlantParameters& parameters = {})
      : plant(fpc::makePlant(name, parameters)),
        x(nominal(plant->description().states)),
        u(nominal(plant->description().inputs)),
        d(nominal(plant->description().disturbances)) {}
  Vector rate(const Vector& state, const Vector& input) const {
    Vector value(x.size());
    plant->derivatives(state, input, d, value);
    return value;
  }
  /// Central differences.
  Matrix byState() const {
    return slope(x, [&](const Vector& at) { return rate(at, u); });
  }
  Matrix byInput() const {
    return slope(u, [&](const Vector& at) { return rate(x, at); });
  }
  /// Newton from here; u and d stay.
  void settle() {
    for (int i = 0; i < 50; ++i) x -= byState().partialPivLu().solve(rate(x, u));
    expect(rate(x, u).norm() < 1e-7, "a steady state is found");
  }
  /// Steady gains of the states.
  Matrix gain() const { return -byState().partialPivLu().solve(byInput()); }

  template <typename Function>
  static Matrix slope(const Vector& at, const Function& f) {
    Matrix slopes(f(at).size(), at.size());
    for (Eigen::Index j = 0; j < at.size(); ++j) {
      const double step = 1e-6 * std::max(1e-2, std::abs(at[j]));
      Vector more = at, less = at;
      more[j] += step;
      less[j] -= step;
      slopes.col(j) = (f(more) - f(less)) / (2.0 * step);
    }
    return slopes;
  }

  std::unique_ptr<fpc::Plant> plant;
  Vector x, u, d;
};

/// Transmission zeros of a square plant with outputs C x: finite eigenvalues of the pencil, here as
/// roots of det(C adj(sI - A) B) by the gain at a shift: s is a zero where the gain matrix at s is
/// singular.
double gainDeterminant(const Matrix& A, const Matrix& B, const Matrix& C, double s) {
  const Matrix shifted = s * Matrix::Identity(A.rows(), A.cols()) - A;
  return (C * shifted.partialPivLu().solve(B)).determinant();
}

/// The zero between two points with gains of opposite signs.
double zeroBetween(const Matrix& A, const Matrix& B, const Matrix& C, double low, double high) {
  const double at_low = gainDeterminant(A, B, C, low);
  expect(at_low * gainDeterminant(A, B, C, high) < 0.0, "a zero lies between");
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (gainDeterminant(A, B, C, middle) * at_low > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// johansson2000, table 2 and section III: operating points, time constants, zeros.
void fourTanks() {
  const Matrix levels = Matrix::Identity(2, 4);
  {
    const Point p("four_tanks");
    const double level[] = {12.4, 12.7, 1.8, 1.4}, constant[] = {62.0, 90.0, 23.0, 30.0};
    const Matrix A = p.byState(), B = p.byInput();
    for (int i = 0; i < 4; ++i) {
      expectNear(p.x[i], level[i], 0.2, "level of the minimum-phase point");
      expectNear(-1.0 / A(i, i), constant[i], 1.0, "time constant of the minimum-phase point");
    }
    expectNear(zeroBetween(A, B, levels, -0.030, -0.0165), -0.018, 0.001, "the slow zero");
    expectNear(zeroBetween(A, B, levels, -0.10, -0.046), -0.060, 0.002, "the fast zero");
    expectNear(0.5 * p.gain()(0, 0), 2.6, 0.05, "gain v1 -> y1 [V/V]");
    expectNear(0.5 * p.gain()(1, 1), 2.8, 0.05, "gain v2 -> y2 [V/V]");
  }
  {
    Point p("four_tanks",
            {{"pump_1", 3.14}, {"pump_2", 3.29}, {"split_1", 0.43}, {"split_2", 0.34}});
    p.u.setConstant(3.15);
    p.settle();
    const double level[] = {12.6, 13.0, 4.8, 4.9}, constant[] = {63.0, 91.0, 39.0, 56.0};
    const Matrix A = p.byState(), B = p.byInput();
    for (int i = 0; i < 4; ++i) {
      expectNear(p.x[i], level[i], 0.2, "level of the non-minimum-phase point");
      expectNear(-1.0 / A(i, i), constant[i], 1.1, "time constant of the non-minimum-phase point");
    }
    expectNear(zeroBetween(A, B, levels, 0.001, 0.05), 0.013, 0.001, "the right zero");
    expectNear(zeroBetween(A, B, levels, -0.10, -0.030), -0.057, 0.002, "the left zero");
  }
}

/// chen1995: the operating point, and a maximum of the yield over the feed.
void vanDeVusse() {
  const Point p("van_de_vusse");
  const double known[] = {2.14, 1.09, 114.2, 112.9};
  for (int i = 0; i < 4; ++i) expectNear(p.x[i], known[i], i < 2 ? 0.005 : 0.05, "operating point");
  expect(p.rate(p.x, p.u).norm() < 1e-7, "it rests there");
  // At a temperature that is held the yield is k1 cA / (F + k2): its slope over F by the balances.
  const auto yield = [&](double feed) {
    const double k1 = 1.287e12 * std::exp(-9758.3 / (114.191 + 273.15));
    const double k3 = 9.043e9 * std::exp(-8560.0 / (114.191 + 273.15));
    const double b = feed + k1, cA = (-b + std::sqrt(b * b + 4.0 * k3 * feed * 5.1)) / (2.0 * k3);
    return k1 * cA / (feed + k1);
  };
  expect(yield(11.0) > yield(9.0) && yield(20.0) < yield(18.0), "the gain changes its sign");
  Point held("van_de_vusse");
  held.u[0] = 7.0;
  held.x[2] = 114.191;
  for (int i = 0; i < 50; ++i) {  // cA and cB alone
    const Matrix A = held.byState().topLeftCorner(2, 2);
    held.x.head(2) -= A.partialPivLu().solve(held.rate(held.x, held.u).head(2));
  }
  expectNear(held.x[1], yield(7.0), 1e-9, "yield at F = 7/h by its balance");
}

/// rawlings2017, example 3.22: a stable and an unstable state.
void hicksRay() {
  Point p("hicks_ray");
  expectNear(p.x[0], 0.2632, 1e-3, "c of the unstable state");
  expectNear(p.x[1], 0.6519, 1e-9, "T of the unstable state");
  const auto poles = p.byState().eigenvalues();
  expect(poles.real().minCoeff() > 0.0, "both poles are in the right half plane");
  p.x << 0.9831, 0.3918;
  p.u[0] = 0.7583;
  p.settle();
  expectNear(p.x[0], 0.9831, 1e-3, "c of the cold state");
  expectNear(p.x[1], 0.3918, 1e-3, "T of the cold state");
  expect(p.byState().eigenvalues().real().maxCoeff() < 0.0, "the cold state is stable");
}

/// prett1987: gains, what moves them, dead times.
void shell() {
  const Point low("shell_fractionator", {{"epsilon_1", -1.0}, {"epsilon_5", 1.0}});
  Point p("shell_fractionator");
  expect(p.plant->description().outputs.size() == 7, "seven outputs");
  const auto reply = [](const Point& at, int input, double value, int steps) {
    const auto stepper = at.plant->makeStepper(60.0);
    Vector x = at.x, u = at.u;
    stepper->reset(u, at.d);
    if (input < 3) u[input] = value;
    Vector d = at.d;
    if (input >= 3) d[input - 3] = value;
    for (int k = 0; k < steps; ++k) stepper->advance(x, u, d);
    return Vector(x.head(7));
  };
  const Vector settled = reply(p, 0, 0.1, 5000);
  expectNear(settled[0], 0.405, 1e-6, "gain u1 -> y1, 4.05");
  expectNear(settled[6], 0.438, 1e-6, "gain u1 -> y7, 4.38");
  expectNear(reply(low, 0, 0.1, 5000)[1], 0.210, 1e-6,
             "gain u1 -> y2 at epsilon_1 = -1, 5.39 - 3.29");
  expectNear(reply(low, 4, 0.1, 5000)[6], 0.144, 1e-6,
             "gain l2 -> y7 at epsilon_5 = 1, 1.26 + 0.18");
  expectNear(reply(p, 1, 0.1, 28)[0], 0.0, 1e-12, "y1 has not heard of u2 after 28 min");
  expect(reply(p, 1, 0.1, 29)[0] > 1e-4, "but after 29");
  expectNear(reply(p, 2, 0.1, 19)[6], 0.72 * (1.0 - std::exp(-1.0)), 1e-9,
             "u3 -> y7, a lag of 19 min");
}

/// luyben2003: K (1 - 0.418 s) / (s (1.06 s + 1)).
void drum() {
  const Point p("drum_level");
  const Matrix A = p.byState(), B = p.byInput();
  Matrix C(1, 3);
  for (int i = 0; i < 3; ++i) {
    Vector y(1);
    p.plant->algebraic(Vector::Unit(3, i), p.u, p.d, y);
    C(0, i) = y[0];
  }
  for (const double s : {0.5, 1.0, 5.0})
    expectNear(gainDeterminant(A, B, C, s), 0.547 * (1.0 - 0.418 * s) / (s * (1.06 * s + 1.0)),
               1e-8, "transfer function of the drum");
  expectNear(zeroBetween(A, B, C, 1.0, 5.0), 1.0 / 0.418, 1e-6, "its zero");
}

/// hedengren2019: slopes of the linearised balance of one heater.
void heaters() {
  Point p("two_heaters", {{"area_between", 0.0}, {"area", 0.0012}, {"transfer", 5.0}});
  p.x.setConstant(23.0);
  p.u.setZero();
  expect(p.rate(p.x, p.u).norm() < 1e-12, "without heat it rests at the air's temperature");
  const double radiation = 4.0 * 0.9 * 5.67e-8 * std::pow(296.15, 3);
  expectNear(p.byState()(0, 0), -(5.0 + radiation) * 0.0012 / 2.0, 1e-8, "gamma");
  expectNear(p.byInput()(0, 0), 0.01 / 2.0, 1e-9, "beta");
  const Point both("two_heaters");
  expectNear(0.01 * 40.0 + 0.0075 * 40.0,
             1e-3 * (10.0 * (both.x[0] + both.x[1] - 46.0) +
                     0.9 * 5.67e-8 *
                         (std::pow(both.x[0] + 273.15, 4) + std::pow(both.x[1] + 273.15, 4) -
                          2.0 * std::pow(296.15, 4))),
             1e-9, "what the heaters give the air takes");
}

/// zenger2009: the dead time is the pipe's volume over the flow.
void mixing() {
  for (const double cold : {0.5, 1.1}) {
    Point p("mixing_tank");
    const double hot = 0.5, flow = hot + cold;
    p.u[0] = hot;
    p.d[0] = cold;
    p.x.setConstant((hot * 60.0 + cold * 10.0) / flow);
    const auto stepper = p.plant->makeStepper(5.0);
    stepper->reset(p.u, p.d);
    Vector x = p.x;
    for (int k = 0; k < 20; ++k) stepper->advance(x, p.u, p.d);
    expect((x - p.x).norm() < 1e-9, "it rests");
    p.d[1] += 10.0;  // the hot water, flows as they were
    const double dead_s = 40.0 / flow, lag_s = 40.0 / flow, rise = 10.0 * hot / flow;
    for (int k = 1; k <= 30; ++k) {
      stepper->advance(x, p.u, p.d);
      const double since = 5.0 * k - dead_s;
      const double known = since > 0.0 ? rise * (1.0 - std::exp(-since / lag_s)) : 0.0;
      expectNear(x[1] - p.x[1], known, 1e-9, "thermometer after a step of the hot water");
    }
  }
}

/// henson1994: the operating point, and water without carbonate.
void neutralisation() {
  const Point p("ph_neutralisation");
  Vector y(1);
  p.plant->algebraic(p.x, p.u, p.d, y);
  expectNear(p.x[0], 14.0, 0.05, "level");
  expectNear(p.x[1], -0.432, 0.005, "Wa");
  expectNear(p.x[2], 0.528, 0.005, "Wb");
  expectNear(y[0], 7.0, 0.05, "pH");
  const auto pure = [&](double charge) {
    p.plant->algebraic((Vector(3) << 14.0, charge, 0.0).finished(), p.u, p.d, y);
    return y[0];
  };
  expectNear(pure(0.0), 7.0, 1e-9, "pH of water");
  expectNear(pure(1.0), 3.0, 1e-6, "pH of 1 mmol/l of strong acid");
  expectNear(pure(-1.0), 11.0, 1e-6, "pH of 1 mmol/l of strong base");
}

}  // namespace

int main() {
  fourTanks();
  vanDeVusse();
  hicksRay();
  shell();
  drum();
  heaters();
  mixing();
  neutralisation();
  return failures;
}
