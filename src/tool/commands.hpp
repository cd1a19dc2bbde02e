// The commands of the tool `fmbpc`, one file each. Every one returns the exit code and throws
// InputError.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace fpc {
class RunPool;
struct Summary;
}  // namespace fpc

namespace fpc::tool {

struct RunArguments {
  std::vector<std::string> loops;
  std::vector<std::string> set;  ///< "path=value"
  std::string sets;              ///< several of them in one text
  std::string out;               ///< folder, empty: nothing is written
  bool on_model{false};          ///< the loop's model in the place of its plant
  std::string commands;          ///< file of what an operator does, empty: nothing
  std::string plant;             ///< plant file, in the place of loops; empty: none
  bool json{false};
  bool no_plot{false};
  bool brief{false};  ///< table: a line per run
};

struct LoopsArguments {
  std::vector<std::string> words;
  bool names_only{false};
  bool json{false};
};

/// How records are written, for the commands without a structure file.
struct RecordFormat {
  std::string separator{"comma"}, decimal{"point"};
  std::vector<std::string> missing;
  bool no_header{false};
};

struct IdentifyArguments {
  std::vector<std::string> data;  ///< CSV or bag; more than one with `automatic` only
  std::string structure;          ///< name of config/structure, or path; none with `automatic`
  std::string rows;               ///< "FIRST:LAST", empty: all
  std::string validate;           ///< another record, empty: the same
  std::string validate_rows;      ///< of it; both empty: nothing is held out
  std::string out;                ///< model file, empty: none
  std::string plots;              ///< folder, empty: none
  bool json{false};
  bool automatic{false};  ///< search over structures; the rest is for it
  std::vector<std::string> inputs, outputs, disturbances;  ///< columns
  std::string time;                                        ///< column, empty: found
  RecordFormat format;
  double sample_time_s{};         ///< 0: from the time column
  std::string kind{"best"};       ///< best, linear, regressors, state
  double work{90.0}, budget_s{};  ///< limits of the search; 0 s: no limit of time
  int blocks{4}, window{5};
  int reach{-1};                  ///< samples of the runs that judge, 0: free ones, -1: by the data
  int longest_delay{};            ///< [samples], 0: by the length of the record
  std::string input_row{"auto"};  ///< auto, next, same: see RowReading
  bool keep_inputs{false};        ///< those that hardly moved too
  std::string known;              ///< of the outputs: file or text, empty: nothing
  std::uint64_t seed{1};
};

struct ValidateArguments {
  std::string model, data;
  std::string rows;
  std::vector<std::string> columns;  ///< "signal=column"
  bool no_time{false};               ///< rows are samples, whatever the times say
  RecordFormat format;
  int steps{10};
  std::string plots;
  bool json{false};
};

struct StabilityArguments {
  std::string name;              ///< model or loop
  std::vector<std::string> set;  ///< KEY.PATH=VALUE over the loop file
  std::string at;                ///< "name=value,..."
  std::string horizon{"1..200"};
  std::string out;
  double noise_gain{0.0};  ///< limits of the advisor; 0: no advice
  int settling{0};
  int points{4};         ///< of the run at which a loop is linearised; 0: none
  bool on_model{false};  ///< the loop's model in the place of its plant
  bool json{false};
  bool no_plot{false};
};

struct NewArguments {
  std::string name, model;
  std::string plant{"model"};  ///< of a loop: model, external, float64 or modbus
  std::string out{"."};
};

struct TuneArguments {
  std::string loop;
  std::string tuning;
  std::vector<std::string> set;
  std::string out;     ///< folder, empty: nothing is written
  std::string method;  ///< these five over the tuning file; empty or -1: as it says
  int population{-1}, evaluations{-1};
  std::int64_t seed{-1};
  int threads{0};  ///< 0: all cores
  bool resume{false};
  bool compare{false};               ///< all methods at equal evaluations
  int seeds{6};                      ///< of the comparison
  std::vector<std::string> methods;  ///< of the comparison, empty: all
  std::shared_ptr<RunPool> pool;     ///< of the ranks of an MPI job; null: threads
  bool json{false};
  bool no_plot{false};
};

struct StudyArguments {
  std::vector<std::string> names;  ///< a study file, or loops
  std::vector<std::string> set;
  std::vector<std::string> vary;   ///< "KEY=0.7:1.3"
  std::vector<std::string> noise;  ///< "OUTPUT=STD"
  double noise_percent{-1.0};      ///< of the span of setpoints; negative: as the file says
  std::string seeds;               ///< "1:40"
  std::string against;             ///< name of the loop to pair with
  std::string index;               ///< without a file; empty: ise
  std::string out;                 ///< folder, empty: nothing is written
  int threads{0};                  ///< 0: all cores
  std::shared_ptr<RunPool> pool;   ///< of the ranks of an MPI job; null: threads
  bool resume{false};
  bool json{false};
  bool no_plot{false};
};

struct EvaluateArguments {
  std::vector<std::string> runs;  ///< folders of `run --out`, or loops that are run first
  std::vector<std::string> set;   ///< "path=value", of loops
  double from_h{-1.0}, to_h{-1.0};
  bool weights_2002{false};
  bool json{false};
};

struct HealthArguments {
  std::vector<std::string> records;  ///< run folders, folders of them, CSVs, bags
  std::vector<std::string> outputs, setpoints, inputs, positions;  ///< columns, loop by loop
  std::string mode;  ///< column that says who moves the input
  std::vector<std::string> automatic{"1"}, manual, fallback;  ///< its values
  std::string time;                                           ///< column, empty: found
  double sample_time_s{};                                     ///< 0: from the time column
  std::vector<double> dead_times_s;  ///< of each loop, or one of all; empty: estimated
  std::string limits;                ///< "LOWER:UPPER" of the inputs; empty: none
  std::string model;                 ///< name of config/model, or path; empty: none
  std::string rows;                  ///< "FIRST:LAST"
  RecordFormat format;
  std::string out;  ///< folder, empty: nothing is written
  bool json{false};
};

struct RecoverArguments {
  std::string folder;
  bool no_plot{false};
  bool rows{false};  ///< answers with rows, see followJournal()
};

struct ReplayArguments {
  std::string bag;
  int run{0};                    ///< from 1; 0: the only one
  std::string loop;              ///< empty: the one in the bag
  std::vector<std::string> set;  ///< "path=value"
  bool json{false};
};

struct CommissionArguments {
  std::string brief;
  std::string folder;           ///< empty: NAME of the brief in the present one
  std::string until{"design"};  ///< last stage
  std::string again;            ///< stage that is gone through anew, with all after it; empty: none
  bool topics{false};           ///< of the loop that runs over topics
  bool undo{false};             ///< takes `again` and all after it back, and does nothing else
  int evaluations{48}, members{16}, threads{0};
  bool json{false}, no_plot{false};
};

int commission(const CommissionArguments& arguments);
int evaluate(const EvaluateArguments& arguments);
int identify(const IdentifyArguments& arguments);
int validate(const ValidateArguments& arguments);
int run(const RunArguments& arguments);
/// `sets`: more of them in one text, see parseOverrides().
int resolve(const std::string& loop, const std::vector<std::string>& set, const std::string& sets,
            bool on_model);
/// Checks a plant file with all its loops, and lists them with their links.
int resolvePlant(const std::string& plant, const std::vector<std::string>& set,
                 const std::string& sets);
/// What the plugins of all loops that are found register, so that lists show it.
void loadPluginsOfLoops();
int plants(bool json);
/// Codes, or docs/events.md if none is named. @throws InputError for one that is none.
int events(const std::vector<std::string>& codes);
int controllers(bool json);
/// Names, titles, plants and controllers of the loops that contain all words (in any of these).
int loops(const std::vector<std::string>& words, bool names_only, bool json);
int model(const std::string& file, bool json, const std::string& plots);
/// A path, or a name below config/model; what it was given if there is neither.
std::string findModel(const std::string& name);
/// The same. @throws InputError with the nearest names.
std::string requireModel(const std::string& name);
int stability(const StabilityArguments& arguments);
int newLoop(const NewArguments& arguments);
/// `kind`: plant or controller.
int newPackage(const NewArguments& arguments, const std::string& kind);
int check(const std::string& package);
int tune(const TuneArguments& arguments);
int study(const StudyArguments& arguments);
/// `brief`: only what all of them control, and the movement.
int table(const std::vector<std::string>& folders, bool brief);
/// Of a comparison, on a line of its own at the end.
void printVerdict(const std::vector<Summary>& summaries);
int replay(const ReplayArguments& arguments);
int recover(const RecoverArguments& arguments);
int health(const HealthArguments& arguments);
/// These become other programs: they return only by throwing.
int watch(const std::vector<std::string>& words);
int page(std::vector<std::string> words);

}  // namespace fpc::tool
