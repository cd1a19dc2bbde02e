// The reader of study files: what it reads, what it refuses, and that docs/study_file.md tells it
// all.
#include "config/study_file.hpp"

#include <fstream>
#include <regex>
#include <set>

#include "base/yaml_node.hpp"
#include "config/read.hpp"
#include "paths.hpp"
#include "study/tuning_fixture.hpp"

namespace fpc {
namespace config_study_file_test {

std::string text(const std::string& more = "") {
  return "loops: [a, b]\nseeds: 1:3,7\nvary: {k: [0.7, 1.3], c: {values: [2, 5]}}\n"
         "noise: {y: 0.5}\nscenarios: [{name: storm, set: {d: 3}}]\n"
         "fitness: {terms: [{index: ise, output: y}]}\n" +
         more;
}

std::string errorIn(const std::string& study) {
  return errorOf([&] { parseStudy(study, "s.yaml"); });
}

TEST(StudyFile, IsReadIntoItsStructs) {
  const StudyFile study = parseStudy(text(), "s.yaml");
  ASSERT_EQ(study.loops.size(), 2U);
  EXPECT_EQ(study.against, "b");
  EXPECT_EQ(study.seeds, (std::vector<std::uint64_t>{1, 2, 3, 7}));
  ASSERT_EQ(study.vary.size(), 2U);
  EXPECT_TRUE(study.vary[0].factor);
  EXPECT_EQ(study.vary[0].upper, 1.3);
  EXPECT_FALSE(study.vary[1].factor);
  EXPECT_EQ(study.vary[1].lower, 2.0);
  EXPECT_EQ(study.noise.front().second, 0.5);
  EXPECT_EQ(study.scenarios.front().set.front().second, "3");
}

TEST(StudyFile, LoopsMayBringChangesOfTheirOwn) {
  const StudyFile study = parseStudy(
      "loops: [{loop: a, name: on}, {loop: a, name: off, set: {guard: false}}]\n"
      "against: on\nfitness: {terms: [{index: ise}]}\n",
      "s.yaml");
  EXPECT_EQ(study.loops[1].set.front().first, "guard");
  EXPECT_EQ(study.against, "on");
}

TEST(StudyFile, MistakesNameFileKeyAndWhatWasExpected) {
  expectWords(errorIn("fitness: {terms: [{index: ise}]}"), {"s.yaml", "loops", "at least one"});
  expectWords(errorIn(text("against: c\n")), {"against", "'c'"});
  expectWords(errorIn(text("sede: 3\n")), {"sede", "unknown key"});
  expectWords(errorIn("loops: [a, a]\nfitness: {terms: [{index: ise}]}"), {"loops", "twice a"});
  expectWords(errorIn("loops: [a]\nseeds: 4:1\nfitness: {terms: [{index: ise}]}"),
              {"seeds", "decrease"});
  expectWords(errorIn("loops: [a]\nseeds: 1,1\nfitness: {terms: [{index: ise}]}"),
              {"seeds", "only once"});
  expectWords(errorIn("loops: [a]\nvary: {k: [1, 2]}\nfitness: {terms: [{index: ise}]}"),
              {"vary", "seeds"});
  expectWords(errorIn("loops: [a]\nseeds: 1\nvary: {k: [2, 1]}\nfitness: {terms: [{index: ise}]}"),
              {"of k", "lower < upper"});
  expectWords(errorIn("loops: [a]\nscenarios: {seeds: [1]}\nfitness: {terms: [{index: ise}]}"),
              {"scenarios", "under seeds"});
  expectWords(errorIn("loops: [a]\nfitness: {across: mean, terms: [{index: ise}]}"),
              {"across", "unknown key"});
  expectWords(errorOf([] { parseVariation("k=1"); }), {"--vary", "LOWER:UPPER"});
  expectWords(errorOf([] { parseSeeds("1:x", "--seeds"); }), {"--seeds", "'x'"});
  expectWords(errorOf([] { readStudy("nothing"); }), {"study 'nothing'"});
}

TEST(StudyFile, TheDocumentTellsItsKeys) {
  std::ifstream stream(sourceDir() + "/docs/study_file.md");
  const std::string page((std::istreambuf_iterator<char>(stream)), {});
  const auto knownAfter = [](const std::string& error) {
    std::set<std::string> keys;
    const std::regex word(R"([A-Za-z_]+)");
    const std::string list = error.substr(error.find("one of ") + 7);
    for (std::sregex_iterator w(list.begin(), list.end(), word), end; w != end; ++w)
      keys.insert((*w).str());
    return keys;
  };
  const auto expectRows = [&](const std::string& prefix, const std::string& error) {
    ASSERT_NE(error.find("unknown key"), std::string::npos) << error;
    for (const auto& key : knownAfter(error)) {
      const bool section = key == "fitness" || key == "scenarios" || key == "terms";
      const std::string row = "`" + prefix + key + (section ? "" : "`");
      EXPECT_NE(page.find(row), std::string::npos) << row << " is not in docs/study_file.md";
    }
  };
  expectRows("", errorIn(text("nonsense: 1\n")));
  expectRows("loops[].",
             errorIn("loops: [{loop: a, nonsense: 1}]\nfitness: {terms: [{index: ise}]}"));
  expectRows("fitness.", errorIn("loops: [a]\nfitness: {nonsense: 1, terms: [{index: ise}]}"));
}

TEST(StudyFile, EveryShippedOneCanBeRead) {
  EXPECT_GE(studyNames().size(), 1U);
  for (const auto& name : studyNames()) EXPECT_NO_THROW(readStudy(name)) << name;
}

}  // namespace config_study_file_test
}  // namespace fpc
