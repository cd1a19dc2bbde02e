// What goes in comes out, is stored or leaves as gas: by hand from the Petersen matrix and from the
// plant's own derivatives along a run.
#include <gtest/gtest.h>

#include "plant/bsm1/stepper.hpp"
#include "plant/bsm1_fixture.hpp"

namespace fpc {
namespace plant_bsm1_balance_test {

using namespace bsm1;  // NOLINT(google-build-using-namespace)

/// Content of COD and nitrogen in a unit of each component; oxygen is negative COD, nitrate lacks
/// the oxygen that nitrification took, and gas is what denitrification makes.
Components codOf() {
  Components c{};
  for (const Component i : {kSI, kSS, kXI, kXS, kXBH, kXBA, kXP}) c[i] = 1.0;
  c[kSO] = -1.0;
  c[kSNO] = -4.57;
  return c;
}
Components nitrogenOf(const Asm1& p) {
  Components c{};
  for (const Component i : {kSNO, kSNH, kSND, kXND}) c[i] = 1.0;
  c[kXBH] = c[kXBA] = p.i_XB;
  c[kXP] = p.i_XP;
  return c;
}
double dot(const Components& a, const Components& b) {
  double sum = 0.0;
  for (int i = 0; i < kComponents; ++i) sum += a[i] * b[i];
  return sum;
}

TEST(Bsm1Balance, EveryProcessKeepsNitrogenAndCod) {
  const Asm1 p;
  const auto nu = stoichiometry(p);
  for (int j = 0; j < kProcesses; ++j) {
    const double gas = j == 1 ? (1.0 - p.Y_H) / (2.86 * p.Y_H) : 0.0;
    EXPECT_NEAR(dot(nu[j], nitrogenOf(p)) + gas, 0.0, 1e-12) << "process " << j + 1;
    EXPECT_NEAR(dot(nu[j], codOf()) - 1.71 * gas, 0.0, 1e-12) << "process " << j + 1;
  }
}

TEST(Bsm1Balance, ConversionIsTheMatrixTimesTheRates) {
  const Asm1 p;
  TankTable z{}, rate;
  for (int c = 0; c < kComponents; ++c)
    for (int t = 0; t < kWidth; ++t) z[c][t] = 0.3 + 1.7 * c + 0.9 * t + (c % 3) * 20.0;
  conversion(p, z, rate);
  const auto rho = processRates(p, z);
  const auto nu = stoichiometry(p);
  for (int c = 0; c < kComponents; ++c)
    for (int t = 0; t < kTanks; ++t) {
      double sum = 0.0, size = 1.0;
      for (int j = 0; j < kProcesses; ++j) {
        sum += nu[j][c] * rho[j][t];
        size += std::abs(nu[j][c] * rho[j][t]);
      }
      EXPECT_NEAR(rate[c][t], sum, 1e-12 * size) << kComponentNames[c];
    }
}

class Balances : public ::testing::Test {
 protected:
  WorksParams works;
  WorksState x;
  Drive drive;

  void SetUp() override {
    const auto plant = makePlant("bsm1");
    const Vector start = nominalOf(plant->description().states);
    unpack(start.data(), x.z, x.settler);
    drive.in.influent = {30.0, 69.5, 51.2,  202.32, 28.17, 0.0, 0.0,
                         0.0,  0.0,  31.56, 6.95,   10.59, 7.0};
    drive.in.Q_intr = 30000.0;
    drive.in.Q_r = 18446.0;
    drive.in.Q_w = 385.0;
    drive.in.KLa = {0.0, 0.0, 200.0, 180.0, 60.0};
    drive.in.dose[1] = 1.0;
  }
  /// A daily rhythm of flow and ammonium.
  void setTime(double days) {
    const double wave = std::sin(6.283185307179586 * days);
    drive.in.Q_in = 18446.0 * (1.0 + 0.4 * wave);
    drive.in.influent[kSNH] = 31.56 * (1.0 + 0.3 * wave);
  }
  double stored(const Components& content) const;
  double inflow(const Components& content, bool nitrogen) const;
};

double Balances::stored(const Components& content) const {
  double sum = 0.0;
  for (int t = 0; t < kTanks; ++t)
    for (int c = 0; c < kComponents; ++c) sum += works.volume[t] * content[c] * x.z[c][t];
  return sum;
}

/// Influent and returned sludge minus what goes to the settler, plus air and carbon, minus gas.
double Balances::inflow(const Components& content, bool nitrogen) const {
  const SettlerFlows flows = settlerFlows(drive.in);
  Components last, returned;
  for (int c = 0; c < kComponents; ++c) last[c] = returned[c] = x.z[c][kTanks - 1];
  const double ratio = x.settler.solids[kLayers - 1] / solids(works, x.z, kTanks - 1);
  for (const Component c : kParticulates) returned[c] *= ratio;
  for (std::size_t s = 0; s < kSolubles.size(); ++s)
    returned[kSolubles[s]] = x.settler.solubles[s][kLayers - 1];
  double sum = drive.in.Q_in * dot(content, drive.in.influent) +
               drive.in.Q_r * dot(content, returned) - flows.feed * dot(content, last);
  const auto rho = processRates(works.asm1, x.z);
  const Asm1& p = works.asm1;
  for (int t = 0; t < kTanks; ++t) {
    const double gas = (1.0 - p.Y_H) / (2.86 * p.Y_H) * rho[1][t] * works.volume[t];
    sum -= nitrogen ? gas : -1.71 * gas;
    if (nitrogen) continue;
    sum -= works.volume[t] * drive.in.KLa[t] * (works.oxygen_saturation - x.z[kSO][t]);
    sum += drive.in.dose[t] * kCarbonSource;
  }
  return sum;
}

// Simpson's rule over pieces of 2 x 1e-4 d, the plant's own steps within them; the settler moves
// once per call here.
TEST_F(Balances, TanksKeepNitrogenAndCodOverSevenDays) {
  WorksStepper stepper(works, nullptr, 1);
  const Components contents[] = {nitrogenOf(works.asm1), codOf()};
  double before[2], in[2] = {0.0, 0.0}, through[2] = {0.0, 0.0};
  for (int i = 0; i < 2; ++i) before[i] = stored(contents[i]);
  constexpr int kSteps = 35000;
  constexpr double kLength = 7.0 / kSteps;
  for (int k = 0; k < kSteps; ++k) {
    setTime((k + 0.5) * kLength);
    double first[2], middle[2];
    for (int i = 0; i < 2; ++i) first[i] = inflow(contents[i], i == 0);
    stepper.advance(x, drive, 0.5 * kLength);
    for (int i = 0; i < 2; ++i) middle[i] = inflow(contents[i], i == 0);
    stepper.advance(x, drive, 0.5 * kLength);
    for (int i = 0; i < 2; ++i) {
      in[i] += kLength / 6.0 * (first[i] + 4.0 * middle[i] + inflow(contents[i], i == 0));
      through[i] += kLength * drive.in.Q_in * dot(contents[i], drive.in.influent);
    }
  }
  for (int i = 0; i < 2; ++i)
    EXPECT_NEAR(stored(contents[i]) - before[i], in[i], 1e-6 * through[i]) << i;
}

TEST_F(Balances, SettlerKeepsSludgeAndSolublesOverSevenDays) {
  const auto content = [&](int what) {
    const Layers& layers = what < 0 ? x.settler.solids : x.settler.solubles[what];
    double sum = 0.0;
    for (const double l : layers) sum += 600.0 * l;
    return sum;
  };
  const auto in = [&](int what) {
    const SettlerFlows flows = settlerFlows(drive.in);
    const Layers& layers = what < 0 ? x.settler.solids : x.settler.solubles[what];
    const double feed = what < 0 ? solids(works, x.z, kTanks - 1) : feedSolubles(x.z)[what];
    return flows.feed * feed - flows.effluent * layers[0] - flows.underflow * layers[kLayers - 1];
  };
  SettlerState rate;
  double moved = 0.0;
  for (int k = 0; k < 7 * 96; ++k) {
    setTime(k / 96.0);
    settle(works.settler, settlerFlows(drive.in), x.settler, solids(works, x.z, kTanks - 1),
           feedSolubles(x.z), rate);
    for (int what = -1; what < static_cast<int>(kSolubles.size()); ++what) {
      const Layers& change = what < 0 ? rate.solids : rate.solubles[what];
      double sum = 0.0;
      for (const double l : change) sum += 600.0 * l;
      const double size = settlerFlows(drive.in).feed * (1.0 + content(what) / 6000.0);
      EXPECT_NEAR(sum, in(what), 1e-9 * size) << what << " at sample " << k;
      moved += std::abs(sum);
    }
    WorksStepper(works, nullptr, 1).advance(x, drive, 1.0 / 96.0);
  }
  EXPECT_GT(moved, 1.0) << "nothing was tested at rest";
}

}  // namespace plant_bsm1_balance_test
}  // namespace fpc
