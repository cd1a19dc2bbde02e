// Indices of a record made by hand, and of short runs of the plant.
#include "study/evaluate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace study_evaluate_test {

const char* const kComponents[] = {"S_I", "S_S",  "X_I",  "X_S",  "X_BH", "X_BA", "X_P",
                                   "S_O", "S_NO", "S_NH", "S_ND", "X_ND", "S_ALK"};

/// Everything 0 but what a test sets; `rows` rows, one every `hours`.
class ByHand {
 public:
  ByHand(Eigen::Index rows, double hours) {
    add("time");
    for (const char* name : kComponents) {
      for (int t = 1; t <= 5; ++t) add(std::string(name) + std::to_string(t));
      if (name[0] == 'S') add(std::string(name) + "_L1");
      add(std::string(name) + "_in");
    }
    for (int i = 1; i <= 10; ++i) add("TSS_L" + std::to_string(i));
    for (const char* name : {"Q_in", "KLa3", "KLa4", "KLa5", "Qintr", "Qr", "Qw", "dose2"})
      add(name);
    table.values = Matrix::Zero(rows, static_cast<Eigen::Index>(table.names.size()));
    for (Eigen::Index r = 0; r < rows; ++r) table.values(r, 0) = static_cast<double>(r) * hours;
    set("Q_in", 1000.0);
    set("X_BH5", 400.0);  // 300 g SS/m3
  }
  void set(const std::string& name, double value) {
    table.values.col(table.column(name)).setConstant(value);
  }
  void set(const std::string& name, Eigen::Index row, double value) {
    table.values(row, table.column(name)) = value;
  }
  CsvTable table;

 private:
  void add(const std::string& name) {
    table.names.push_back(name);
    table.units.emplace_back();
  }
};

TEST(Evaluate, EnergyAndCarbonAreWeightedAsPrinted) {
  ByHand run(5, 0.25);
  run.set("KLa3", 240.0);
  run.set("KLa4", 10.0);
  run.set("Qintr", 55338.0);
  run.set("Qr", 18446.0);
  run.set("Qw", 385.0);
  run.set("dose2", 2.0);
  const EffluentReport r = evaluateEffluent(run.table);
  EXPECT_EQ(r.samples, 4U);
  EXPECT_NEAR(r.AE, 8.0 / 1800.0 * 1333.0 * 250.0, 1e-9);
  EXPECT_NEAR(r.PE, 0.004 * 55338.0 + 0.008 * 18446.0 + 0.05 * 385.0, 1e-9);
  EXPECT_NEAR(r.ME, 0.12 * (1000.0 + 1000.0 + 1333.0 + 1333.0), 1e-9) << "all but tank 3";
  EXPECT_NEAR(r.EC, 800.0, 1e-9);
  EXPECT_NEAR(r.OCI, r.AE + r.PE + 5.0 * r.SP + 3.0 * 800.0 + r.ME, 1e-9);
}

TEST(Evaluate, TheEffluentCarriesTheLastTanksSludgeInProportion) {
  ByHand run(5, 0.25);
  run.set("TSS_L1", 3.0);  // a hundredth of the last tank's
  run.set("S_NO_L1", 5.0);
  run.set("S_NH_L1", 2.0);
  const EffluentReport r = evaluateEffluent(run.table);
  const double cod = 4.0, nkj = 2.0 + 0.08 * 4.0, bod = 0.25 * 0.92 * 4.0;
  EXPECT_NEAR(r.EQI, 2.0 * 3.0 + cod + 30.0 * nkj + 10.0 * 5.0 + 2.0 * bod, 1e-9);
  EXPECT_NEAR(r.limit("TN").mean, nkj + 5.0, 1e-12);
  EXPECT_NEAR(r.limit("COD").mean, cod, 1e-12);
  const EffluentReport old = evaluateEffluent(run.table, {-1.0, -1.0, true});
  EXPECT_NEAR(old.EQI, 2.0 * 3.0 + cod + 20.0 * (nkj + 5.0) + 2.0 * bod, 1e-9);
}

TEST(Evaluate, SludgeIsWhatLeavesAndWhatIsStored) {
  ByHand run(9, 0.25);
  run.set("TSS_L10", 6000.0);
  run.set("Qw", 385.0);
  for (Eigen::Index k = 0; k < 9; ++k) run.set("TSS_L5", k, 10.0 * static_cast<double>(k));
  const EffluentReport r = evaluateEffluent(run.table);
  const double stored = 600.0 * 70.0 / 1000.0;  // of samples 0 to 7
  EXPECT_NEAR(r.SP, 6000.0 * 0.385 + stored / (2.0 / 24.0), 1e-9);
}

TEST(Evaluate, ViolationsAreSharesAndCrossings) {
  ByHand run(11, 0.25);
  for (const Eigen::Index k : {0, 1, 4, 7, 8}) run.set("S_NH_L1", k, 5.0);
  const EffluentReport r = evaluateEffluent(run.table);
  EXPECT_NEAR(r.limit("NH").share_percent, 50.0, 1e-12);
  EXPECT_EQ(r.limit("NH").crossings, 3);
  EXPECT_EQ(r.limit("NH").percentile_95, 5.0);
  EXPECT_EQ(r.limit("TSS").crossings, 0);
}

TEST(Evaluate, TheLastSevenDaysAreJudgedAndFineRecordsThinned) {
  ByHand run(10 * 24 * 12 + 1, 1.0 / 12.0);  // 10 d, every 5 min
  const EffluentReport r = evaluateEffluent(run.table);
  EXPECT_EQ(r.samples, 672U);
  EXPECT_NEAR(r.days, 7.0, 1e-9);
  EvaluateParams day;
  day.from_h = 24.0;
  day.to_h = 48.0;
  EXPECT_EQ(evaluateEffluent(run.table, day).samples, 96U);
}

TEST(Evaluate, TrueValuesStandForMeasuredOnes) {
  ByHand run(3, 0.25);
  run.table.names[static_cast<std::size_t>(run.table.column("S_NH_L1"))] = "S_NH_L1_true";
  run.set("S_NH_L1_true", 3.0);
  EXPECT_NEAR(evaluateEffluent(run.table).limit("NH").mean, 3.0, 1e-12);
}

// prctile of 1 to 10: 0.95 * 10 + 0.5 = 10.0, and of 1 to 20 the middle of 19 and 20.
TEST(Evaluate, ThePercentileIsTheBenchmarkUsersOwn) {
  for (const Eigen::Index n : {10, 20}) {
    ByHand run(n + 1, 0.25);
    for (Eigen::Index k = 0; k < n; ++k)
      run.set("S_NH_L1", n - 1 - k, 1.0 + static_cast<double>(k));
    EXPECT_NEAR(evaluateEffluent(run.table).limit("NH").percentile_95, n == 10 ? 10.0 : 19.5,
                1e-12);
  }
}

TEST(Evaluate, TimesAreReadInTheUnitOfTheirHeader) {
  ByHand run(10 * 96 + 1, 0.25 / 24.0);
  run.table.units[0] = "d";
  const EffluentReport r = evaluateEffluent(run.table);
  EXPECT_EQ(r.samples, 672U);
  EXPECT_NEAR(r.days, 7.0, 1e-9);
  EXPECT_NEAR(r.sample_min, 15.0, 1e-9);
  run.table.units[0] = "fortnight";
  EXPECT_THROW(evaluateEffluent(run.table), InputError);
}

TEST(Evaluate, TheClassIsReadFromWhatMoved) {
  ByHand run(9, 0.25);
  run.set("Qr", 18446.0);
  run.set("Qw", 385.0);
  run.set("KLa5", 240.0);
  EXPECT_EQ(wordOf(evaluateEffluent(run.table).levers), "A");
  run.set("KLa5", 3, 300.0);
  EXPECT_EQ(wordOf(evaluateEffluent(run.table).levers), "A, KLa > 240");
  run.set("Qw", 4, 300.0);
  EXPECT_EQ(wordOf(evaluateEffluent(run.table).levers), "B");
  run.set("Qw", 385.0);
  run.set("dose2", 1.0);
  EXPECT_EQ(wordOf(evaluateEffluent(run.table).levers), "B");
}

/// The words of the error that a record is refused with.
std::string refusal(const CsvTable& table) {
  try {
    evaluateEffluent(table);
  } catch (const InputError& e) {
    return e.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

TEST(Evaluate, NoFigureOfARecordWithHolesOrOtherUnits) {
  ByHand missing(9, 0.25);
  missing.set("S_NH_L1", 3, std::nan(""));
  EXPECT_NE(refusal(missing.table).find("S_NH_L1"), std::string::npos);
  ByHand hole(9, 0.25);
  for (Eigen::Index k = 5; k < 9; ++k) hole.set("time", k, 10.0 + 0.25 * static_cast<double>(k));
  EXPECT_NE(refusal(hole.table).find("min after the row before it"), std::string::npos);
  ByHand unit(9, 0.25);
  unit.table.units[static_cast<std::size_t>(unit.table.column("Q_in"))] = "m3/h";
  EXPECT_NE(refusal(unit.table).find("[m3/d], got [m3/h]"), std::string::npos);
  ByHand blower(9, 0.25);
  blower.table.names[static_cast<std::size_t>(blower.table.column("KLa5"))] = "other";
  EXPECT_NE(refusal(blower.table).find("KLa5"), std::string::npos) << "no air is not free air";
}

TEST(Evaluate, MissingColumnsAndEmptyPartsAreErrors) {
  ByHand run(3, 0.25);
  EvaluateParams late;
  late.from_h = 5.0;
  try {
    evaluateEffluent(run.table, late);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("report.record_from_h"), std::string::npos) << e.what();
  }
  run.table.names.back() = "other";
  run.table.names[1] = "else";
  EXPECT_THROW(evaluateEffluent(run.table), InputError);
}

}  // namespace study_evaluate_test
}  // namespace fpc
