#include "export/math.hpp"

#include <cmath>
#include <iterator>

namespace fpc::ir {
namespace {

/// exp(x) = 2^n exp(r), |r| <= ln(2) / 2, exp(r) = 1 + r1 + r1^2 / 2 and a tail: r1 has so few bits
/// that its square is exact. Its rounding is that of the last sum alone but for one in 500.
void defineExponential(Program& p) {
  p.define("exp", [&](const Value& x) {
    const Value result = p.work("y"), n = p.work("n", Kind::kInt), high = p.work("high"),
                low = p.work("low"), r = p.work("r"), r1 = p.work("r1"), t = p.work("t"),
                half = p.work("half");
    // Of (exp(r) - 1 - r - r^2 / 2) / r^3, by its values at the zeros of a Chebyshev polynomial.
    constexpr double kTail[] = {2.0911264239196083e-09, 2.5100424157005067e-08,
                                2.755728291148268e-07,  2.7557268378684192e-06,
                                2.4801587317181886e-05, 0.00019841269863105968,
                                0.0013888888888886545,  0.008333333333330051,
                                0.041666666666666664,   0.16666666666666669};
    const double few = p.single ? 3072.0 : 100663296.0;  // 1.5 2^11, 2^26: the bits of r1
    p.set(result, 0.0);
    p.when(x >= p.smallestExponent() && x <= 0.0, [&] {
      p.set(n, floorOf(x * 1.44269504088896338700 + 0.5));
      p.set(high, x - toReal(n) * 6.93147180369123816490e-01);
      p.clamp(high, -0.35, 0.35);  // it is: a proof needs the words
      p.set(low, toReal(n) * 1.90821492927058770002e-10);
      p.set(r, high - low);
      p.set(r1, (r + few) - few);
      p.set(low, (high - r1) - low);  // the rest of r
      Value sum = kTail[0];
      for (std::size_t k = 1; k < std::size(kTail); ++k) sum = kTail[k] + r * sum;
      p.set(t, low * (r1 + 0.5 * low) + r * r * r * sum);
      p.set(high, r1 + 0.5 * r1 * r1);
      p.set(result, 1.0 + high);
      p.set(result, result + ((high - (result - 1.0)) + (low + t)));
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
