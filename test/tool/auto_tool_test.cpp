// fmbpc identify --auto and fmbpc validate on a record that is known.
#include <gtest/gtest.h>

#include "base/random.hpp"
#include "config/identified_file.hpp"
#include "tool/identify_fixture.hpp"

namespace fpc {
namespace tool_auto_tool_test {

class AutoTool : public IdentifyTool {
 protected:
  std::string search(const std::string& rest) const {
    return "identify " + data_ + " --auto --inputs u --outputs y --kind regressors " + rest;
  }
  /// The one line that a command ends with.
  static std::string refusal(const std::string& command) {
    const Outcome outcome = tool(command, true);
    EXPECT_EQ(outcome.code, 1) << command;
    return outcome.printed.substr(0, outcome.printed.find_last_not_of('\n') + 1);
  }
};

TEST_F(AutoTool, FindsTheProcessAndJudgesItsFileAlike) {
  const std::string model = path("found.yaml");
  const Outcome outcome =
      tool(search("--rows 1:200 --validate-rows 201:300 --out " + model + " --json"));
  ASSERT_EQ(outcome.code, 0);
  const auto found = parsed(outcome.printed);
  EXPECT_TRUE(found.at("beats_linear").at("y").get<bool>()) << found.at("verdict");
  EXPECT_EQ(found.at("cross_validation").at("y").at("best"), "regressors");
  const auto& held = found.at("validation").at("y");
  EXPECT_LT(held.at("free_run").at("rmse").get<double>(),
            0.5 * held.at("linear").at("free_run").at("rmse").get<double>());
  EXPECT_EQ(held.at("free_run"), held.at("regressors").at("free_run"));

  const Outcome again = tool("validate " + model + " " + data_ + " --rows 201:300 --json");
  ASSERT_EQ(again.code, 0);
  EXPECT_EQ(parsed(again.printed).at("validation").at("y"), held);
  EXPECT_EQ(readIdentified(model).model.sample_time_s, 1.0);
}

TEST_F(AutoTool, PrintsTheVerdictFirst) {
  const Outcome outcome = tool(search("--rows 1:120 --budget 0.05"));
  ASSERT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.printed.rfind("y: ", 0), 0U);
  EXPECT_LT(outcome.printed.find("beat"), outcome.printed.find('\n'));
  ASSERT_NE(outcome.printed.find("remark: "), std::string::npos)
      << "so short a time leaves much out";
  EXPECT_LT(outcome.printed.find("remark: "), outcome.printed.find("held-out blocks  "));
}

TEST_F(AutoTool, ShowsTheFiguresThatTheStarGoesBy) {
  const Outcome outcome = tool(search("--rows 1:200 --json"));
  ASSERT_EQ(outcome.code, 0);
  const auto found = parsed(outcome.printed);
  const auto& crossed = found.at("cross_validation").at("y");
  EXPECT_LT(crossed.at("regressors").at("confirmed").get<double>(),
            0.97 * crossed.at("linear").at("confirmed").get<double>());
  for (const auto* kind : {"regressors", "linear"})
    EXPECT_GE(crossed.at(kind).at("confirmed").get<double>(),
              crossed.at(kind).at("mean_of_blocks").get<double>() * (1.0 - 1e-9))
        << kind << ": who never saw a block does not run closer to it than the best on all";
  const Outcome printed = tool(search("--rows 1:200"));
  EXPECT_NE(printed.printed.find("confirmed  mean of blocks"), std::string::npos)
      << printed.printed;
}

TEST_F(AutoTool, ValidateTakesOtherNames) {
  const std::string model = path("plain.yaml");
  ASSERT_EQ(tool(onRecord("--out " + model)).code, 0);
  CsvTable other = record(100);
  other.names = {"time", "level", "valve"};
  const std::string file = writeRecord("other.csv", other);
  EXPECT_NE(tool("validate " + model + " " + file).code, 0);
  const Outcome outcome =
      tool("validate " + model + " " + file + " --columns y=level,u=valve --steps 3 --json");
  ASSERT_EQ(outcome.code, 0);
  const auto json = parsed(outcome.printed);
  EXPECT_EQ(json.at("validation").at("y").at("ahead").at("steps"), 3);
  EXPECT_FALSE(json.at("validation").at("y").contains("linear"));
}

TEST_F(AutoTool, SaysWhatIsMissing) {
  EXPECT_NE(tool("identify " + data_ + " --auto --inputs u").code, 0);
  EXPECT_NE(tool("identify " + data_ + " --auto --outputs y").code, 0);
  EXPECT_NE(tool("identify " + data_ + " --auto --inputs nothing --outputs y").code, 0);
  EXPECT_NE(tool("identify " + data_).code, 0);
}

/// Rows `first` to `last` of a record are not there, their times neither.
CsvTable without(const CsvTable& table, Eigen::Index first, Eigen::Index last) {
  CsvTable part = table;
  const Eigen::Index after = table.rows() - last - 1;
  part.values.resize(first + after, table.values.cols());
  part.values << table.values.topRows(first), table.values.bottomRows(after);
  return part;
}

TEST_F(AutoTool, RowsThatTheTimesLackKeepThePastsOnBothSidesApart) {
  const std::string holed = writeRecord("holed.csv", without(record(), 100, 149));
  const Outcome found =
      tool("identify " + holed + " --auto --inputs u --outputs y --kind linear --json");
  ASSERT_EQ(found.code, 0);
  EXPECT_NE(found.printed.find("50 rows absent from the times"), std::string::npos)
      << found.printed;
  const std::string model = path("plain.yaml");
  ASSERT_EQ(tool(onRecord("--out " + model)).code, 0);
  const Outcome judged = tool("validate " + model + " " + holed + " --json");
  ASSERT_EQ(judged.code, 0);
  EXPECT_NE(judged.printed.find("50 rows absent from the times"), std::string::npos);
  EXPECT_EQ(tool("validate " + model + " " + holed + " --json --no-time").printed.find("absent"),
            std::string::npos);
}

TEST_F(AutoTool, TimesThatDoNotRiseOrHaveAnotherSpacingAreRefused) {
  const std::string model = path("plain.yaml"), by_name = " --auto --inputs u --outputs y";
  ASSERT_EQ(tool(onRecord("--out " + model)).code, 0);
  expectWords(refusal("identify " + writeRecord("plain.csv", record()) +
                      " --auto --inputs u time --outputs y"),
              {"plain.csv: column 'time'", "a signal, not the times"});
  CsvTable table = record();
  table.values(50, 0) = table.values(49, 0);
  const std::string twice = writeRecord("twice.csv", table);
  expectWords(refusal("identify " + twice + by_name), {"twice.csv:52", "'time'", "only once"});
  expectWords(refusal("validate " + model + " " + twice), {"twice.csv:52", "only once"});
  table = record();
  table.units[0] = "min";
  const std::string slow = writeRecord("slow.csv", table);
  expectWords(refusal("validate " + model + " " + slow), {"slow.csv", "apart"});
  EXPECT_EQ(tool("validate " + model + " " + slow + " --no-time").code, 0);
  table.units[0] = "us";
  const std::string fast = writeRecord("fast.csv", table);
  expectWords(refusal("identify " + fast + by_name), {"fast.csv", "[us]"});
  for (Eigen::Index k = 0; k < table.rows(); k += 2) table.values(k, 0) += 0.3;
  table.units[0] = "s";
  const std::string uneven = writeRecord("uneven.csv", table);
  expectWords(refusal("identify " + uneven + by_name), {"uneven.csv", "'time'", "evenly"});
}

TEST_F(AutoTool, TimesThatJitterAreTakenAtTheirMeanAndSaid) {
  CsvTable table = record();
  std::mt19937_64 random(2);
  table.names[0] = "t_s";
  for (Eigen::Index k = 0; k < table.rows(); ++k)
    table.values(k, 0) = 2.0 * (static_cast<double>(k) + 0.05 * (uniform(random) - 0.5));
  const std::string jittered = writeRecord("jittered.csv", table), model = path("jittered.yaml");
  const Outcome found = tool("identify " + jittered +
                             " --auto --inputs u --outputs y --kind linear --json --out " + model);
  ASSERT_EQ(found.code, 0);
  EXPECT_NE(found.printed.find("times of 't_s' jitter by up to"), std::string::npos)
      << parsed(found.printed).at("remarks");
  EXPECT_EQ(readIdentified(model).model.sample_time_s, 2.0);
  const Outcome judged = tool("validate " + model + " " + jittered + " --json");
  ASSERT_EQ(judged.code, 0);
  EXPECT_NE(judged.printed.find("jitter"), std::string::npos);
}

TEST_F(AutoTool, ASampleTimeIsNeverAssumed) {
  const std::string by_name = " --auto --inputs u --outputs y --kind linear --work 0.1";
  CsvTable table = record();
  table.names[0] = "k";
  table.units[0] = "";
  const std::string counted = writeRecord("counted.csv", table), model = path("timed.yaml");
  expectWords(refusal("identify " + counted + by_name), {"counted.csv", "--sample-time S"});
  EXPECT_EQ(tool("identify " + counted + by_name + " --sample-time 4").code, 0);
  const auto sampleTime = [&](const std::string& name, double step) {
    CsvTable named = table;
    named.names[0] = name;
    named.values.col(0) *= step;
    const std::string file = writeRecord("named.csv", named);
    EXPECT_EQ(tool("identify " + file + by_name + " --out " + model).code, 0) << name;
    return readIdentified(model).model.sample_time_s;
  };
  for (const std::string name : {"timestamp", "datetime", "T", "sec", "time (s)", "t_s", "Time"})
    EXPECT_EQ(sampleTime(name, 2.0), 2.0) << name;
  EXPECT_EQ(sampleTime("time_ms", 100.0), 0.1);
  EXPECT_EQ(sampleTime("Time (min)", 0.5), 30.0);
  EXPECT_EQ(sampleTime("hours", 1.0), 3600.0);
  table.names[0] = "t_10s";
  expectWords(refusal("identify " + writeRecord("tens.csv", table) + by_name),
              {"tens.csv", "'t_10s'", "--sample-time", "[10s]"});
  table.names[0] = "T";  // of the process, not the time
  table.values.col(0) = table.values.col(1);
  expectWords(refusal("identify " + writeRecord("warm.csv", table) + by_name), {"--sample-time S"});
}

TEST_F(AutoTool, DatesOfADayMonthAndYearAreTimes) {
  const CsvTable table = record(120);
  std::string text = "date,y,u\n";
  for (Eigen::Index k = 0; k < table.rows(); ++k) {
    char cell[32];
    std::snprintf(cell, sizeof cell, "%02d.%02d.2024 %02d:%02d", 28 + static_cast<int>(k / 48) % 3,
                  2, static_cast<int>(k % 48) / 2, static_cast<int>(k % 2) * 30);
    if (k >= 96)
      std::snprintf(cell, sizeof cell, "1.3.2024 %02d:%02d", static_cast<int>(k % 48) / 2,
                    static_cast<int>(k % 2) * 30);
    text += std::string(cell) + "," + std::to_string(table.values(k, 1)) + "," +
            std::to_string(table.values(k, 2)) + "\n";
  }
  const std::string file = write("dated.csv", text), model = path("dated.yaml");
  ASSERT_EQ(tool("identify " + file + " --auto --inputs u --outputs y --kind linear --work 0.1 " +
                 "--out " + model)
                .code,
            0);
  EXPECT_EQ(readIdentified(model).model.sample_time_s, 1800.0);
}

TEST_F(AutoTool, AFileWithoutHeaderIsRefusedUnlessToldSo) {
  CsvTable table = record(120);
  table.names = {"1.5", "2.5", "3.5"};
  table.units = {"", "", ""};
  const std::string file = writeRecord("bare.csv", table);
  expectWords(refusal("identify " + file + " --auto --inputs 3 --outputs 2"),
              {"bare.csv:1", "--no-header"});
  const Outcome found = tool("identify " + file + " --no-header --auto --inputs 3 --outputs 2 " +
                             "--sample-time 1 --kind linear --work 0.1 --json");
  ASSERT_EQ(found.code, 0);
  EXPECT_NE(parsed(found.printed).at("source").get<std::string>().find("rows 1:121"),
            std::string::npos);
}

TEST_F(AutoTool, APieceWhoseTimesJumpBackIsARecordOfItsOwn) {
  CsvTable table = record();
  table.values.col(0).tail(120).array() -= 150.0;
  const std::string file = writeRecord("twice.csv", table), model = path("pieces.yaml");
  const Outcome found = tool("identify " + file + " --auto --inputs u --outputs y --kind linear " +
                             "--work 0.1 --json --out " + model);
  ASSERT_EQ(found.code, 0);
  EXPECT_NE(found.printed.find("jump back at"), std::string::npos);
  EXPECT_GT(
      parsed(found.printed).at("identification").at("y").at("one_step").at("vaf").get<double>(),
      90.0);
  EXPECT_EQ(tool("validate " + model + " " + file).code, 0);
}

TEST_F(AutoTool, TheModelThatControlLawsTakeIsJudgedBesideTheStarredOne) {
  const Outcome outcome =
      tool("identify " + data_ + " --auto --inputs u --outputs y --rows 1:200 " +
           "--work 2 --plots " + path("plots") + " --json");
  ASSERT_EQ(outcome.code, 0);
  const auto y = parsed(outcome.printed).at("identification").at("y");
  const std::string laws = y.at("laws").at("kind");
  EXPECT_TRUE(laws == "regressors" || laws == "linear") << laws;
  EXPECT_EQ(y.at("laws").at("free_run"), y.at(laws).at("free_run"));
  EXPECT_GT(y.at("laws").at("ahead").at("rmse").get<double>(), 0.0);
  const CsvTable plotted = readCsv(path("plots") + "/identification.csv");
  EXPECT_NO_THROW(plotted.column("y_laws_free_run"));
  EXPECT_NO_THROW(plotted.column("u"));
}

TEST_F(AutoTool, TimesThatFallOrJumpAreNeverCalledAbsent) {
  CsvTable table = record();
  table.names[0] = "t_s";
  table.values.col(0) = -table.values.col(0);
  const std::string falling = writeRecord("falling.csv", table);
  const std::string by_name = " --auto --inputs u --outputs y";
  expectWords(refusal("identify " + falling + by_name), {"falling.csv", "'t_s'", "fall"});
  table.values.col(0) = -table.values.col(0);
  for (Eigen::Index k = 0; k < table.rows(); k += 3) table.values(k, 0) += 0.4;
  const std::string uneven = writeRecord("wild.csv", table);
  expectWords(refusal("identify " + uneven + by_name), {"wild.csv", "'t_s'", "evenly"});
  EXPECT_EQ(tool("identify " + uneven + by_name + " --sample-time 1 --kind linear").code, 0);
}

TEST_F(AutoTool, SaysWhatKindWasAskedFor) {
  const Outcome outcome = tool("identify " + data_ +
                               " --auto --inputs u --outputs y --kind linear --rows 1:200 --json");
  ASSERT_EQ(outcome.code, 0);
  const auto found = parsed(outcome.printed);
  EXPECT_EQ(found.at("verdict").at("y").get<std::string>().rfind("linear, as --kind asks", 0), 0U);
  EXPECT_FALSE(found.at("beats_linear").at("y").get<bool>());
  EXPECT_FALSE(found.at("identification").at("y").contains("regressors"))
      << "the linear model under another name";
  EXPECT_FALSE(
      found.at("identification").at("y").at("interval").at("free_run").at("coverage").is_null());
}

TEST_F(AutoTool, AModelThatIsWorseThanLinearOnValidationRowsIsNotWritten) {
  // the known process first, afterwards what the linear model makes of it
  CsvTable table = record(300);
  const std::string first = path("first.yaml");
  ASSERT_EQ(tool(search("--rows 1:200 --out " + first)).code, 0);
  const IdentifiedModel model = readIdentified(first);
  const TsModel linear = model.linearModel();
  double y = table.values(199, 1);
  for (Eigen::Index k = 200; k < 300; ++k) {
    table.values(k, 1) = y;
    const Rule& rule = linear.submodels[0].rules[0];
    double next = rule.offset;
    for (std::size_t r = 0; r < linear.submodels[0].regressors.size(); ++r) {
      const Regressor& x = linear.submodels[0].regressors[r];
      next += rule.coefficients[static_cast<Eigen::Index>(r)] *
              table.values(k - x.lag, x.kind == SignalKind::kOutput ? 1 : 2);
    }
    y = next;
  }
  const std::string other = writeRecord("other.csv", table), written = path("written.yaml");
  const std::string by_name =
      "identify " + other + " --auto --inputs u --outputs y --kind regressors --rows 1:200 ";
  const Outcome outcome = tool(by_name + "--validate-rows 201:300 --json --out " + written);
  ASSERT_EQ(outcome.code, 0);
  const auto found = parsed(outcome.printed);
  const std::string verdict = found.at("verdict").at("y");
  EXPECT_EQ(verdict.rfind("the fuzzy model is worse than the best linear one on the validation", 0),
            0U)
      << verdict;
  EXPECT_FALSE(found.at("beats_linear").at("y").get<bool>());
  EXPECT_EQ(readIdentified(written).model.submodels[0].rules.size(), 1U);
  const Outcome judged = tool("validate " + first + " " + other + " --rows 201:300");
  ASSERT_EQ(judged.code, 0);
  EXPECT_EQ(judged.printed.rfind("warning: y: the fuzzy model 'regressors' is worse than", 0), 0U)
      << judged.printed;
}

TEST_F(AutoTool, AWrongSignIsTheFirstRemark) {
  const auto remarks = [&](const std::string& sign) {
    const Outcome outcome =
        tool("identify " + data_ + " --auto --inputs u --outputs y --kind linear --rows 1:200 " +
             "--known 'y: {gain: {u: " + sign + "}}' --json");
    EXPECT_EQ(outcome.code, 0);
    return parsed(outcome.printed).at("remarks");
  };
  const auto wrong = remarks("negative");
  ASSERT_FALSE(wrong.empty());
  EXPECT_EQ(wrong[0].get<std::string>().rfind(
                "y: the record contradicts known.gain of u (negative): ", 0),
            0U)
      << wrong;
  for (const auto& remark : remarks("positive"))
    EXPECT_EQ(remark.get<std::string>().find("contradicts"), std::string::npos) << remark;
}

TEST_F(AutoTool, IntervalsThatHoldTooLittleArePartOfTheVerdict) {
  CsvTable table = record(300);
  const std::string model = path("covers.yaml");
  const std::string rest =
      " --auto --inputs u --outputs y --kind linear --rows 1:200 --validate-rows 201:300 --json";
  const std::string kept = writeRecord("kept.csv", table);
  const auto verdict = [&](const std::string& file) {
    const Outcome outcome = tool("identify " + file + rest + " --out " + model);
    EXPECT_EQ(outcome.code, 0);
    return parsed(outcome.printed).at("verdict").at("y").get<std::string>();
  };
  EXPECT_EQ(verdict(kept).find("95 % intervals"), std::string::npos) << verdict(kept);
  std::mt19937_64 random(3);
  for (Eigen::Index k = 200; k < 300; ++k) table.values(k, 1) += 3.0 * (uniform(random) - 0.5);
  const std::string noisy = writeRecord("noisy.csv", table);
  expectWords(verdict(noisy), {"on the validation rows its 95 % intervals hold only",
                               "one step ahead", "chance leaves"});
  const Outcome judged = tool("validate " + model + " " + noisy + " --rows 201:300 --json");
  ASSERT_EQ(judged.code, 0);
  EXPECT_NE(parsed(judged.printed).at("warnings").dump().find("95 % intervals hold only"),
            std::string::npos);
}

TEST_F(AutoTool, OutliersAreLeftOutOfThePrintedFigures) {
  CsvTable table = record();
  table.values(150, 1) += 500.0;
  table.values(151, 1) += 500.0;
  const std::string spoilt = writeRecord("spoilt.csv", table);
  const Outcome outcome =
      tool("identify " + spoilt + " --auto --inputs u --outputs y --kind regressors --json");
  ASSERT_EQ(outcome.code, 0);
  const auto found = parsed(outcome.printed);
  EXPECT_NE(outcome.printed.find("y: 2 outliers, the first in row 151"), std::string::npos);
  EXPECT_GT(found.at("identification").at("y").at("one_step").at("vaf").get<double>(), 95.0);
}

TEST_F(AutoTool, ValidateKnowsTheSignalsOfTheModelOnly) {
  const std::string model = path("plain.yaml"), judge = "validate " + model + " " + data_;
  ASSERT_EQ(tool(onRecord("--out " + model)).code, 0);
  expectWords(refusal(judge + " --columns q=u"), {"'q=u'", "y, u"});
  expectWords(refusal(judge + " --columns u=u,u=y"), {"'u=y'", "once"});
}

}  // namespace tool_auto_tool_test
}  // namespace fpc
