#include "base/yaml_node.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "error_words.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace base_yaml_section_test {

YamlSection parsed(const std::string& text) { return YamlSection::parse(text, "loop.yaml"); }

/// What reading `text` throws.
std::string errorOf(const std::string& text, const std::function<void(YamlSection&)>& read) {
  return test::thrownBy([&] {
    YamlSection section = parsed(text);
    read(section);
  });
}

using test::expectWords;

TEST(YamlSection, ReadsOverDefaults) {
  YamlSection section = parsed("a: 1e-6\nb: 7\nc: true\nd: word\n");
  double a = 0.5, absent = 0.25;
  int b = 0;
  bool c = false;
  std::string d;
  section.number("a", a);
  section.number("absent", absent);
  section.integer("b", b, 0);
  section.boolean("c", c);
  section.text("d", d);
  section.finish();
  EXPECT_EQ(a, 1e-6);
  EXPECT_EQ(absent, 0.25);
  EXPECT_EQ(b, 7);
  EXPECT_TRUE(c);
  EXPECT_EQ(d, "word");
}

// One reader of YAML takes 010 for eight, another for ten; 0x10 is sixteen to few people.
TEST(YamlSection, IntegersAreDecimal) {
  for (const char* text : {"010", "0x10", "-07", "1_000", "1e3", "+-4", "", "0b11", "12 ", "--1"})
    expectWords(errorOf("b: '" + std::string(text) + "'\n",
                        [](YamlSection& s) {
                          int value = 0;
                          s.integer("b", value, -100);
                        }),
                "expected an integer");
  for (const char* text : {"010", "0x10", "-1", "18446744073709551616"})
    expectWords(errorOf("b: " + std::string(text) + "\n",
                        [](YamlSection& s) {
                          std::uint64_t value = 0;
                          s.seed("b", value);
                        }),
                "an integer >= 0");
  YamlSection section = parsed("a: +7\nb: 0\nc: -12\nd: 18446744073709551615\n");
  int a = 0, b = 1, c = 0;
  std::uint64_t d = 0;
  section.integer("a", a, 0);
  section.integer("b", b, 0);
  section.integer("c", c, -100);
  section.seed("d", d);
  EXPECT_EQ(a, 7);
  EXPECT_EQ(b, 0);
  EXPECT_EQ(c, -12);
  EXPECT_EQ(d, 18446744073709551615ULL);
}

TEST(YamlSection, UnknownKeysAreErrorsWithLineAndKnownKeys) {
  const std::string error = errorOf("horizon: 3\nhorizont: 4\n", [](YamlSection& s) {
    int n = 0;
    s.integer("horizon", n, 1);
    s.finish();
  });
  EXPECT_EQ(error, "loop.yaml:2: horizont: unknown key; expected one of horizon");
}

TEST(YamlSection, ErrorsInSectionsNameTheWholePath) {
  const std::string text = "controller:\n  weights:\n    move: heavy\n";
  const std::string error = errorOf(text, [](YamlSection& s) {
    double move = 0.0;
    s.section("controller").section("weights").number("move", move);
  });
  expectWords(error, "loop.yaml:3: controller.weights.move: expected");
  expectWords(error, "got 'heavy'");
}

TEST(YamlSection, NumbersOutsideTheirRangeAreErrors) {
  const auto error = [](const std::string& value, Range range) {
    return errorOf("a: " + value + "\n", [&](YamlSection& s) {
      double a = 0.0;
      s.number("a", a, range);
    });
  };
  expectWords(error("0", Range::positive()), "> 0, got '0'");
  expectWords(error("-1", Range::notNegative()), ">= 0, got '-1'");
  expectWords(error("3", {0.0, 2.0}), ">= 0 and <= 2");
  EXPECT_EQ(error("0", Range::notNegative()), "nothing was thrown");
  EXPECT_EQ(error("2", {0.0, 2.0}), "nothing was thrown");
  for (const char* bad : {".nan", "1.0.0", "1,5", "[1]", "{b: 1}", "1 m"})
    expectWords(error(bad, {}), "loop.yaml:1: a: expected a number");
  expectWords(error("", {}), "a: expected a number, got nothing");
}

TEST(YamlSection, InfiniteNumbersPassOnlyWhereTheRangeSaysSo) {
  const double infinity = std::numeric_limits<double>::infinity();
  const auto read = [](const std::string& value, Range range) {
    YamlSection section = parsed("a: " + value + "\n");
    double a = 0.0;
    section.number("a", a, range);
    return a;
  };
  EXPECT_EQ(read(".inf", {0.0, infinity, true}), infinity);
  EXPECT_EQ(read("-.inf", {-infinity, 0.0}), -infinity);
  for (const Range range : {Range::positive(), Range::notNegative(), Range{0.0, 1.0}})
    EXPECT_THROW(read(".inf", range), InputError);
  EXPECT_THROW(read("-.inf", {0.0, infinity}), InputError);
}

TEST(YamlSection, IntegersAndSeedsTakeNoOtherNumbers) {
  const auto integer = [](const std::string& value) {
    return errorOf("n: " + value + "\n", [](YamlSection& s) {
      int n = 0;
      s.integer("n", n, 1, 9);
    });
  };
  const auto seed = [](const std::string& value) {
    return errorOf("n: " + value + "\n", [](YamlSection& s) {
      std::uint64_t n = 0;
      s.seed("n", n);
    });
  };
  for (const char* bad : {"0", "10", "2.5", "1e1", "two", "99999999999", "[1]"})
    expectWords(integer(bad), "n: expected an integer >= 1 and <= 9");
  EXPECT_EQ(integer("9"), "nothing was thrown");
  for (const char* bad : {"-1", "1.5", "x", "99999999999999999999"})
    expectWords(seed(bad), "n: expected an integer >= 0");
  EXPECT_EQ(seed("18446744073709551615"), "nothing was thrown");
}

TEST(YamlSection, TextsAndChoicesAreChecked) {
  const auto choose = [](const std::string& text) {
    return errorOf(text, [](YamlSection& s) {
      std::string method = "bdf";
      s.oneOf("method", method, {"bdf", "adams"});
    });
  };
  EXPECT_EQ(choose(""), "nothing was thrown");
  EXPECT_EQ(choose("method: adams\n"), "nothing was thrown");
  expectWords(choose("method: euler\n"), "method: expected one of bdf, adams, got 'euler'");
  expectWords(choose("method: [bdf]\n"), "method: expected a text");
  expectWords(errorOf("c: perhaps\n",
                      [](YamlSection& s) {
                        bool c = false;
                        s.boolean("c", c);
                      }),
              "true or false");
}

TEST(YamlSection, ListsHaveTheRightSizeAndKind) {
  YamlSection section = parsed("names: [s, x]\nvalues: [1, 2.5]\nall: 3\ntwo: [4, 5]\n");
  std::vector<std::string> names;
  std::vector<double> values;
  Vector all, two;
  section.names("names", names);
  section.numbers("values", values);
  section.vector("all", all, 3);
  section.vector("two", two, 2);
  EXPECT_EQ(names, (std::vector<std::string>{"s", "x"}));
  EXPECT_EQ(values, (std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(all, Vector::Constant(3, 3.0));
  EXPECT_EQ(two, Eigen::Vector2d(4.0, 5.0));
  EXPECT_THROW(section.vector("two", two, 3), InputError);
  EXPECT_THROW(section.names("all", names), InputError);
  EXPECT_THROW(section.numbers("all", values), InputError);
  EXPECT_THROW(section.numbers("names", values), InputError);
}

TEST(YamlSection, ByNameWritesOverTheValuesOfNamedSignals) {
  const std::vector<std::string> names{"s", "x"};
  YamlSection section = parsed("std: {x: 20}\nlist: [1, 2]\n");
  Vector std = Eigen::Vector2d(0.5, 0.5), list;
  section.byName("std", std, names);
  section.byName("list", list, names);
  EXPECT_EQ(std, Eigen::Vector2d(0.5, 20.0));
  EXPECT_EQ(list, Eigen::Vector2d(1.0, 2.0));
}

TEST(YamlSection, ByNameWithoutDefaultsWantsEveryName) {
  const auto read = [](const std::string& text) {
    return errorOf(text, [](YamlSection& s) {
      Vector v;
      s.byName("v", v, {"s", "x"});
      EXPECT_EQ(v, Eigen::Vector2d(1.0, 2.0));
    });
  };
  EXPECT_EQ(read("v: {x: 2, s: 1}\n"), "nothing was thrown");
  expectWords(read("v: {s: 1}\n"), "v: expected a number for x");
  expectWords(read("v: {y: 1}\n"), "v.y: expected one of s, x");
  expectWords(read("v: {s: 1, s: 2, x: 3}\n"), "v.s: expected the key only once");
  expectWords(read("v: {s: one, x: 3}\n"), "got 'one'");
  expectWords(read("v: [1, 2, 3]\n"), "got [1, 2, 3]");
}

TEST(YamlSection, ListsOfMappingsAreNumbered) {
  YamlSection section = parsed("loops:\n  - {kp: 1}\n  - {kp: 2}\n");
  auto loops = section.list("loops");
  ASSERT_EQ(loops.size(), 2U);
  double kp = 0.0;
  loops[1].number("kp", kp);
  EXPECT_EQ(kp, 2.0);
  expectWords(loops[0].where("kp"), "loops[0].kp");
  EXPECT_TRUE(section.list("absent").empty());
  EXPECT_THROW(parsed("loops: 3\n").list("loops"), InputError);
  EXPECT_THROW(parsed("loops: [3]\n").list("loops"), InputError);
}

TEST(YamlSection, RepeatedKeysAndBrokenYamlAreErrorsWithALine) {
  const auto nothing = [](YamlSection&) {};
  expectWords(errorOf("a: 1\nb: 2\na: 3\n", nothing), "a: expected the key only once");
  expectWords(errorOf("a: 1\nb: [1, 2\nc: 3\n", nothing), "loop.yaml:");
  expectWords(errorOf("a: 1\nb: [1, 2\nc: 3\n", nothing), "valid YAML");
  expectWords(errorOf("- 1\n- 2\n", nothing), "a mapping of keys to values");
}

TEST(YamlSection, AnEmptyTextAndAnAbsentSectionAreEmptyMappings) {
  YamlSection section = parsed("");
  EXPECT_TRUE(section.keys().empty());
  EXPECT_FALSE(section.has("a"));
  section.section("absent").finish();
  section.finish();
  parsed("present:\n").section("present").finish();
  EXPECT_THROW(parsed("present: 3\n").section("present"), InputError);
}

TEST(YamlSection, AMissingFileIsAnErrorThatNamesIt) {
  try {
    YamlSection::load("no_such_loop.yaml");
    FAIL() << "nothing was thrown";
  } catch (const InputError& e) {
    expectWords(e.what(), "no_such_loop.yaml");
  }
}

TEST(YamlSection, MergedTextsReportWhereAPathWasWritten) {
  const auto trace = std::make_shared<YamlTrace>();
  trace->origins["controller"] = "base.yaml:7: ";
  trace->origins["controller.kp"] = "--set ";
  YamlSection section(YamlNode(YAML::Load("controller: {kp: much, ki: 1}")), "merged", "", trace);
  YamlSection controller = section.section("controller");
  EXPECT_EQ(controller.where("kp"), "--set controller.kp");
  EXPECT_EQ(controller.where("ki"), "base.yaml:7: controller.ki");
  EXPECT_EQ(section.where("plant"), "merged: plant");
  controller.markRead("kp");
  EXPECT_EQ(trace->asked.count("controller.kp"), 1U);
}

}  // namespace base_yaml_section_test
}  // namespace fpc
