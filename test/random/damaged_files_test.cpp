// Files with mistakes in them: a reader answers with an error in words or with something that runs,
// whatever stands there. More of it: FMBPC_LONG_TESTS, and the fuzzers of test/fuzz.
#include <filesystem>

#include "base/csv.hpp"
#include "config/model_file.hpp"
#include "config/structure_file.hpp"
#include "config/tuning_file.hpp"
#include "identification/data_set.hpp"
#include "paths.hpp"
#include "random/damage.hpp"
#include "random/random_loop.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace random_damaged_files_test {

constexpr std::uint32_t kLongestRun = 300;  // samples

std::uint64_t rounds(std::uint64_t quick) {
  return std::getenv("FMBPC_LONG_TESTS") != nullptr ? 100 * quick : quick;
}

class DamagedFiles : public LoopFolder {
 protected:
  /// `read` may throw nothing but an InputError of one line with words in it.
  template <typename Read>
  void expectWordsOrNothing(const std::string& text, std::uint64_t seed, Read read) {
    try {
      read();
      ++accepted_;
    } catch (const InputError& e) {
      const std::string words = e.what();
      EXPECT_NE(words.find("expected"), std::string::npos) << words << "\nseed " << seed << "\n"
                                                           << text;
      ++refused_;
    } catch (const std::exception& e) {
      ADD_FAILURE() << "seed " << seed << ": " << e.what() << "\n" << text;
    }
  }

  /// Damages every file of a shipped folder.
  template <typename Read>
  void each(const std::string& folder, std::uint64_t each_file, Read read) {
    for (const auto& entry :
         std::filesystem::directory_iterator(sourceDir() + "/config/" + folder)) {
      if (!entry.is_regular_file() || entry.file_size() > 20000) continue;
      std::ifstream stream(entry.path());
      const std::string text((std::istreambuf_iterator<char>(stream)), {});
      for (std::uint64_t seed = 0; seed < rounds(each_file) && !HasFailure(); ++seed) {
        Dice dice(seed);
        const std::string spoiled = damaged(text, dice);
        expectWordsOrNothing(spoiled, seed, [&] { read(spoiled); });
      }
    }
    EXPECT_GT(refused_, 0) << "damages that nobody notices are none";
    EXPECT_GT(accepted_, 0);
  }

  int accepted_{0}, refused_{0};
};

TEST_F(DamagedFiles, LoopsAreRefusedInWordsOrRun) {
  for (std::uint64_t seed = 0; seed < rounds(250) && !HasFailure(); ++seed) {
    const RandomLoop random = randomLoop(seed / 5);
    for (const auto& [name, content] : random.files) write(name, content);
    Dice dice(seed);
    const std::string text = damaged(random.text, dice);
    const std::string file = write("damaged.yaml", text);
    expectWordsOrNothing(text, seed, [&] {
      LoopFile loop = readLoop(file);
      if (loop.external_plant || loop.simulation.samples == 0) return;
      RunOptions options;
      std::uint32_t last = 0;
      options.progress = [&](std::uint32_t step, std::uint32_t) { last = step; };
      options.stop = [&] { return last >= kLongestRun; };
      if (loop.simulation.samples < 1000000) runLoop(loop, options);
    });
  }
  std::cout << accepted_ << " accepted, " << refused_ << " refused\n";
  EXPECT_GT(accepted_, 5);  // most damages are noticed
  EXPECT_GT(refused_, 20);
}

TEST_F(DamagedFiles, ModelsAreRefusedInWords) {
  each("model", 20, [&](const std::string& text) { readModel(write("model.yaml", text)); });
}

TEST_F(DamagedFiles, StructuresAreRefusedInWords) {
  each("structure", 20, [](const std::string& text) { parseStructure(text, "damaged"); });
}

TEST_F(DamagedFiles, TuningsAreRefusedInWords) {
  each("tuning", 40, [](const std::string& text) { parseTuning(text, "damaged"); });
}

TEST_F(DamagedFiles, TablesAreRefusedInWords) {
  each("data", 60, [&](const std::string& text) {
    const CsvTable table = readCsv(write("table.csv", text.substr(0, 600)));
    CsvDisturbanceParams params;
    params.file = table.file;
    params.time_column = table.names.front();
    params.missing = MissingCells::kInterpolate;
    params.end = RecordEnd::kHold;
    params.channels = {{"q_i", table.names.back()}};
    readDisturbances(params, {"q_i"}, Vector::Ones(1), 720.0, 50);
  });
}

}  // namespace random_damaged_files_test
}  // namespace fpc
