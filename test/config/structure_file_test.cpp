#include <gtest/gtest.h>

#include <filesystem>

#include "config/structure_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "paths.hpp"

namespace fpc {
namespace config_structure_file_test {

const std::string kSignals =
    "sample_time_s: 2\noutputs: {y: {unit: m}, z: {}}\ninputs: {u: {column: U1, unit: "
    "V}}\ndisturbances: {d: {}}\n";

Structure structureOf(const std::string& rest) {
  return parseStructure(kSignals + rest, "test.yaml");
}

std::string errorOf(const std::string& text) {
  try {
    parseStructure(text, "test.yaml");
  } catch (const InputError& e) {
    return e.what();
  }
  return "nothing was thrown";
}

std::vector<std::string> texts(const Structure& structure,
                               const std::vector<Regressor>& regressors) {
  std::vector<std::string> all;
  for (const auto& r : regressors) all.push_back(structure.emptyModel().text(r));
  return all;
}

TEST(StructureFile, OrdersAndDelaysGiveTheRegressorsOfTheThesis) {
  // vallejo2021thesis, table 4, row 1: y1(k+1) from y1(k), y2(k), u1(k), u2(k), u3(k), u3(k-1).
  const Structure s = structureOf(
      "submodels:\n  y: {N_y: {y: 1, z: 1}, N_u: {u: 2, d: 1}, N_d: {u: 1, d: 3}}\n  z: {N_y: [0, "
      "2]}\n");
  EXPECT_EQ(texts(s, s.submodels[0].regressors),
            (std::vector<std::string>{"y(k)", "z(k)", "u(k)", "u(k-1)", "d(k-2)"}));
  EXPECT_EQ(texts(s, s.submodels[1].regressors), (std::vector<std::string>{"z(k)", "z(k-1)"}));
  EXPECT_EQ(s.submodels[0].antecedents, s.submodels[0].regressors);
  EXPECT_EQ(s.inputs[0].column, "U1");
  EXPECT_EQ(s.inputs[0].info.unit, "V");
  EXPECT_EQ(s.outputs[1].column, "z");
}

TEST(StructureFile, ExplicitListsAndRangesOfClustersAreRead) {
  const Structure s = structureOf(
      "submodels:\n  y: {regressors: [y(k), u(k-4)], antecedents: [u(k-4)], clusters: [2, 5]}\n"
      "  z: {regressors: [z(k)], clusters: auto}\npartition: {method: fuzzy_c_means, membership: "
      "exponential}\n"
      "consequents: {method: global, scarce: drop}\nrepair: {missing: drop}\n");
  EXPECT_EQ(texts(s, s.submodels[0].antecedents), (std::vector<std::string>{"u(k-4)"}));
  EXPECT_EQ(s.submodels[0].clusters_min, 2);
  EXPECT_EQ(s.submodels[0].clusters_max, 5);
  EXPECT_LT(s.submodels[1].clusters_min, s.submodels[1].clusters_max);
  EXPECT_EQ(s.partition.method, PartitionMethod::kFuzzyCMeans);
  EXPECT_EQ(s.partition.membership, MembershipShape::kExponential);
  EXPECT_EQ(s.consequents.method, ConsequentMethod::kGlobal);
  EXPECT_EQ(s.consequents.scarce, ScarceRule::kDrop);
  EXPECT_EQ(s.repair.missing, MissingCells::kDrop);
}

TEST(StructureFile, GridsOfGivenSetsAreRead) {
  const Structure s = structureOf(
      "partition: {method: grid}\nsubmodels:\n  y:\n    regressors: [y(k), u(k)]\n    antecedents: "
      "[u(k)]\n"
      "    sets: {u(k): [{gaussian: [0, 1]}, {triangular: [0, 1, 2]}, {exponential: [0, 1, 2, "
      "3]}]}\n"
      "  z: {regressors: [z(k)], antecedents: [z(k)], sets: {z(k): [{gaussian: [0, 1]}]}}\n");
  ASSERT_EQ(s.submodels[0].sets.size(), 1U);
  EXPECT_EQ(s.submodels[0].sets[0].size(), 3U);
  EXPECT_EQ(s.submodels[0].sets[0][2].shape, MembershipShape::kExponential);
}

TEST(StructureFile, MistakesAreNamedWithFileAndKey) {
  const std::string z = "  z: {N_y: {z: 1}}\n";
  EXPECT_NE(errorOf(kSignals + "time: {column: U1}\nsubmodels:\n  y: {N_y: {y: 1}}\n" + z)
                .find("expected another column than time.column, 'U1'"),
            std::string::npos);
  EXPECT_NE(errorOf(kSignals + "submodels:\n  y: {N_y: {q: 1}}\n" + z).find("N_y.q"),
            std::string::npos);
  EXPECT_NE(errorOf(kSignals + "submodels:\n  y: {N_y: {y: 1.5}}\n" + z).find("whole numbers"),
            std::string::npos);
  EXPECT_NE(
      errorOf(kSignals + "submodels:\n  y: {N_y: {y: 1}}\n").find("z: expected what this output"),
      std::string::npos);
  EXPECT_NE(errorOf(kSignals + "submodels:\n  y: {regressors: [w(k)]}\n" + z).find("got 'w(k)'"),
            std::string::npos);
  EXPECT_NE(
      errorOf(kSignals + "submodels:\n  y: {regressors: [y(k)], N_y: {y: 1}}\n" + z).find("either"),
      std::string::npos);
  EXPECT_NE(errorOf(kSignals + "submodels:\n  y: {}\n" + z).find("at least one regressor"),
            std::string::npos);
  EXPECT_NE(
      errorOf(kSignals + "partitions: {}\nsubmodels:\n  y: {N_y: {y: 1}}\n" + z).find("partitions"),
      std::string::npos);
  EXPECT_NE(errorOf(kSignals + "partition: {fuzziness: 1}\nsubmodels:\n  y: {N_y: {y: 1}}\n" + z)
                .find("fuzziness"),
            std::string::npos);
  EXPECT_NE(errorOf("outputs: {y: {}}\n").find("sample_time_s"), std::string::npos);
  EXPECT_NE(errorOf(kSignals + "submodels:\n  y: {N_u: {u: 1}, N_d: {u: 0}}\n" + z).find("N_d"),
            std::string::npos);
}

TEST(StructureFile, EveryShippedStructureIsReadable) {
  int n_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(sourceDir() + "/config/structure")) {
    SCOPED_TRACE(entry.path().string());
    const Structure s = readStructure(entry.path().string());
    EXPECT_EQ(s.name, entry.path().stem().string());
    ++n_files;
  }
  EXPECT_GE(n_files, 8);
}

TEST(StructureFile, TheCasesOfTheThesisHaveItsRegressors) {
  const auto s = readStructure(sourceDir() + "/config/structure/asp_d.yaml");
  EXPECT_EQ(texts(s, s.submodels[0].regressors),
            (std::vector<std::string>{"s(k)", "x(k)", "q_r(k)", "q_r(k-1)", "q_i(k)", "s_i(k)"}));
  EXPECT_EQ(texts(s, s.submodels[1].regressors),
            (std::vector<std::string>{"x(k)", "q_r(k)", "q_i(k)"}));
  EXPECT_EQ(s.submodels[0].clusters_max, 6);
  EXPECT_EQ(s.submodels[1].clusters_max, 5);
}

}  // namespace config_structure_file_test
}  // namespace fpc
