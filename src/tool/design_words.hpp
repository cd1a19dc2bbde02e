// The commands of the program fmbpc_design: what identifies, designs and judges.
#pragma once

#include <string_view>

namespace fpc::tool {

struct DesignWord {
  const char *word, *text;
};

inline constexpr DesignWord kDesignWords[] = {
    {"evaluate", "Effluent quality, operational cost and violations of runs of BSM1"},
    {"identify", "Identifies a fuzzy model from a record and validates it beside a linear one"},
    {"commission",
     "From a brief of a plant to a law that holds it: watches, tests, models, designs; what is "
     "done is kept in a folder"},
    {"validate", "Judges a model file on a record: one step, n steps, free run"},
    {"health",
     "Judges loops from their records: least variance, oscillation and its cause, valve, sensor, "
     "model"},
    {"model",
     "Reports gains, time constants, poles and dead times of a model, and what not to trust"},
    {"stability",
     "Of a loop: margins in gain and delay where its run leads it. Of a fuzzy law: eigenvalues "
     "over the horizon, a Lyapunov certificate. Steady states of the plant"},
    {"new", "Writes a loop file for a model, or a package with a plant or controller of your own"},
    {"check", "Asks the plants and controllers of a package for what every one promises"},
    {"tune", "Searches the numbers of a loop file that a tuning file names, on all cores"},
    {"study", "Compares loops in pairs over seeds, parameters, noise and records, on all cores"},
    {"replay", "Plays a recorded run through controller and optimizer and compares their actions"},
    {"export", "Writes a loop's law as a block in C99 and Structured Text, with vectors and tests"},
};

/// What the list of commands says of a word; null for one that is none of them.
constexpr const char* designText(std::string_view word) {
  for (const DesignWord& w : kDesignWords)
    if (word == w.word) return w.text;
  return nullptr;
}

}  // namespace fpc::tool
