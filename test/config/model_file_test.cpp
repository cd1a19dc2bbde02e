#include "config/model_file.hpp"
#include "fmbpc/model/model_match.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "fmbpc/base/input_error.hpp"
#include "identification/model_fixture.hpp"

namespace fpc {
namespace config_model_file_test {

void expectSame(const TsModel& a, const TsModel& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.sample_time_s, b.sample_time_s);
  for (const SignalKind kind :
       {SignalKind::kOutput, SignalKind::kInput, SignalKind::kDisturbance}) {
    ASSERT_EQ(a.signals(kind).size(), b.signals(kind).size());
    for (std::size_t i = 0; i < a.signals(kind).size(); ++i) {
      EXPECT_EQ(a.signals(kind)[i].name, b.signals(kind)[i].name);
      EXPECT_EQ(a.signals(kind)[i].unit, b.signals(kind)[i].unit);
      EXPECT_EQ(a.signals(kind)[i].lower, b.signals(kind)[i].lower);
      EXPECT_EQ(a.signals(kind)[i].upper, b.signals(kind)[i].upper);
    }
  }
  ASSERT_EQ(a.submodels.size(), b.submodels.size());
  for (std::size_t i = 0; i < a.submodels.size(); ++i) {
    EXPECT_TRUE(a.submodels[i].antecedents == b.submodels[i].antecedents);
    EXPECT_TRUE(a.submodels[i].regressors == b.submodels[i].regressors);
    ASSERT_EQ(a.submodels[i].rules.size(), b.submodels[i].rules.size());
    for (std::size_t r = 0; r < a.submodels[i].rules.size(); ++r) {
      EXPECT_TRUE(a.submodels[i].rules[r].antecedents == b.submodels[i].rules[r].antecedents);
      EXPECT_EQ(a.submodels[i].rules[r].coefficients, b.submodels[i].rules[r].coefficients);
      EXPECT_EQ(a.submodels[i].rules[r].offset, b.submodels[i].rules[r].offset);
      EXPECT_EQ(a.submodels[i].rules[r].data_count, b.submodels[i].rules[r].data_count);
    }
  }
}

const char* const kSmall = R"(name: small
source: by hand
sample_time_s: 60
outputs: {y: K}
inputs: {u: "1"}
disturbances: {d: K}
submodels:
  y:
    antecedents: [y(k)]
    regressors: [y(k), u(k-2), d(k)]
    rules:
      - when: {y(k): {gaussian: [1, 2]}}
        then: {y(k): 0.5, u(k-2): 3, d(k): 0.25, offset: -1}
        data_count: 12
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string complaint(const std::string& text) {
  try {
    parseModel(text, "small.yaml");
  } catch (const InputError& e) {
    return e.what();
  }
  return "nothing";
}

TEST(ModelFile, ReadsWhatAPersonWrites) {
  const TsModel model = parseModel(kSmall, "small.yaml");
  EXPECT_EQ(model.sample_time_s, 60.0);
  const OutputModel& y = model.submodels[0];
  EXPECT_TRUE(y.regressors[1] == (Regressor{SignalKind::kInput, 0, 2}));
  EXPECT_EQ(y.rules[0].coefficients, (Vector(3) << 0.5, 3.0, 0.25).finished());
  EXPECT_EQ(y.rules[0].offset, -1.0);
  EXPECT_EQ(y.rules[0].data_count, 12U);
  EXPECT_EQ(y.rules[0].antecedents[0].parameters, (std::vector<double>{1.0, 2.0}));
}

TEST(ModelFile, ShippedModelsSurviveARoundTrip) {
  for (const char* name : {"fm_1", "fm_2"}) {
    const TsModel model = test::shippedModel(name);
    expectSame(model, parseModel(writeModel(model), "again"));
  }
}

TEST(ModelFile, RandomModelsSurviveARoundTripBitForBit) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    TsModel model = test::randomModel(generator, {});
    model.source = "a: [strange] text, \"quoted\" # not a comment\nsecond line";
    model.outputs[0].lower = -1.0 / 3.0;
    model.inputs[0].upper = 1e-300;
    model.submodels[0].rules[0].data_count = 18446744073709551615ULL;
    model.submodels[0].rules[0].offset = 5e-324;
    model.submodels[1].rules[0].coefficients[0] = -1.7976931348623157e308;
    expectSame(model, parseModel(writeModel(model), "again"));
  }
}

TEST(ModelFile, ALinearModelNeedsNoAntecedents) {
  TsModel model = parseModel(kSmall, "small.yaml");
  model.submodels[0].antecedents.clear();
  model.submodels[0].rules[0].antecedents.clear();
  expectSame(model, parseModel(writeModel(model), "again"));
}

TEST(ModelFile, EveryMistakeNamesFileLineAndKey) {
  const auto expect = [](const std::string& from, const std::string& to,
                         const std::string& line_and_key) {
    const std::string text = complaint(replaced(kSmall, from, to));
    EXPECT_EQ(text.rfind("small.yaml" + line_and_key, 0), 0U) << text;
  };
  expect("source: by hand", "sourse: by hand", ":2: sourse");
  expect("sample_time_s: 60", "sample_time_s: 0", ":3: sample_time_s");
  expect("sample_time_s: 60\n", "", ":1: sample_time_s");
  expect("outputs: {y: K}", "outputs: [y]", ":4: outputs");
  expect("antecedents: [y(k)]", "antecedents: [z(k)]", ":9: submodels.y.antecedents");
  expect("u(k-2), d(k)]", "u(k-2), u(k-2)]", ":10: submodels.y.regressors");
  expect("u(k-2), d(k)]", "u(k+2), d(k)]", ":10: submodels.y.regressors");
  expect("{gaussian: [1, 2]}", "{gaussian: [1, 2, 3]}",
         ":12: submodels.y.rules[0].when.y(k).gaussian");
  expect("{gaussian: [1, 2]}", "{gaussian: [1, -2]}",
         ":12: submodels.y.rules[0].when.y(k).gaussian");
  expect("{gaussian: [1, 2]}", "{gaussian: [1, .inf]}",
         ":12: submodels.y.rules[0].when.y(k).gaussian");
  expect("{gaussian: [1, 2]}", "{bell: [1, 2]}", ":12: submodels.y.rules[0].when.y(k).bell");
  expect("when: {y(k)", "when: {y(k-1)", ":12: submodels.y.rules[0].when.y(k)");
  expect("offset: -1", "offset: .nan", ":13: submodels.y.rules[0].then.offset");
  expect("y(k): 0.5", "y(k): .inf", ":13: submodels.y.rules[0].then.y(k)");
  expect("y(k): 0.5", "y(k): half", ":13: submodels.y.rules[0].then.y(k)");
  expect("y(k): 0.5, ", "", ":13: submodels.y.rules[0].then.y(k)");
  expect("offset: -1", "offset: -1, e(k): 2", ":13: submodels.y.rules[0].then.e(k)");
  expect("data_count: 12", "data_count: -12", ":14: submodels.y.rules[0].data_count");
  expect("submodels:\n  y:", "submodels:\n  z:", ":8: submodels.y");
  expect("disturbances: {d: K}", "disturbances: {y: K}", "");
  expect("name: small", "name: [small", ":");
}

TEST(ModelFile, AMissingFileIsAnInputError) {
  EXPECT_THROW(readModel("no_such_file.yaml"), InputError);
  EXPECT_THROW(parseModel("", "empty"), InputError);
}

TEST(MatchToPlant, ReordersNamesAndKeepsTheMeaning) {
  const TsModel model = test::shippedModel("fm_1");
  PlantInfo plant = test::activatedSludgeInfo();
  std::swap(plant.outputs[0], plant.outputs[1]);
  plant.disturbances.insert(plant.disturbances.begin(), test::signal("t_water", "degC"));
  std::swap(plant.disturbances[1], plant.disturbances[2]);
  const TsModel matched = matchToPlant(model, plant);
  EXPECT_NO_THROW(matched.validate());
  EXPECT_EQ(matched.outputs[0].name, "x");
  EXPECT_EQ(matched.submodels[0].rules.size(), 5U);
  EXPECT_EQ(matched.maxLag(SignalKind::kDisturbance, 0), -1);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < model.submodels[i].regressors.size(); ++j) {
      EXPECT_EQ(matched.text(matched.submodels[1 - i].regressors[j]),
                model.text(model.submodels[i].regressors[j]));
      EXPECT_EQ(matched.text(matched.submodels[1 - i].antecedents[j]),
                model.text(model.submodels[i].antecedents[j]));
    }
}

TEST(MatchToPlant, TakesASampleTimeThatARecordRounded) {
  TsModel model = test::shippedModel("fm_1");
  const PlantInfo plant = test::activatedSludgeInfo();
  model.sample_time_s = 0.9995 * plant.sample_time_s;
  EXPECT_EQ(matchToPlant(model, plant).sample_time_s, plant.sample_time_s);
  model.sample_time_s = 0.998 * plant.sample_time_s;
  EXPECT_THROW(matchToPlant(model, plant), InputError);
}

/// Nobody measures q_i: it becomes an unmeasured disturbance where somebody estimates it, and comes
/// last again, under its name, where the model is written.
TEST(MatchToPlant, TakesApartWhatTheLoopEstimates) {
  const TsModel model = test::shippedModel("fm_1");
  PlantInfo plant = test::activatedSludgeInfo();
  ASSERT_EQ(plant.disturbances[0].name, "q_i");
  plant.disturbances.erase(plant.disturbances.begin());
  EXPECT_THROW(matchToPlant(model, plant), InputError);
  const TsModel matched = matchToPlant(model, plant, {"q_i"});
  EXPECT_NO_THROW(matched.validate());
  ASSERT_EQ(matched.unmeasured.size(), 1U);
  EXPECT_EQ(matched.unmeasured[0].name, "q_i");
  EXPECT_EQ(matched.disturbances.size(), plant.disturbances.size());
  EXPECT_GE(matched.maxLag(SignalKind::kUnmeasured, 0), 0);
  const TsModel written = parseModel(writeModel(matched), "again");
  ASSERT_EQ(written.disturbances.size(), 2U);
  EXPECT_EQ(written.disturbances[1].name, "q_i");
  for (std::size_t i = 0; i < model.submodels.size(); ++i)
    for (std::size_t j = 0; j < model.submodels[i].regressors.size(); ++j) {
      const std::string name = model.text(model.submodels[i].regressors[j]);
      EXPECT_EQ(matched.text(matched.submodels[i].regressors[j]), name);
      EXPECT_EQ(written.text(written.submodels[i].regressors[j]), name);
    }
  EXPECT_EQ(matchToPlant(matched, plant, {"q_i"}).unmeasured.size(), 1U) << "once more";
}

TEST(MatchToPlant, NamesWhatDoesNotFit) {
  const TsModel model = test::shippedModel("fm_1");
  const auto expect = [&](const std::string& word, const std::function<void(PlantInfo&)>& spoil) {
    PlantInfo plant = test::activatedSludgeInfo();
    spoil(plant);
    try {
      matchToPlant(model, plant);
      ADD_FAILURE() << "accepted: " << word;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
    }
  };
  expect("sample_time_s", [](PlantInfo& p) { p.sample_time_s = 60.0; });
  expect("outputs.x", [](PlantInfo& p) { p.outputs.pop_back(); });
  expect("output x_r", [](PlantInfo& p) { p.outputs.push_back(test::signal("x_r", "mg/l")); });
  expect("inputs.q_r", [](PlantInfo& p) { p.inputs[0].name = "q"; });
  expect("disturbances.s_i", [](PlantInfo& p) { p.disturbances[1].unit = "kg/m3"; });
}

}  // namespace config_model_file_test
}  // namespace fpc
