#include "export/math.hpp"

#include <cmath>

namespace fpc::ir {
namespace {

/// exp(r) - 1 = 2 r / (2 - (r - r^2 c(r^2))) - as fdlibm has it, |r| <= ln(2) / 2.
void defineExponential(Program& p) {
  p.define("exp", [&](const Value& x) {
    const Value result = p.work("y"), n = p.work("n", Kind::kInt), high = p.work("high"),
                low = p.work("low"), r = p.work("r"), t = p.work("t"), c = p.work("c"),
                half = p.work("half");
    p.set(result, 0.0);
    p.when(x >= p.smallestExponent() && x <= 0.0, [&] {
      p.set(n, floorOf(x * 1.44269504088896338700 + 0.5));
      p.set(high, x - toReal(n) * 6.93147180369123816490e-01);
      p.clamp(high, -0.35, 0.35);  // it is: a proof needs the words
      p.set(low, toReal(n) * 1.90821492927058770002e-10);
      p.set(r, high - low);
      p.set(t, r * r);
      p.set(
          c,
          r - t * (1.66666666666666019037e-01 +
                   t * (-2.77777777770155933842e-03 +
                        t * (6.61375632143793436117e-05 +
                             t * (-1.65339022054652515390e-06 + t * 4.13813679705723846039e-08)))));
      p.set(result, 1.0 - ((low - (r * c) / (2.0 - c)) - high));
      p.set(n, -n);
      p.set(half, 0.5);
      p.loop(10, [&](const Value&) {  // 2^-n by its bits: exact
        p.when(n % 2 == 1, [&] { p.set(result, result * half); });
        p.set(half, half * half);
        p.set(n, n / 2);
      });
    });
    return result;
  });
}

void defineSquareRoot(Program& p) {
  p.define("sqrt", [&](const Value& x) {
    const Value result = p.work("y"), m = p.work("m"), scale = p.work("scale");
    p.set(result, 0.0);
    p.set(m, x);
    p.set(scale, 1.0);
    p.when(x > 1e-30, [&] {
      for (const double step : {256.0, 2.0})  // into [1, 4)
        p.loop(8, [&](const Value&) {
          p.when(m >= step * step, [&] {
            p.set(m, m / (step * step));
            p.set(scale, scale * step);
          });
          p.when(m < 1.0 / (step == 2.0 ? 1.0 : step * step), [&] {
            p.set(m, m * (step * step));
            p.set(scale, scale / step);
          });
        });
      p.set(result, 0.5 + m * 0.5);
      p.loop(6, [&](const Value&) { p.set(result, (result + m / result) * 0.5); });
      p.set(result, result * scale);
    });
    return result;
  });
}

/// By sin(pi/2 - x), a series in the square: |pi/2 - x| <= pi/2.
void defineCosine(Program& p) {
  p.define("cos", [&](const Value& x) {
    const Value result = p.work("y"), z = p.work("z"), t = p.work("t");
    p.set(z, 1.57079632679489661923 - x);
    p.set(t, z * z);
    Value sum = 0.0;
    double factor = 1.0;
    std::vector<double> coefficients;
    for (int k = 0; k < 12; ++k) {
      coefficients.push_back((k % 2 == 0 ? 1.0 : -1.0) / factor);
      factor *= (2.0 * k + 2.0) * (2.0 * k + 3.0);
    }
    sum = coefficients.back();
    for (std::size_t k = coefficients.size() - 1; k-- > 0;) sum = coefficients[k] + t * sum;
    p.set(result, z * sum);
    return result;
  });
}

}  // namespace

Value exponential(Program& p, const Value& x) {
  if (!p.defined("exp")) defineExponential(p);
  return p.call("exp", x);
}

Value squareRoot(Program& p, const Value& x) {
  if (!p.defined("sqrt")) defineSquareRoot(p);
  return p.call("sqrt", x);
}

Value cosine(Program& p, const Value& x) {
  if (!p.defined("cos")) defineCosine(p);
  return p.call("cos", x);
}

}  // namespace fpc::ir
