// What was found since a state file was last written: one line per run, appended as soon as the run
// ends, so that a process that is killed loses no finished run. Private to the room.
#pragma once

#include <fstream>
#include <map>
#include <string>

namespace fpc {

class RunJournal {
 public:
  /// Stands beside the state file; an empty name: nothing is kept.
  RunJournal(const std::string& state_file, std::string identity);
  /// Texts by run. A last line that was cut off in the middle is left out. Empty if there is no
  /// journal. @throws InputError if it is of another identity.
  std::map<std::size_t, std::string> read() const;
  bool exists() const;
  /// From now on it is empty: what it held stands in the state file.
  void begin();
  /// @throws InputError if it cannot be written.
  void add(std::size_t run, const std::string& text);
  /// All is done and stands in the state file.
  void remove();

 private:
  std::string file_, identity_;
  std::ofstream stream_;
};

}  // namespace fpc
